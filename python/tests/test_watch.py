# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Standing queries: told once when a thing is found, once when it is gone, and nothing in between."""
import contextlib
import http.client
import http.server
import itertools
import json
import os
import queue
import shutil
import signal
import subprocess
import sys
import threading

import ovimap
import pytest
from ovimap import watch_command
from ovimap.agents.backend import MapFault, NoAnswer, RequestRefused, Verdict, open_map
from ovimap.agents.facts import MapObject
from ovimap.watching import MOST_REST_S, WORK_SHARE, FileWatch, ServerWatch

PROGRAM = os.environ.get("OVIMAP_PROGRAM")
needs_program = pytest.mark.skipif(not PROGRAM, reason="the program was not built; set OVIMAP_PROGRAM")
PATIENCE_S = 120  # a busy machine is slow


class Scripted:
    """A map whose states and verdicts the test decides."""

    name = "room"

    def __init__(self):
        self.version, self.fault, self.asked = 1, "", []
        self.found = {}  # query -> id of its object, or a sentence why it cannot be asked

    def state(self):
        if self.fault:
            raise MapFault(self.fault)
        return str(self.version)

    def verdicts(self, texts):
        self.asked.append(list(texts))
        return [self._verdict(self.found.get(text)) for text in texts]

    def _verdict(self, said):
        if isinstance(said, str):
            return Verdict(False, None, fault=said)
        return Verdict(True, MapObject(said, "mug", False, (0, 0, 0), (1, 1, 1)), 0.9) if said else Verdict(False, None)


class Watching:
    """A watch on a scripted map, and what it told."""

    def __init__(self, *queries):
        self.map, self.told, self.now = Scripted(), [], 1000.0
        self.watch = FileWatch(self.map, queries, lambda event: self.told.append(event))

    def after(self, seconds, **found):
        """The map changes, then time goes by; what was told meanwhile, in short."""
        self.map.version += 1
        self.map.found = {query.replace("_", " "): said for query, said in found.items()}
        before = len(self.told)
        self.watch.step(self.now)
        for _ in range(4):
            self.now += seconds / 4
            self.watch.step(self.now)
        return [(event.event, event.query) for event in self.told[before:]]


def test_it_is_told_once_when_it_is_found_and_once_when_it_is_gone():
    watching = Watching("mug", "fire extinguisher")
    assert watching.after(9) == []
    assert watching.after(9, fire_extinguisher=7) == [("found", "fire extinguisher")]
    assert (watching.told[-1].object.id, watching.told[-1].probability, watching.told[-1].map) == (7, 0.9, "room")
    assert watching.after(9, fire_extinguisher=7) == []
    assert watching.after(9) == [("gone", "fire extinguisher")]
    assert watching.told[-1].object.id == 7
    assert watching.after(9, fire_extinguisher=7, mug=3) == [("found", "mug"), ("found", "fire extinguisher")]


def test_an_object_that_merges_into_another_is_the_same():
    watching = Watching("mug")
    assert watching.after(9, mug=12) == [("found", "mug")]
    assert watching.after(9, mug=7) == []  # 12 is part of 7 by now
    assert watching.after(9) == [("gone", "mug")] and watching.told[-1].object.id == 7


def test_the_map_is_asked_only_when_it_changed():
    watching = Watching(*(f"thing {i}" for i in range(1000)))
    watching.after(50)
    watching.after(50)
    assert [len(texts) for texts in watching.map.asked] == [1000, 1000]


def test_a_change_while_it_rests_is_seen_afterwards(monkeypatch):
    watching = Watching("mug")
    monkeypatch.setattr("ovimap.watching.time.monotonic", lambda clock=itertools.count(): next(clock))  # rounds of a second
    watching.watch.step(watching.now)
    watching.map.version, watching.map.found = 5, {"mug": 7}
    watching.watch.step(watching.now + 1)
    assert watching.told == []
    watching.watch.step(watching.now + 1 + MOST_REST_S)
    assert [event.event for event in watching.told] == ["found"]


