# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What a map server says becomes clouds and messages; only what changed is fetched."""
import contextlib
import http.server
import json
import pathlib
import threading

import numpy as np
import ovimap
import pytest

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed; tools/setup.sh --tests installs it")
pytest.importorskip("rosbags")
from ovimap.ros import messages
from ovimap.ros.grid import read_grid
from ovimap.ros.served import MapServer

CHUNK = (pathlib.Path(__file__).parents[2] / "tests/chunks/two_patches.bin").read_bytes()  # labels 1 1 70000 0 2 2 2
HEADER = messages.header_of("map", 1)


@contextlib.contextmanager
def scripted(answers):
    """A server of these answers by path, bytes or JSON, or (status, sentence); gives its address and the paths asked for."""
    asked = []

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            asked.append(self.path)
            answer = answers[self.path.split("?")[0]]
            status, answer = answer if isinstance(answer, tuple) else (200, answer)
            body = answer if isinstance(answer, bytes) else json.dumps(answer).encode()
            self.send_response(status)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}", asked
    finally:
        server.shutdown()
        server.server_close()


def answers(version=5):
    labels = [0] * 70001
    labels[1], labels[2], labels[70000] = 12, 13, 14
    return {"/api/map": {"live": False, "title": "a", "content_hash": "1"}, "/api/mesh": {"chunks": [{"x": 0, "y": 0, "z": 0, "version": version}]},
            "/api/mesh/0/0/0/0": CHUNK, "/api/labels": {"instances": labels, "hidden": [13]}}  # fmt: skip


def test_the_surface_of_objects_is_read_and_what_is_hidden_is_not():
    with scripted(answers()) as (address, _):
        cloud = MapServer(address).cloud(100)
    assert cloud.ids.tolist() == [12, 12, 14]
    edge, low = 1.28, 0.005
    assert np.allclose(cloud.points[1], [low + edge * 32768 / 65535, low, low], atol=1e-6)
    assert cloud.colors[2].tolist() == [0, 0, 255]
    with scripted(answers()) as (address, _):
        assert len(MapServer(address).cloud(2).ids) == 2, "at most so many points"


def test_only_what_changed_is_fetched_and_another_map_is_another():
    said = answers()
    with scripted(said) as (address, asked):
        server = MapServer(address)

        def fetched():
            before = len(asked)
            server.about(), server.cloud(100)
            return sum(path.startswith("/api/mesh/0/") for path in asked[before:])

        assert [fetched(), fetched()] == [1, 0]
        said["/api/mesh"]["chunks"][0]["version"] = 6
        assert [fetched(), fetched()] == [1, 0]
        said["/api/map"]["content_hash"] = "2"
        assert [fetched(), fetched()] == [1, 0]
        said["/api/mesh"]["chunks"] = []
        assert fetched() == 0 and len(server.cloud(100).ids) == 0


@pytest.mark.parametrize(("wrong", "said"), [
    ({"/api/mesh/0/0/0/0": b"OVMC" + bytes(60)}, "sends surfaces in version 0, this program reads 2"),
    ({"/api/mesh/0/0/0/0": b"<html>"}, "sent a surface that is none"),
    ({"/api/mesh": b"<html>"}, "is no map server"),
    ({"/api/mesh": (401, {"error": "show the token"})}, "show the token"),
    ({"/api/mesh": (500, b"")}, "the map server answered 500"),
])  # fmt: skip
def test_what_a_server_should_not_say_is_one_line(wrong, said):
    with scripted(answers() | wrong) as (address, _), pytest.raises(ovimap.Error, match=said):
        MapServer(address).cloud(100)


def test_a_server_that_is_none_is_one_line():
    with pytest.raises(ovimap.Error, match="does not answer .*; is `ovimap serve` running?"):
        MapServer("http://127.0.0.1:1").about()
    with pytest.raises(ovimap.Error, match="is no address"):
        MapServer("http://")


def thing(number, name="", label=None):
    return {"id": number, "name": name, "label": label, "color": [255, 0, 51], "centroid": [1.0, 2.0, 3.0],
            "box": {"min": [0.0, 1.0, 2.0], "max": [2.0, 3.0, 5.0]}}  # fmt: skip


def test_names_come_from_people_before_looks():
    things = [thing(1, "Red mug!"), thing(2, label={"name": "chair", "share": 0.75}), thing(3)]
    found = messages.detections_message(things, HEADER)
    assert [(one.id, one.results[0].hypothesis.class_id, one.results[0].hypothesis.score) for one in found.detections] == [
        ("1", "Red mug!", 1.0), ("2", "chair", 0.75), ("3", "object", 0.0)]  # fmt: skip
    [frame] = messages.frames_message(things, HEADER).transforms
    assert frame.child_frame_id == "object/red_mug_1" and frame.transform.translation.z == 3.5
    assert messages.frame_name(thing(4, "コップ")) == "object/object_4"


def test_an_empty_map_deletes_the_markers_of_before():
    [marker] = messages.markers_message([], HEADER).markers
    assert marker.action == messages.DELETE_ALL


def test_a_grid_lies_where_its_yaml_says(tmp_path):
    import PIL.Image

    PIL.Image.fromarray(np.array([[0, 205, 254], [254, 254, 254]], np.uint8)).save(tmp_path / "g.png")
    turn = [0, 1, 0, -1, 0, 0, 0, 0, 1]  # grid_from_world: a quarter turn about z
    (tmp_path / "g.yaml").write_text(f"image: g.png\nresolution: 0.5\norigin: [1, 2, 0]\nfloor_m: -0.25\ngrid_from_world: {turn}\n")
    message = messages.grid_message(read_grid(tmp_path / "g.yaml"), HEADER)
    assert message.data.tolist() == [0, 0, 0, 100, -1, 0], "the lowest row first"
    assert (message.info.width, message.info.height, message.info.resolution) == (3, 2, 0.5)
    corner, turned = message.info.origin.position, message.info.origin.orientation
    assert np.allclose([corner.x, corner.y, corner.z], [-2, 1, -0.25])
    assert np.allclose([turned.x, turned.y, turned.z, turned.w], [0, 0, 0.5**0.5, 0.5**0.5])
