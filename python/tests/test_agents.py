# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Agents ask maps over the Model Context Protocol, with the library's own client: files, servers, maps that are being made."""
import base64
import contextlib
import http.server
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.parse
import urllib.request

import ovimap
import pytest

mcp = pytest.importorskip("mcp")
from agent_fixture import agent_over_http, agent_over_stdio, http_server, needs_program, serving  # noqa: E402
from ovimap import mcp_command  # noqa: E402
from ovimap.agents import MapFault, open_map  # noqa: E402
from ovimap.agents.backend import moment  # noqa: E402
from ovimap.sender import FrameSender  # noqa: E402
from sender_fixture import FRAMES, Shots  # noqa: E402


@pytest.fixture
def copy(saved_map, tmp_path):
    """The map, to be changed."""
    return shutil.copy(saved_map, tmp_path / "room.ovimap")


@pytest.fixture(scope="module")
def reading(saved_map):
    """An agent that may only read."""
    with agent_over_stdio(f"room={saved_map}") as agent:
        yield agent


def in_one_line(said, *words):
    assert said.error and "\n" not in said.error and len(said.error) < 300, said.error
    assert all(word in said.error for word in words), said.error


def test_every_tool_says_what_it_does(reading):
    tools = reading.tools()
    assert set(tools) == {"maps", "objects", "find", "describe", "relations", "rooms", "look", "where_to_stand", "what_changed"}
    for name, tool in tools.items():
        assert len(tool.description) > 40 and tool.annotations.read_only_hint, name
        assert name == "maps" or "map" in tool.input_schema["required"]
        assert name == "look" or tool.output_schema is not None
    assert "found=false" in tools["find"].description


def test_maps_are_summed_up(reading, saved_map):
    [about] = reading.maps().value
    opened = ovimap.Map.open(saved_map)
    assert about["map"] == "room" and not about["being_made"] and about["searchable"]
    assert (about["objects"], about["frames"]) == (len(opened), opened.frames)
    assert about["up"][2] == pytest.approx(1, abs=0.05)
    assert all(low < high for low, high in zip(about["lowest"], about["highest"]))


def test_what_is_found_is_what_the_package_finds(reading, saved_map):
    for text in ("chair", "anything on the table", "how many chairs", "elephant"):
        said, answer = reading.find(map="room", text=text).value, ovimap.Map.open(saved_map).query(text)
        assert (said["found"], said["reading"], said["reason"]) == (answer.found, answer.reading, answer.reason)
        assert [match["id"] for match in said["matches"]] == [match.id for match in answer.matches]
    best = reading.find(map="room", text="chair").value["matches"][0]
    assert best["title"] == "chair" and best["probability"] > 0.35 and min(best["size"]) > 0.1
    without = reading.find(map="room", text="furniture", exclude=["chair"]).value["matches"]
    expected = ovimap.Map.open(saved_map).query("furniture", negatives=["chair"]).matches
    assert [match["id"] for match in without] == [match.id for match in expected] and best["id"] not in [match.id for match in expected]


def test_a_robot_hears_where_to_stand(reading, saved_map):
    chair = reading.find(map="room", text="chair").value["matches"][0]["id"]
    said = reading.where_to_stand(map="room", object=chair, start=[1.0, 1.0], radius_m=0.15)
    [best, *_] = said.value["places"]
    found = ovimap.Map.open(saved_map).approach(chair, start=(1.0, 1.0), radius_m=0.15)
    assert (best["x"], best["y"]) == pytest.approx((found.poses[0].x, found.poses[0].y), abs=1e-3)
    assert best["seen"] > 0.3 and best["way_m"] >= 0 and len(best["way"]) >= 1
    nowhere = reading.where_to_stand(map="room", object=chair, start=[50, 50]).value
    assert not nowhere["places"] and "cannot be at (50, 50)" in nowhere["reason"]
    in_one_line(reading.where_to_stand(map="room", object=999999), "999999")
    in_one_line(reading.where_to_stand(map="room", object=chair, start=[1]), "start")
    in_one_line(reading.where_to_stand(map="room", object=chair, radius_m=-1), "radius_m")


def test_rooms_say_what_they_hold(reading):
    [room] = reading.rooms(map="room").value["rooms"]
    assert room["id"] == 1 and 5 < room["area_m2"] < 11.3 and len(room["objects"]) > 3