def test_asking_takes_a_small_share_of_the_time(monkeypatch):
    watching = Watching("mug")
    for spent_s, rest_s in ((0.2, 0.2 / WORK_SHARE), (30, MOST_REST_S)):
        clock = itertools.count(0, spent_s)  # a round looks at it before and after
        monkeypatch.setattr("ovimap.watching.time.monotonic", lambda clock=clock: next(clock))
        before = len(watching.map.asked)
        for _ in range(400):
            watching.after(1)
        assert len(watching.map.asked) - before == pytest.approx(400 / (spent_s + rest_s), rel=0.3)


def test_a_map_that_does_not_answer_is_told_of_once():
    watching = Watching("mug")
    watching.after(9, mug=7)
    watching.map.fault = "the file went away"
    assert watching.after(9, mug=7) == [("fault", "")]
    assert watching.told[-1].fault == "the file went away"
    watching.map.fault = ""
    assert watching.after(9, mug=7) == []  # it is there as before
    watching.map.fault = "the file went away"
    assert watching.after(9) == [("fault", "")]
    watching.map.fault = ""
    assert watching.after(9) == [("gone", "mug")]


def test_a_query_that_cannot_be_asked_leaves_the_others_alone():
    watching = Watching("mug", ",")
    assert watching.after(9, mug=7, **{",": "the query ',' names nothing"}) == [("found", "mug"), ("fault", ",")]
    assert watching.after(9, mug=7, **{",": "the query ',' names nothing"}) == []


def test_the_callback_ends_it(saved_map):
    told = []
    ovimap.watch(saved_map, ["chair", "table"], lambda event: told.append(event) or False)
    assert [(event.event, event.query) for event in told] == [("found", "chair")]
    assert told[0].object.title == "chair" and told[0].as_dict()["object"]["id"] == told[0].object.id


@pytest.mark.parametrize(
    ("path", "queries", "words"),
    [("nowhere.ovimap", ["mug"], "nowhere"), ("", [], "nothing to watch"), ("", ["mug", " "], "empty"), ("", ["x" * 2001], "2000"), ("ftp://a", ["mug"], "ftp")],
)
def test_what_cannot_be_watched_is_an_error(saved_map, path, queries, words):
    with pytest.raises(ovimap.Error, match=words):
        ovimap.watch(path or saved_map, queries, print)


def test_a_thousand_queries_at_once(saved_map):
    words = ["chair", *(f"thing number {i}" for i in range(999))]
    backend = open_map(saved_map)
    verdicts = backend.verdicts(words)
    assert len(verdicts) == 1000 and verdicts[0].found and not any(verdict.fault for verdict in verdicts)
    assert backend.verdicts(words) == verdicts


def states_of(backend, change):
    """Whether it has another afterwards."""
    before = backend.state()
    change(backend)
    return before != backend.state()


def test_names_alone_are_no_reason_to_ask_again(saved_map, tmp_path):
    copy = shutil.copy(saved_map, tmp_path / "room.ovimap")
    first, second = (match.id for match in ovimap.Map.open(copy).query("chair").matches[:2])
    backend = open_map(copy)
    assert not states_of(backend, lambda backend: backend.rename(first, "throne"))
    assert states_of(backend, lambda backend: backend.merge(second, first))


class Hook:
    """A program that takes events."""

    def __init__(self, refuse=0, status=200):
        self.events, self.tries = queue.Queue(), 0
        hook = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                hook.tries += 1
                taken = hook.tries > refuse
                if taken:  # noted before the answer, after which the next event comes to another thread
                    hook.events.put((self.path, self.headers["Content-Type"], json.loads(body)))
                self.send_response(status if taken else 500)
                self.send_header("Location", "/elsewhere")
                self.end_headers()

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.address = f"http://127.0.0.1:{self.server.server_address[1]}/found?by=me"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()


