# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Frames sent over HTTP give the map that the recording gives."""
import http.server
import io
import json
import pathlib
import shutil
import socket
import ssl
import subprocess
import sys
import threading

import numpy as np
import ovimap
import pytest
from ovimap.gyroscope import Gyroscope
from ovimap.sender import FrameSender, SendError
from PIL import Image
from sender_fixture import FRAMES, PROGRAM, Serving, Shots, figures, hash_of, needs_program


@pytest.fixture(scope="module")
def shots(room):
    return Shots(room)


@pytest.fixture(scope="module")
def hash_of_the_recording(room, tmp_path_factory):
    path = tmp_path_factory.mktemp("read") / "read.ovimap"
    subprocess.run([PROGRAM, "run", room, "--frames", f":{FRAMES}", "-o", path], check=True, capture_output=True)
    return hash_of(path)


@needs_program
def test_sent_frames_give_the_recordings_map(shots, hash_of_the_recording, tmp_path):
    with Serving(tmp_path / "sent.ovimap") as server:
        sender = FrameSender(server.address, shots.camera)
        shots.send(sender, range(FRAMES))
        sender.finish()
        assert sender.taken == server.saved()["frames"] == FRAMES
        with pytest.raises(SendError, match="finished"):
            sender.send(*shots.files[0], shots.poses[0])
    assert hash_of(tmp_path / "sent.ovimap") == hash_of_the_recording


@needs_program
def test_a_server_that_tracks_takes_orientations(shots, tmp_path):
    gyroscope = Gyroscope()
    with Serving(tmp_path / "tracked.ovimap", "--poses", "track", "--masks", "none", "--encoder", "none") as server:
        sender = FrameSender(server.address, shots.camera)
        for i in range(4):
            gyroscope.add(i / 30, (0.0, 0.0, 0.0))
            assert sender.send(*shots.files[0], None, i / 30, orientation=gyroscope.at(i / 30), patience_s=60)
        sender.finish()
        assert server.saved()["frames"] == 4


@needs_program
def test_a_graph_moves_what_was_sent(shots, tmp_path):
    out = tmp_path / "moved.ovimap"
    off = np.eye(4)
    off[0, 3] = 0.3
    with Serving(out, "--set", "frame_store.max_mb=100") as server:
        sender = FrameSender(server.address, shots.camera)
        for i in range(4):
            assert sender.send(*shots.files[i], off @ shots.poses[i], 0.1 * i, patience_s=60)
        sender.correct_poses({0.1 * i: shots.poses[i] for i in (0, 3)})
        assert sender.send(*shots.files[4], shots.poses[4], 0.4, patience_s=60)
        sender.finish()
        assert server.saved()["live"]["pose_updates"] == 1
    with Serving(tmp_path / "fixed.ovimap") as server:
        with pytest.raises(SendError, match="frame_store.max_mb"):
            FrameSender(server.address, shots.camera).correct_poses({0.0: np.eye(4)})


@needs_program
def test_another_visit_goes_on_with_a_map(shots, tmp_path):
    home, options = tmp_path / "home.ovimap", ("--masks", "none", "--encoder", "none")
    with Serving(home, *options) as server:
        sender = FrameSender(server.address, shots.camera)
        shots.send(sender, range(FRAMES))
        sender.finish()
        server.saved()
    away = np.eye(4)
    away[:3, 3] = 0.04
    with open(tmp_path / "fault", "w+") as fault, Serving(tmp_path / "away.ovimap", "--continue", home, *options, errors=fault) as server:
        with pytest.raises((SendError, OSError)):  # it is told while it waits, or finds nobody there
            sender = FrameSender(server.address, shots.camera)
            for files, pose in zip(shots.files, shots.poses):
                sender.send(*files, away @ pose, patience_s=60)
            sender.finish()
        assert server.process.wait(timeout=60) == 2
        fault.seek(0)
        assert "does not fit the map, which stays as it was: its poses are" in fault.read()
    with Serving(home, "--continue", home, *options) as server:
        sender = FrameSender(server.address, shots.camera)
        shots.send(sender, range(FRAMES))
        sender.finish()
        assert server.saved()["frames"] == 2 * FRAMES
    info = subprocess.run([PROGRAM, "info", home, "--json"], check=True, capture_output=True, text=True)
    history = json.loads(info.stdout)["history"]
    assert [visit["first_frame"] for visit in history["visits"]] == [0, FRAMES]
    assert history["events"] == []