def test_objects_come_in_pages_largest_first(reading):
    everything = reading.objects(map="room", most=200).value
    sizes = [size[0] * size[1] * size[2] for size in (thing["size"] for thing in everything["objects"])]
    assert len(sizes) == everything["total"] > 3 and sizes == sorted(sizes, reverse=True)
    page = reading.objects(map="room", most=2, skip=1).value["objects"]
    assert page == everything["objects"][1:3]


def test_an_object_is_described_and_its_relations_told(reading):
    chair = reading.find(map="room", text="chair").value["matches"][0]["id"]
    said = reading.describe(map="room", object=chair).value
    assert said["looks_like"] == "chair" and said["height_m"] > 0.3 and said["views"] > 0 and said["pictures"] > 0
    assert 0 < sum(color["share"] for color in said["colors"]) <= 1.01
    on_table = reading.find(map="room", text="anything on the table").value["matches"][0]["id"]
    relations = reading.relations(map="room", object=on_table).value["relations"]
    assert relations == reading.describe(map="room", object=on_table).value["relations"]
    held = [said for said in relations if said["relation"] == "on" and said["object"] == on_table]
    assert held, relations
    anchor = held[0]["anchor"]
    assert held[0] in reading.relations(map="room", object=anchor).value["relations"]


def test_an_agent_sees_an_object_and_its_place(reading):
    chair = reading.find(map="room", text="chair").value["matches"][0]["id"]
    pictures = reading.look(map="room", object=chair, pictures=2).pictures
    files = [base64.b64decode(picture.data) for picture in pictures]
    assert [picture.mime_type for picture in pictures] == ["image/jpeg"] * 3
    assert files[0].startswith(b"\xff\xd8") and len(set(files)) == 3
    assert len(reading.look(map="room", object=chair, pictures=1, place=False).pictures) == 1
    assert len(reading.look(map="room", object=chair, pictures=0).pictures) == 1


@pytest.mark.parametrize(
    ("tool", "arguments", "words"),
    [
        ("find", {"map": "room", "text": "  "}, ["empty"]),
        ("find", {"map": "room", "text": ","}, [","]),
        ("find", {"map": "room", "text": "x" * 2001}, ["2000"]),
        ("find", {"map": "room"}, ["'text' is missing"]),
        ("find", {"text": "mug"}, ["'map' is missing"]),
        ("find", {"map": "room", "text": ["mug"]}, ["'text'"]),
        ("find", {"map": "room", "text": "mug", "exclude": [""]}, ["empty"]),
        ("find", {"map": "../../etc/passwd", "text": "mug"}, ["no map", "there is room"]),
        ("find", {"map": "", "text": "mug"}, ["no map"]),
        ("describe", {"map": "room", "object": 4000000000}, ["no object 4000000000"]),
        ("describe", {"map": "room", "object": -1}, ["'object'"]),
        ("describe", {"map": "room", "object": 10**30}, ["'object'"]),
        ("describe", {"map": "room", "object": float("nan")}, ["'object'"]),
        ("describe", {"map": "room", "object": "the chair"}, ["'object'"]),
        ("relations", {"map": "room", "object": 4000000000}, ["no object"]),
        ("look", {"map": "room", "object": 4000000000}, ["no object"]),
        ("look", {"map": "room", "object": 1, "pictures": 10**9}, ["'pictures'"]),
        ("objects", {"map": "room", "most": 10**9}, ["'most'"]),
        ("objects", {"map": "room", "most": 0}, ["'most'"]),
        ("objects", {"map": "room", "most": 1e99}, ["'most'"]),
        ("rename", {"map": "room", "object": 1, "name": "x"}, ["rename"]),
        ("no_such_tool", {}, ["no_such_tool"]),
    ],
)
def test_nonsense_is_one_clear_line(reading, tool, arguments, words):
    in_one_line(getattr(reading, tool)(**arguments), *words)
    assert reading.maps().value  # and the server goes on


def test_a_map_that_is_corrected_replaced_or_lost_underneath(copy, saved_map):
    with agent_over_stdio(copy) as agent:
        chair = agent.find(map="room", text="chair").value["matches"][0]["id"]
        ovimap.Map.open(copy).rename(chair, "throne")
        assert agent.find(map="room", text="chair").value["matches"][0]["title"] == "throne"
        os.remove(copy)
        in_one_line(agent.find(map="room", text="chair"), "room.ovimap")
        copy.write_bytes(b"nothing")
        in_one_line(agent.find(map="room", text="chair"), "room.ovimap")
        os.remove(copy)
        shutil.copy(saved_map, copy)
        assert agent.find(map="room", text="chair").value["matches"][0]["title"] == "chair"