def test_events_go_to_a_webhook_again_until_it_takes_them(monkeypatch):
    monkeypatch.setattr(watch_command, "FIRST_PAUSE_S", 0.01)
    with Hook(refuse=2) as hook:
        webhook = watch_command.Webhook(hook.address)
        webhook.send({"event": "found"})
        webhook.send({"event": "gone"})
        webhook.close()
        assert [hook.events.get(timeout=PATIENCE_S)[2]["event"] for _ in range(2)] == ["found", "gone"] and hook.tries == 4


def test_a_webhook_that_takes_nothing_costs_a_line(monkeypatch, capsys):
    monkeypatch.setattr(watch_command, "FIRST_PAUSE_S", 0.01)
    with Hook(status=302) as hook:  # nor is a redirection followed
        webhook = watch_command.Webhook(hook.address)
        webhook.send({"event": "found"})
        webhook.close()
        assert hook.tries == watch_command.TRIES
    webhook = watch_command.Webhook(hook.address)  # nobody is there any more
    webhook.send({"event": "gone"})
    webhook.close()
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 2 and "302" in lines[0] and '"found"' in lines[0] and '"gone"' in lines[1]


@pytest.mark.parametrize(
    "url", ["http://example.com/x", "http://192.168.1.2/x", "https://localhost.example.com/", "http://127.0.0.1.example.com/", "http://[2001:db8::1]/", "http://0.0.0.0/x"]
)
def test_events_leave_this_machine_only_when_told(url, saved_map, capsys):
    assert watch_command.main([saved_map, "mug", "--webhook", url]) == 2
    assert "--webhook-host" in capsys.readouterr().err
    host = watch_command._checked(url, ["example.com", "192.168.1.2", "localhost.example.com", "127.0.0.1.example.com", "2001:db8::1", "0.0.0.0"])
    assert host.hostname


@pytest.mark.parametrize("url", ["", "localhost:9000", "file:///etc/passwd", "http://localhost:99999/", "http://local host/", "http://localhost/\r\nX: y"])
def test_what_is_no_webhook_is_one_line(url, saved_map, capsys):
    if url:
        assert watch_command.main([saved_map, "mug", "--webhook", url]) == 2
        assert len(capsys.readouterr().err.splitlines()) == 1
    with pytest.raises(ovimap.Error, match="no address"):
        watch_command._checked(url, [])


def test_the_command_is_refused_in_one_line(saved_map, tmp_path, capsys):
    for arguments, words in (
        (["nowhere.ovimap", "mug"], "nowhere"),
        ([saved_map], "nothing to watch"),
        ([saved_map, ""], "empty"),
        ([saved_map, "--file", str(tmp_path / "none")], "none"),
        (["http://127.0.0.1:1/?token=secret", "mug"], "--map-token-file"),
    ):
        assert watch_command.main(arguments) == 2
        said = capsys.readouterr()
        assert said.out == "" and len(said.err.splitlines()) == 1 and words in said.err and "secret" not in said.err, said.err