@needs_program
def test_a_resumed_run_goes_on_counting(shots, hash_of_the_recording, tmp_path):
    for options, chosen in (((), range(FRAMES // 2)), (("--resume",), range(FRAMES // 2, FRAMES))):
        with Serving(tmp_path / "sent.ovimap", *options) as server:
            sender = FrameSender(server.address, shots.camera)
            shots.send(sender, chosen)
            sender.finish()
            assert server.saved()["frames"] == chosen.stop
    assert hash_of(tmp_path / "sent.ovimap") == hash_of_the_recording


@needs_program
def test_arrays_are_encoded_and_what_does_not_fit_is_skipped(room, tmp_path):
    frames = list(ovimap.open_source(room).frames("0:4"))
    with Serving(tmp_path / "a.ovimap", "--token", "secret", "--set", "live.queue=1") as server:
        assert "token=secret" in server.address
        with pytest.raises(SendError, match="token"):
            FrameSender(server.address.split("?")[0], figures(frames[0].camera))
        sender = FrameSender(server.address, {"depth_camera": figures(frames[0].camera, depth_scale=5000)})
        sent = [sender.send(np.array(f.color), np.array(f.depth), f.world_from_camera) for f in frames for _ in range(20)]
        assert sender.taken == sum(sent) and sender.skipped == len(sent) - sum(sent)
        with pytest.raises(SendError, match="3x2"):
            sender.send(np.zeros((2, 3, 3), np.uint8), np.array(frames[0].depth), frames[0].world_from_camera, patience_s=9)
        with pytest.raises(SendError, match="pose"):
            sender.send(np.array(frames[0].color), np.array(frames[0].depth), np.zeros((4, 4)))
        sender.finish()
        saved = server.saved()
        assert saved["frames"] == sender.taken and saved["live"]["frames_dropped"] >= sender.skipped


@needs_program
def test_address_and_camera_may_be_given_in_every_obvious_form(camera, tmp_path):
    with Serving(tmp_path / "a.ovimap") as server:
        host = server.address.removeprefix("http://").rstrip("/")
        for address in (server.address, host, host + "/"):
            for given in (figures(camera), figures(camera, depth_scale=1000), {"camera": figures(camera)}, camera, {"depth_camera": figures(camera)}):
                FrameSender(address, given).close()


@pytest.mark.parametrize("address", ["", "http://", "ftp://host:8080", "host:port", "http://host:99999"])
def test_what_is_no_address_is_told(camera, address):
    with pytest.raises(ValueError, match="is no address of a server; give what `ovimap serve` printed"):
        FrameSender(address, figures(camera))


@pytest.mark.parametrize("given, lacking", [
    ({"fx": 5, "fy": 5, "width": 4, "height": 4}, "'camera' lacks cx, cy;"),
    ({}, "'camera' lacks width, height, fx, fy, cx, cy;"),
    ({"depth_camera": {"width": 4}}, "'depth_camera' lacks height, fx, fy, cx, cy;"),
    ({"camera": None}, "'camera' lacks width"),
    (None, "'camera' lacks width"),
])  # fmt: skip
def test_what_a_camera_lacks_is_told_in_one_line(given, lacking):
    with pytest.raises(ValueError, match=lacking) as told:
        FrameSender("localhost:1", given)
    assert "in pixels, and depth_scale" in str(told.value) and "\n" not in str(told.value)


@needs_program
@pytest.mark.skipif(shutil.which("openssl") is None, reason="openssl is not installed, which makes the certificate")
def test_frames_are_sent_encrypted(shots, tmp_path):
    cert, key, token = tmp_path / "cert.pem", tmp_path / "key.pem", tmp_path / "token.txt"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2", "-subj", "/CN=map",
                    "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", key, "-out", cert], check=True, capture_output=True)  # fmt: skip
    token.write_text("a token&with=signs%\n")
    with Serving(tmp_path / "sent.ovimap", "--tls-cert", cert, "--tls-key", key, "--token-file", token) as server:
        assert server.address.startswith("https://")
        with pytest.raises(ssl.SSLCertVerificationError):
            FrameSender(server.address, shots.camera)
        sender = FrameSender(server.address, shots.camera, cafile=str(cert))
        shots.send(sender, range(2))
        sender.finish()
        assert server.saved()["frames"] == 2


class Scripted:
    """A server that does with each request what `answer` says: a status, or None to hang up without an answer."""

    def __init__(self, answer):
        seen = self.seen = []

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def handle_any(self):
                self.rfile.read(int(self.headers.get("Content-Length", 0)))
                seen.append((self.path, self.headers.get("Ovimap-Retry")))
                status = answer(self.path, len(seen))
                if status is None:
                    self.close_connection = True
                    return
                self.send_response(status)
                self.send_header("Content-Length", "2")
                self.end_headers()
                self.wfile.write(b"{}")
                self.close_connection = status == 201  # without saying so

            do_GET = do_POST = handle_any

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.address = f"http://127.0.0.1:{self.server.server_port}/"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def frames(self):
        return [retry for path, retry in self.seen if path == "/api/frames"]

    def end(self):
        self.server.shutdown()
        self.server.server_close()


CAMERA = {"width": 4, "height": 2, "fx": 5, "fy": 5, "cx": 1.5, "cy": 0.5}


@pytest.fixture
def sender():
    """Of a server that takes everything."""
    server = Scripted(lambda path, count: 200)
    yield FrameSender(server.address, CAMERA)
    server.end()


def decoded(sender, depth):
    return ovimap.decode_gray_png(sender._depth(depth))


def test_depth_is_sent_as_it_is_or_not_at_all(sender):
    units = np.array([[0, 1, 1500, 65535]], np.uint16)
    assert np.array_equal(decoded(sender, units), units) and np.array_equal(decoded(sender, units.astype(">u2")), units)
    for depth in (np.array([[70000, -5]]), units.astype(np.int16), units.astype(np.uint32), units > 0, units.tolist(), bytearray(8)):
        with pytest.raises(TypeError, match="depth must be uint16 in the camera's units, floats in metres"):
            sender.send(b"color", depth, np.eye(4))
    with pytest.raises(ValueError, match=r"depth must be \[height, width\]; its shape is \[1, 4, 1\]"):
        sender.send(b"color", units[:, :, None], np.eye(4))


@pytest.mark.parametrize("kind", [np.float16, np.float32, np.float64])
def test_metres_beyond_16_bits_are_none(sender, kind):
    metres = np.array([[1.5, 65.53, 65.6, 70, -1, 0, np.nan, np.inf, -np.inf]], kind)
    expected = [1500, round(1000 * float(metres[0, 1])), 0, 0, 0, 0, 0, 0, 0]
    assert decoded(sender, metres).tolist() == [expected]


def test_colour_that_is_no_rgb_is_refused(sender):
    rgb = np.zeros((2, 4, 3), np.uint8)
    assert sender._color(rgb).startswith(b"\xff\xd8")
    for color in (rgb.astype(np.float32), rgb.tolist(), memoryview(b"color")):
        with pytest.raises(TypeError, match="color must be uint8 or the bytes"):
            sender.send(color, b"depth", np.eye(4))
    for color in (np.zeros((2, 4, 4), np.uint8), rgb[:, :, 0], rgb[None]):
        with pytest.raises(ValueError, match=r"color must be \[height, width, 3\], red first; its shape is \["):
            sender.send(color, b"depth", np.eye(4))


def test_a_pose_that_says_nothing_is_not_sent(sender):
    unknown = np.eye(4)
    unknown[0, 3] = np.nan
    with pytest.raises(ValueError, match="not finite; leave frames out whose pose is not known"):
        sender.send(b"color", b"depth", unknown)
    for pose in (np.eye(3), np.eye(4)[:3], np.eye(4).reshape(16)):
        with pytest.raises(ValueError, match=r"pose must be \[4, 4\]; its shape is \["):
            sender.send(b"color", b"depth", pose)
    with pytest.raises(ValueError, match="timestamp must be seconds; it is nan"):
        sender.send(b"color", b"depth", np.eye(4), float("nan"))
    assert (sender.taken, sender.skipped) == (0, 0)


def test_an_orientation_that_is_no_rotation_is_not_sent(sender):
    for orientation in (np.eye(3), [0, 0, 1], 1.0):
        with pytest.raises(ValueError, match=r"orientation must be \[4\], a quaternion x, y, z, w; its shape is \["):
            sender.send(b"color", b"depth", None, orientation=orientation)
    for orientation in ([0, 0, 0, 0], [1, 1, 0, 0], [0, 0, 0, np.nan]):
        with pytest.raises(ValueError, match="orientation must be a unit quaternion; its length is"):
            sender.send(b"color", b"depth", None, orientation=orientation)
    assert (sender.taken, sender.skipped) == (0, 0)


@pytest.mark.parametrize("compress", [False, True])
def test_depth_is_encoded_without_loss(sender, compress):
    assert not sender._compress_depth  # on one machine
    sender._compress_depth = compress
    random = np.random.default_rng(5)
    for shape in ((2, 4), (1, 1), (37, 3), (480, 640)):
        depth = random.integers(0, 65536, shape).astype(np.uint16)
        assert np.array_equal(decoded(sender, depth), depth)
        assert np.array_equal(np.asarray(Image.open(io.BytesIO(sender._depth(depth)))), depth)


def test_the_file_works_alone_and_needs_pillow_for_colour_as_arrays_only(tmp_path):
    script = """
import sys, numpy
sys.modules["PIL"] = None  # as where it is not installed
from sender import FrameSender
sender = FrameSender(sys.argv[1], dict(width=4, height=2, fx=5, fy=5, cx=1.5, cy=0.5))
print(sender.send(b"color", b"depth", numpy.eye(4)))
print(sender.send(b"color", numpy.ones((2, 4)), numpy.eye(4)))
sender.send(numpy.zeros((2, 4, 3), numpy.uint8), b"depth", numpy.eye(4))
"""
    shutil.copy(pathlib.Path(ovimap.__file__).with_name("sender.py"), tmp_path)
    server = Scripted(lambda path, count: 200)
    done = subprocess.run([sys.executable, "-c", script, server.address], cwd=tmp_path, capture_output=True, text=True, env={"PATH": ""})
    server.end()
    assert done.stdout == "True\nTrue\n" and "ovimap" not in done.stderr
    assert done.stderr.splitlines()[-1].startswith("ModuleNotFoundError: sending colour as an array needs Pillow; run `pip install pillow`")


def test_a_frame_whose_answer_is_lost_is_not_sent_twice():
    server = Scripted(lambda path, count: None if path == "/api/frames" else 200)
    with pytest.raises(SendError, match="may have been taken"):
        FrameSender(server.address, CAMERA).send(b"color", b"depth", np.eye(4), patience_s=9)
    assert server.frames() == [None]
    server.end()


def test_a_connection_that_was_let_go_is_opened_again():
    server = Scripted(lambda path, count: 201 if path == "/api/camera" else 200)
    sender = FrameSender(server.address, CAMERA)
    sender._connection.sock.recv(1, socket.MSG_PEEK)  # until it is closed there
    assert sender.send(b"color", b"depth", np.eye(4)) and server.frames() == [None]
    server.end()


def test_further_tries_of_a_frame_say_so():
    server = Scripted(lambda path, count: 503 if path == "/api/frames" and count < 4 else 200)
    sender = FrameSender(server.address, CAMERA)
    assert sender.send(b"color", b"depth", np.eye(4), patience_s=60) and sender.send(b"color", b"depth", np.eye(4))
    assert server.frames() == [None, "1", "1", None] and (sender.taken, sender.skipped) == (2, 0)
    server.end()


def test_a_frame_that_is_too_large_is_not_sent():
    server = Scripted(lambda path, count: 200)
    with pytest.raises(SendError, match="33.0 MiB, the server takes 32"):
        FrameSender(server.address, CAMERA).send(bytes(33 << 20), b"depth", np.eye(4))
    assert server.frames() == []
    server.end()


def test_where_nobody_listens_it_says_what_to_start():
    with socket.socket() as unheard:
        unheard.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{unheard.getsockname()[1]}"
        with pytest.raises(ConnectionError, match=rf"no server answers at {address} .*refused.*start `ovimap serve --live http"):
            FrameSender(address, {"width": 4, "height": 3, "fx": 4, "fy": 4, "cx": 2, "cy": 1.5})


def test_a_server_that_ends_before_the_map_is_saved_is_told():
    server = Scripted(lambda path, count: 500 if path == "/api/map" else 202)
    sender = FrameSender(server.address, CAMERA)
    with pytest.raises(SendError, match="answered 500"):
        sender.finish()
    server.end()
    sender.close()
    with pytest.raises(SendError, match="ended before it said that the map is saved"):
        sender.finish()