def test_corrections_only_where_they_are_allowed(copy):
    with agent_over_stdio(copy, "--allow-corrections") as agent:
        tools = agent.tools()
        assert {"rename", "merge", "undo"} <= set(tools) and not tools["rename"].annotations.read_only_hint
        chair, other = (match["id"] for match in agent.find(map="room", text="chair").value["matches"][:2])
        named = agent.rename(map="room", object=chair, name="throne").value
        assert ovimap.Map.open(copy).describe(chair).name == "throne"  # the log that everybody reads
        assert agent.describe(map="room", object=chair).value["title"] == "throne"
        merged = agent.merge(map="room", object=other, into=chair).value
        in_one_line(agent.describe(map="room", object=other), "no object")
        agent.undo(map="room", correction=merged["correction"])
        assert agent.describe(map="room", object=other).value["id"] == other
        agent.undo(map="room", correction=named["correction"])
        assert agent.describe(map="room", object=chair).value["title"] == "chair"
        in_one_line(agent.undo(map="room", correction=999))
        in_one_line(agent.merge(map="room", object=chair, into=chair))
        in_one_line(agent.rename(map="room", object=4000000000, name="x"), "no object")
        in_one_line(agent.rename(map="room", object=chair, name="a\nb"))
        in_one_line(agent.rename(map="room", object=chair, name="x" * 201), "'name'")