@contextlib.contextmanager
def command(*arguments):
    """`ovimap-watch`; gives a function that waits for its next line."""
    with subprocess.Popen([sys.executable, "-m", "ovimap.watch_command", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        lines = queue.Queue()
        threading.Thread(target=lambda: [lines.put(line) for line in process.stdout], daemon=True).start()
        try:
            yield lambda: json.loads(lines.get(timeout=PATIENCE_S))
        finally:
            process.terminate()


def test_the_command_writes_a_line_for_each_event_and_sends_it(saved_map, tmp_path):
    (tmp_path / "words").write_text("elephant\n\nchair\n")
    with Hook() as hook, command(f"home={saved_map}", "--file", tmp_path / "words", "--webhook", hook.address, "--once") as line:
        told = line()
        assert (told["event"], told["query"], told["map"], told["object"]["title"]) == ("found", "chair", "home", "chair")
        assert hook.events.get(timeout=PATIENCE_S) == ("/found?by=me", "application/json", told)


@needs_program
def test_a_file_that_is_corrected_or_replaced(saved_map, tmp_path):
    copy = shutil.copy(saved_map, tmp_path / "room.ovimap")
    with command(copy, "chair") as line:
        told = line()
        hide(copy, "chair")
        gone = line()
        assert (told["event"], gone["event"]) == ("found", "gone")
        os.remove(copy)
        assert line()["event"] == "fault"
        shutil.copy(saved_map, copy)
        assert line()["event"] == "found"


def hide(path, text):
    """All that the text finds."""
    while (answer := ovimap.Map.open(path).query(text)).found:
        subprocess.run([PROGRAM, "edit", path, "hide", str(answer.matches[0].id)], check=True, capture_output=True)


@needs_program
def test_a_map_that_is_being_made_and_a_server_that_goes_away(room, tmp_path):
    pytest.importorskip("mcp")  # of which the fixture has more
    from agent_fixture import serving

    out = tmp_path / "live.ovimap"
    with serving("--live", room, "--masks", "gt", "--encoder", "default", "--recognizer", "none", "--fps", "8", "--set", "map.voxel_size_m=0.02", "-o", out) as server:
        with command(server.address, "chair", "elephant", "--hold", "0.5") as line:
            told = line()
            assert (told["event"], told["query"]) == ("found", "chair") and told["map"] == server.address.split("/")[2]
            server.send_signal(signal.SIGINT)
            assert line()["event"] == "fault"
            server.wait(timeout=300)
            port = server.address.split(":")[2].strip("/")
            with serving(out, port=port):  # the finished map at the same place: the chair is there as before
                hide_served(open_map(server.address), "chair")
                gone = line()
                while gone["event"] == "fault":  # while it ends, it may refuse with a reason of its own
                    gone = line()
                assert (gone["event"], gone["query"]) == ("gone", "chair")


def test_a_server_that_goes_away_is_told_once_however_its_socket_says_it(monkeypatch):
    monkeypatch.setattr("ovimap.watching.RETRY_S", 0)
    faults = [NoAnswer("ended"), NoAnswer("refused"), MapFault("shutting down"), NoAnswer("refused"), RequestRefused("enough")]

    class Server:
        name = "home"

        def watch(self, *_):
            raise faults.pop(0)

    told = []
    with pytest.raises(RequestRefused):
        ServerWatch(Server(), ["mug"], told.append).run()
    assert [event.fault for event in told] == ["ended", "shutting down", "refused"]


@pytest.mark.parametrize(
    ("kind", "body", "words"),
    [
        ("text/html", b"<html>", "not understood"),
        ("text/event-stream", b"", "does not answer"),
        ("text/event-stream", b"event: found\ndata: nonsense\n\n", "no JSON object"),
        ("text/event-stream", b'event: found\ndata: {"query": "mug", "object": 3}\n\n', "not understood"),
        ("text/event-stream", b'id: 8\nevent: found\ndata: {"query": "mug", "object": {"id": 1}}\n\n', "not understood"),
    ],
)
def test_another_program_at_that_port_is_a_fault(kind, body, words):
    class Handler(http.server.BaseHTTPRequestHandler):
        def do_POST(self):
            self.rfile.read(int(self.headers["Content-Length"]))
            self.send_response(200)
            self.send_header("Content-Type", kind)
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_):
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        told = []
        ovimap.watch(f"http://127.0.0.1:{server.server_address[1]}/", ["mug"], lambda event: told.append(event) or False)
        server.shutdown()
    assert (told[0].event, told[0].query) == ("fault", "") and words in told[0].fault and "\n" not in told[0].fault


class Stream:
    """Server-sent events, read with nothing but HTTP."""

    def __init__(self, server, target, body=None, **headers):
        self._connection = http.client.HTTPConnection("127.0.0.1", int(server.address.split(":")[2].strip("/")), timeout=PATIENCE_S)
        given = {"Content-Type": "application/json", **{name.replace("_", "-"): value for name, value in headers.items()}}
        self._connection.request("POST" if body else "GET", target, json.dumps(body).encode() if body else None, given)
        self._reply = self._connection.getresponse()
        assert self._reply.status == 200, self._reply.read()
        assert self._reply.headers["Content-Type"] == "text/event-stream"
        self.mark = ""
        assert self.next()["queries"] > 0

    def next(self):
        """What the next event says; signs of life are none."""
        said = None
        while line := self._reply.readline().decode().strip():
            name, _, value = line.partition(": ")
            self.mark = value if name == "id" else self.mark
            said = json.loads(value) if name == "data" else said
        return said if said is not None else self.next()

    def close(self):
        self._reply.close()
        self._connection.close()


@pytest.fixture
def server(saved_map, tmp_path):
    """One that serves a copy of the map, which the test may change."""
    pytest.importorskip("mcp")  # of which the fixture has more
    from agent_fixture import serving

    with serving(shutil.copy(saved_map, tmp_path / "room.ovimap")) as running:
        yield running


def short(said):
    return said["event"], said["query"]


@needs_program
def test_a_server_says_what_is_found_and_gone_to_all_who_listen(server):
    listeners = [contextlib.closing(Stream(server, "/api/watch?query=elephant&query=chair")) for _ in range(8)]
    with contextlib.ExitStack() as stack:
        streams = [stack.enter_context(listener) for listener in listeners]
        told = [stream.next() for stream in streams]
        assert {short(said) for said in told} == {("found", "chair")}
        assert told[0]["map"] == "room" and told[0]["object"]["title"] == "chair" and 0.5 < told[0]["probability"] <= 1
        assert set(told[0]) == {"event", "map", "query", "time_s", "object", "probability"} and streams[0].mark == "4"
        backend = open_map(server.address)
        hidden = hide_served(backend, "chair")
        assert {short(stream.next()) for stream in streams} == {("gone", "chair")} and streams[0].mark == "0"
        backend.undo(hidden[0])
        again = [stream.next() for stream in streams]
        assert {short(said) for said in again} == {("found", "chair")} and all("object" in said for said in again)


@needs_program
def test_a_listener_that_comes_back_goes_on_where_it_was(server):
    first = Stream(server, "/api/watch?query=chair&query=table")
    told = {short(first.next()), short(first.next())}
    assert told == {("found", "chair"), ("found", "table")}
    first.close()
    hide_served(open_map(server.address), "chair")
    with contextlib.closing(Stream(server, "/api/watch?query=chair&query=table", Last_Event_ID=first.mark)) as back:
        said = back.next()
        assert short(said) == ("gone", "chair") and "object" not in said  # this stream never knew which


@needs_program
def test_a_query_that_cannot_be_asked_is_one_fault(server):
    with contextlib.closing(Stream(server, "/api/watch", {"queries": [",", "chair"]})) as stream:
        told = [stream.next(), stream.next()]
        assert sorted(short(said) for said in told) == [("fault", ","), ("found", "chair")]
        assert all("names nothing" in said["fault"] or "," in said["fault"] for said in told if said["event"] == "fault")


@needs_program
def test_a_thousand_queries_of_a_server(server):
    words = ["chair", *(f"thing number {i}" for i in range(999))]
    told = []
    ovimap.watch(server.address, words, lambda event: told.append(event) or event.query != "chair")
    assert (told[-1].event, told[-1].query) == ("found", "chair") and not any(event.fault for event in told)
    with pytest.raises(ovimap.Error, match="1000"):
        ovimap.watch(server.address, [*words, "one more"], print)


def hide_served(backend, text):
    """All that the text finds; the numbers of the corrections, latest first."""
    numbers = []
    while (answer := backend.find(text)).found:
        numbers.insert(0, backend._correct({"kind": "hide", "instance": answer.matches[0].id}))
    return numbers