def test_the_session_of_the_page_can_be_played(copy):
    script = pathlib.Path(__file__).parents[2] / "tools" / "agent_session.py"
    done = subprocess.run([sys.executable, script, copy], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    told = done.stdout
    assert 'find(map="room", text="elephant")' in told and '"found": false' in told and "[picture, image/jpeg" in told
    assert "has no object 999999" in told and '"title": "fruit bowl"' in told
    assert not any(ovimap.Map.open(copy).instances.names)  # it took its name back


def test_several_maps_are_told_apart(copy, saved_map):
    with agent_over_stdio(f"left={copy}", f"right={saved_map}") as agent:
        assert [about["map"] for about in agent.maps().value] == ["left", "right"]
        os.remove(copy)
        in_one_line(agent.find(map="left", text="chair"))
        assert agent.find(map="right", text="chair").value["map"] == "right"
        left, right = agent.maps().value
        assert "cannot be read" in left["why_not_searchable"] and right["searchable"]


@needs_program
def test_a_served_map_says_what_the_file_says(reading, copy):
    with serving(copy) as server, agent_over_stdio(f"room={server.address}") as agent:
        chair = agent.find(map="room", text="chair").value["matches"][0]["id"]
        for tool, arguments in (
            ("find", {"text": "chair"}),
            ("find", {"text": "anything on the table", "exclude": ["book"]}),
            ("describe", {"object": chair}),
            ("relations", {"object": chair}),
            ("objects", {"most": 200}),
            ("rooms", {}),
            ("where_to_stand", {"object": chair, "start": [1.0, 1.0], "radius_m": 0.15}),
            ("maps", {}),
        ):
            given = arguments if tool == "maps" else {"map": "room", **arguments}
            served, read = getattr(agent, tool)(**given).value, getattr(reading, tool)(**given).value
            assert nearly(served, read), (tool, served, read)
        pictures = [agent.look(map="room", object=chair, pictures=2).pictures, reading.look(map="room", object=chair, pictures=2).pictures]
        assert pictures[0][:2] == pictures[1][:2] and len(pictures[0]) == 3
        for arguments in ({"object": 4000000000}, {"object": 0}):
            in_one_line(agent.describe(map="room", **arguments))
        in_one_line(agent.look(map="room", object=4000000000), "no object")
        in_one_line(agent.find(map="room", text=","), ",")


def nearly(one, other):
    """Floats may differ by a hundredth: the server sends tenths of millimetres, and a tool rounds what it says to centimetres."""
    if isinstance(one, float) and isinstance(other, float):
        return abs(one - other) < 0.011
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(nearly(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(nearly, one, other))
    return one == other


@needs_program
def test_corrections_go_through_the_server(copy):
    with serving(copy) as server, agent_over_stdio(f"room={server.address}", "--allow-corrections") as agent:
        chair = agent.find(map="room", text="chair").value["matches"][0]["id"]
        done = agent.rename(map="room", object=chair, name="throne").value
        assert agent.describe(map="room", object=chair).value["title"] == "throne"
        agent.undo(map="room", correction=done["correction"])
        assert agent.describe(map="room", object=chair).value["title"] == "chair"
        in_one_line(agent.merge(map="room", object=chair, into=4000000000), "no object")


@needs_program
def test_a_map_that_is_being_made(room, tmp_path):
    shots = Shots(room)
    with serving("http", "--live", "--masks", "none", "--encoder", "default", "--recognizer", "none", "--set", "map.voxel_size_m=0.02", "-o", tmp_path / "live.ovimap") as server:
        with agent_over_stdio(f"live={server.address}", f"gone={server.address}") as agent:
            sender = FrameSender(server.address, shots.camera)
            shots.send(sender, range(FRAMES))
            while not agent.objects(map="live").value["total"]:
                time.sleep(0.3)  # the server takes ten questions a second
                said = agent.find(map="live", text="chair")
                assert said.value is not None or "search" in said.error or "embedding" in said.error, said.error
            assert agent.maps().value[0]["being_made"]
            sender.finish()
            while agent.maps().value[0]["being_made"]:
                time.sleep(0.3)
            assert agent.find(map="live", text="chair").value["matches"]
            server.terminate()
            server.wait(timeout=60)
            in_one_line(agent.find(map="live", text="chair"), "does not answer")
            in_one_line(agent.look(map="live", object=1), "does not answer")
            assert "does not answer" in agent.maps().value[0]["why_not_searchable"]


@contextlib.contextmanager
def another_program(*answers):
    """Answers requests one after the other with (status, body), the last one again and again."""
    waiting = list(answers)

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            # What is left unread when a connection is closed resets it, and the answer is lost with it.
            self.rfile.read(int(self.headers.get("Content-Length", 0)))
            status, body = waiting.pop(0) if len(waiting) > 1 else waiting[0]
            self.send_response(status)
            self.send_header("Retry-After", "0")
            self.end_headers()
            self.wfile.write(body)

        do_POST = do_GET

        def log_message(self, *_):
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_address[1]}/"
        server.shutdown()


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        ((200, b"<html>"), "no JSON object"),
        ((200, b"[1]"), "no JSON object"),
        ((200, b"{}"), "not understood"),
        ((200, b'{"version": 1, "instances": [{"id": "x"}], "matches": 3, "search": 0}'), "not understood"),
        ((200, b'{"a":' * 100_000), "no JSON object"),
        ((200, b"\xff\xfe"), "no JSON object"),
        ((500, b""), "answered 500"),
        ((404, b'{"error": "two\\nlines"}'), "two lines"),
        ((404, b'{"error": 3}'), "answered 404"),
    ],
)
def test_another_program_at_that_port_is_one_line(answer, words):
    with another_program(answer) as address:
        asked = open_map(address)
        for question in (asked.summary, asked.objects, lambda: asked.find("mug"), lambda: asked.describe(1), lambda: asked.relations(1)):
            with pytest.raises(MapFault) as fault:
                question()
            assert words in str(fault.value) and "\n" not in str(fault.value)


def test_a_busy_server_is_asked_again():
    busy, ready = (429, b'{"error": "wait a second"}'), (200, b'{"edit": 7}')
    with another_program(busy, (503, b""), ready) as address:
        assert open_map(address).undo(3) == 7
    with another_program(busy) as address, pytest.raises(MapFault, match="wait a second"):
        open_map(address).undo(3)


@needs_program
def test_the_servers_token_comes_from_a_file_or_a_variable(copy, tmp_path):
    (tmp_path / "token").write_text("secret\n")
    with serving(copy, "--token-file", tmp_path / "token") as server:
        address = server.address.split("?")[0]
        with agent_over_stdio(f"room={address}") as agent:
            in_one_line(agent.find(map="room", text="chair"), "token")
        with agent_over_stdio(f"room={address}", "--map-token-file", tmp_path / "token") as agent:
            assert agent.find(map="room", text="chair").value["found"]
        with agent_over_stdio(f"room={address}", OVIMAP_TOKEN="secret") as agent:
            assert agent.find(map="room", text="chair").value["found"]


def test_over_http_for_those_with_the_token_alone(saved_map, tmp_path):
    (tmp_path / "token").write_text("secret\n")
    with http_server(f"room={saved_map}", "--token-file", tmp_path / "token") as (address, token):
        assert token == ""  # nobody prints what was given
        with agent_over_http(address, "secret") as agent:
            assert agent.find(map="room", text="chair").value["found"]
            in_one_line(agent.find(map="room", text=" "), "empty")
        for headers, status in (
            ({}, 401),
            ({"Authorization": "Bearer wrong"}, 401),
            ({"Authorization": "secret"}, 401),
            ({"Authorization": "Bearer secret"}, 400),
            ({"Authorization": "Bearer secret", "Host": "evil.example"}, 421),
            ({"Authorization": "Bearer secret", "Origin": "http://evil.example"}, 403),
        ):
            assert status_of(address, headers) == status, headers


def test_a_token_is_made_where_none_is_given(saved_map):
    with http_server(f"room={saved_map}") as (address, token):
        assert len(token) >= 24
        with agent_over_http(address, token) as agent:
            assert agent.maps().value
        assert status_of(address, {}) == 401
    with http_server(f"room={saved_map}", OVIMAP_MCP_TOKEN="other") as (address, token):
        assert token == "" and status_of(address, {"Authorization": "Bearer other"}) == 400


HALF_A_HEAD = b"POST /mcp HT"
WITH_TOKEN = (
    b"POST /mcp HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer secret\r\nContent-Type: application/json\r\n"
    b"Accept: application/json, text/event-stream\r\nContent-Length: 8\r\n"
)
ENOUGH = 120  # seconds that no machine takes


def limits(files, head_s):
    """Of a server: how many files it may have open, how long a head may take."""
    return f"""
import resource
from ovimap.agents import over_http
resource.setrlimit(resource.RLIMIT_NOFILE, ({files}, {files}))
over_http.HEAD_LIMIT_S = {head_s}
"""


def connected(stack, address, sent):
    where = urllib.parse.urlsplit(address)
    connection = stack.enter_context(socket.create_connection((where.hostname, where.port), timeout=ENOUGH))
    with contextlib.suppress(ConnectionError):  # cut off already
        connection.sendall(sent)
    return connection


def is_cut_off(connection):
    """Waits for it."""
    with contextlib.suppress(ConnectionError):
        while connection.recv(4096):
            pass
    return True


def test_connections_without_the_token_give_way(saved_map):
    with contextlib.ExitStack() as stack:
        address, _ = stack.enter_context(http_server(f"room={saved_map}", first=limits(256, 3600), OVIMAP_MCP_TOKEN="secret"))
        known = connected(stack, address, WITH_TOKEN + b"Expect: 100-continue\r\n\r\n")
        assert known.recv(4096).startswith(b"HTTP/1.1 100 ")
        crowd = [connected(stack, address, HALF_A_HEAD) for _ in range(400)]
        assert all(is_cut_off(connection) for connection in crowd[:-128])
        assert status_of(address, {"Authorization": "Bearer secret"}) == 400
        known.sendall(b"nonsense")
        assert known.recv(4096).startswith(b"HTTP/1.1 400 ")


def test_it_outlives_having_no_file_left(saved_map):
    with http_server(f"room={saved_map}", first=limits(64, 3600), OVIMAP_MCP_TOKEN="secret") as (address, _):
        with contextlib.ExitStack() as stack:
            for _ in range(64):
                connected(stack, address, HALF_A_HEAD)
        assert status_of(address, {"Authorization": "Bearer secret"}) == 400


def test_a_head_that_takes_too_long_is_cut_off(saved_map):
    with contextlib.ExitStack() as stack:
        address, _ = stack.enter_context(http_server(f"room={saved_map}", first=limits(256, 0.5), OVIMAP_MCP_TOKEN="secret"))
        without_token = WITH_TOKEN.replace(b"secret", b"wrong") + b"\r\n"
        slow = [connected(stack, address, sent) for sent in (b"", HALF_A_HEAD, without_token, WITH_TOKEN + b"\r\nnonsense")]
        with contextlib.suppress(ConnectionError):
            slow[-1].recv(4096)
            slow[-1].sendall(HALF_A_HEAD)  # the second one
        assert all(is_cut_off(connection) for connection in slow)


def status_of(address, headers):
    """Of a request that is no JSON: 400 where it is read at all."""
    given = {"Content-Type": "application/json", "Accept": "application/json, text/event-stream", **headers}
    try:
        with urllib.request.urlopen(urllib.request.Request(address, b"nonsense", given), timeout=20) as reply:
            return reply.status
    except urllib.error.HTTPError as fault:
        return fault.code


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nowhere.ovimap"], ["nowhere.ovimap"]),
        (["."], ["'.'"]),
        (["ftp://host/map"], ["ftp://host/map"]),
        (["http://host:99999/"], ["99999"]),
        (["http://127.0.0.1:1/?token=secret"], ["--map-token-file"]),
        (["http://127.0.0.1:1/", "http://127.0.0.1:1/"], ["two maps"]),
        (["http://127.0.0.1:1/", "--http", "0", "--host", "0.0.0.0"], ["0.0.0.0", "proxy"]),
        (["http://127.0.0.1:1/", "--http", "70000"], ["70000"]),
        (["http://127.0.0.1:1/", "--map-token-file", "/dev/null"], ["no token"]),
        (["http://127.0.0.1:1/", "--http", "0", "--token-file", "nowhere"], ["nowhere"]),
    ],
)
def test_what_cannot_be_served_is_one_line(arguments, words, capsys):
    assert mcp_command.main(arguments) == 2
    said = capsys.readouterr()
    assert said.out == "" and len(said.err.splitlines()) == 1 and all(word in said.err for word in words), said.err
    assert "secret" not in said.err


def test_it_says_what_to_install(saved_map, tmp_path):
    (tmp_path / "mcp.py").write_text("raise ModuleNotFoundError('no', name='mcp')")
    environment = os.environ | {"PYTHONPATH": f"{tmp_path}:{os.environ['PYTHONPATH']}"}
    done = subprocess.run([sys.executable, "-m", "ovimap.mcp_command", saved_map], env=environment, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr == "ovimap-mcp: mcp is not installed; pip install 'ovimap[mcp]'\n"


def test_no_token_stands_in_the_list_of_programs(capsys):
    with pytest.raises(SystemExit):
        mcp_command.main(["--help"])
    said = capsys.readouterr().out
    assert "--token-file" in said and "--token " not in said and "--token=" not in said


def test_agents_hear_what_changed(home_map):
    changes = ovimap.Map.open(home_map).changes()
    with agent_over_stdio(f"home={home_map}") as agent:
        said = agent.what_changed(map="home").value
        assert [visit["visit"] for visit in said["visits"]] == [1, 2] and said["visits"][1]["began"].startswith("2026-03-16")
        assert [(change["id"], change["event"], change["told"]) for change in said["changes"]] == [(change.id, change.event, change.text) for change in changes]
        for change in said["changes"]:
            assert change["title"] and (change["before"] is None) == (change["event"] == "appeared") and (change["after"] is None) == (change["event"] == "gone")
        assert agent.what_changed(map="home", since="visit 1", until="2026-03-16").value["changes"] == said["changes"]
        assert agent.what_changed(map="home", since="visit 2").value["changes"] == []
        assert agent.what_changed(map="home", since="some day").error.startswith("'some day' is no time; give a visit")
        for nonsense in ({"since": "x" * 5000}, {"since": 7}, {"since": "visit 9"}, {"until": ["now"]}, {"map": "nowhere"}):
            assert "\n" not in agent.what_changed(**{"map": "home"} | nonsense).error, nonsense
            assert agent.what_changed(**{"map": "home"} | nonsense).error, nonsense


def test_a_time_that_no_calendar_has_is_not_known():
    assert moment(None) is None and moment(1e18) is None and moment(0.0).startswith("19")


@needs_program
def test_a_server_tells_the_same(home_map):
    with serving(home_map) as server, contextlib.closing(open_map(server.address)) as behind, contextlib.closing(open_map(home_map)) as file:
        assert vars(behind.what_changed("visit 1")) | {"map": ""} == vars(file.what_changed("visit 1")) | {"map": ""}
        with pytest.raises(MapFault, match="visit 9"):
            behind.what_changed("visit 9")
