# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Cameras' images become frames: recordings that the makers' libraries write, and software devices in the place of cameras."""
import datetime
import json
import pathlib
import subprocess
import threading
import time

import numpy as np
import ovimap
import PIL.Image
import pytest
import yaml
from ovimap.camera_command import Session, main
from ovimap.cameras import Feed, Relay, TurnRate, Wanted
from sender_fixture import PROGRAM, Serving, needs_program
from test_camera_relay import Sent

rs = pytest.importorskip("pyrealsense2", reason="pyrealsense2 is not installed; run tools/setup.sh --tests")
from ovimap.cameras.realsense import open_realsense  # noqa: E402
from realsense_fixture import BROWN, Sockets, SoftwareCamera, film, lens, picture, stood_on_its_side, turned  # noqa: E402

FRAMES = 12
TRACKED = (96, 72)  # smaller images are not tracked
# Written by SoftwareCamera().record(..., film(3)) with pyrealsense2 2.56.5; later ones write .db3.
OLD_BAG = pathlib.Path(__file__).parents[2] / "tests/recordings/realsense_2.56.bag"


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """As this version of the library records."""
    file = tmp_path_factory.mktemp("recorded") / "drawn.db3"
    SoftwareCamera(size=TRACKED).record(file, film(FRAMES, size=TRACKED))
    return file


def read(camera, told=None):
    sent = Sent()
    relay = Relay(sent, (told if told is not None else []).append, waits=camera.recorded)
    Session(camera, None, relay, print).run()
    return sent, relay


def test_a_recording_gives_every_image_as_it_was_with_its_time(recording):
    told = []
    sent, relay = read(open_realsense(Wanted(file=recording)), told)
    assert len(sent) == FRAMES and relay.pairing.left_out == 0 and not told
    for (color, depth, pose, time_s), (drawn_color, drawn_depth, time_ms) in zip(sent, film(FRAMES, size=TRACKED)):
        assert np.array_equal(color, drawn_color) and np.array_equal(depth, drawn_depth) and pose is None
        assert time_s == pytest.approx(time_ms / 1000, abs=1e-6)


TURN = 0.5  # radians a second about x
RATES = [((TURN, 0.0, 0.0), 1000.0 + 5 * i) for i in range(100)]


def turned_to(orientations):
    return [2 * np.arctan2(x, w) for x, _, _, w in orientations]


def test_a_recording_tells_how_the_camera_turned(tmp_path):
    """Not how its gyroscope stood to depth, which the library does not record."""
    SoftwareCamera(gyroscope_hz=200).record(tmp_path / "a.db3", film(FRAMES), RATES)
    camera = open_realsense(Wanted(file=tmp_path / "a.db3"))
    sent, relay = read(camera)
    assert camera.gyroscope and len(sent) == FRAMES and relay.pairing.left_out == 0
    assert turned_to(sent.orientations) == pytest.approx([TURN * (time_s - 1) for *_, time_s in sent], abs=1e-3)


def test_a_cameras_gyroscope_is_read_at_its_fastest_and_turned_to_depth():
    drawn = SoftwareCamera(gyroscope_hz=400)
    camera, feed = open_realsense(Wanted(width=64, height=48), Sockets(drawn)), Feed(waits=False)
    assert camera.gyroscope and camera._gyroscope[1].fps() == 400
    camera.start(feed)
    drawn.turn((0.1, 0.2, 0.3), 1234.5)
    drawn.show_all(film(1))
    end = time.monotonic() + 30
    entries = feed.entries(30)
    while not isinstance(rate := next(entries), TurnRate):
        assert time.monotonic() < end
    camera.close()
    there = rs.rs2_transform_point_to_point(stood_on_its_side(), [0.1, 0.2, 0.3])
    assert rate.time_s == pytest.approx(1.2345) and list(rate.rad_per_s) == pytest.approx(there) and there == pytest.approx([-0.2, 0.1, 0.3])
    assert not open_realsense(Wanted(width=64, height=48), Sockets(SoftwareCamera())).gyroscope


def test_a_bag_of_an_older_library_is_read():
    camera = open_realsense(Wanted(file=OLD_BAG))
    sent, _ = read(camera)
    assert len(sent) == 3 and camera.rig["depth_camera"]["depth_scale"] == 4000
    assert camera.rig["color_camera"]["distortion"]["coefficients"] == pytest.approx(BROWN)
    for (color, depth, _, time_s), (drawn_color, drawn_depth, time_ms) in zip(sent, film(3)):
        assert np.array_equal(color, drawn_color) and np.array_equal(depth, drawn_depth) and time_s == pytest.approx(time_ms / 1000)


def test_a_recording_tells_cameras_units_and_how_they_stand(recording):
    camera = open_realsense(Wanted(file=recording))
    assert camera.name == "Drawn camera 000111"
    depth, color = camera.rig["depth_camera"], camera.rig["color_camera"]
    assert depth == {"width": 96, "height": 72, "fx": 60, "fy": 61, "cx": 47.5, "cy": 35.5, "depth_scale": 4000}
    assert (color["fx"], color["fy"]) == (55, 56) and color["distortion"]["coefficients"] == pytest.approx(BROWN)
    offset, point = camera.rig["color_from_depth"], [0.3, -0.2, 1.5]
    turn = np.linalg.norm(offset["rotation_vector"])
    axis = np.array(offset["rotation_vector"]) / turn
    cross = np.cross(axis, point)
    moved = np.array(point) * np.cos(turn) + cross * np.sin(turn) + axis * (axis @ point) * (1 - np.cos(turn)) + offset["translation"]
    assert np.allclose(moved, rs.rs2_transform_point_to_point(turned(), point), atol=1e-6)


@needs_program
def test_a_recording_arrives_at_a_server_that_tracks_it_in_place_and_in_colour(tmp_path, capsys):
    """A camera that stands still: the map's surface is what it shows, in metres, and its colours come from the pixels that the other camera's
    place and lens give. The colour image says of each pixel where it is."""
    still = [(*picture(0, TRACKED), 1000.0 + 33 * i) for i in range(FRAMES)]
    SoftwareCamera(size=TRACKED).record(tmp_path / "still.db3", still)
    options = ("--poses", "track", "--masks", "none", "--encoder", "none", "--set", "map.voxel_size_m=0.02")
    with Serving(tmp_path / "a.ovimap", *options) as server:
        assert main(["realsense", "--file", str(tmp_path / "still.db3"), "--url", server.address, "--json"]) == 0
        said = json.loads(capsys.readouterr().out)
        assert said == {"camera": "Drawn camera 000111", "taken": FRAMES, "skipped": 0, "refused": 0, "left_out": 0, "saved": True}
        assert server.saved()["frames"] == FRAMES
    mesh = ovimap.Map.open(tmp_path / "a.ovimap").mesh()
    points, colors = np.array(mesh.vertices, np.float64), np.array(mesh.colors, np.float64)
    u, v = (points[:, :2] / points[:, 2:] * [60, 61] + [47.5, 35.5]).T
    drawn = (6000 + 20 * v + (u > 20) * 1500) * 0.00025
    assert len(points) > 300 and np.median(np.abs(points[:, 2] - drawn)) < 0.01
    there = np.array([rs.rs2_transform_point_to_point(turned(), point) for point in points.tolist()])
    color_lens = lens(55.0, rs.distortion.brown_conrady, BROWN, TRACKED)
    pixels = np.array([rs.rs2_project_point_to_pixel(color_lens, point) for point in there.tolist()])
    inside = np.all((pixels > 4) & (pixels < [91, 67]), axis=1) & (np.abs(u - 20.5) > 3)
    assert inside.sum() > 200
    assert np.median(np.abs(colors[inside, :2] / [2, 3] - pixels[inside])) < 1


@needs_program
def test_a_server_that_wants_poses_is_told_in_one_line(recording, tmp_path, capsys):
    with Serving(tmp_path / "a.ovimap") as server:
        assert main(["realsense", "--file", str(recording), "--url", server.address]) == 1
        told = capsys.readouterr()
        assert "start the server with --poses track" in told.err and f"0 taken, 0 skipped, {FRAMES} refused" in told.out


@needs_program
def test_a_recording_becomes_a_folder_that_the_program_reads(recording, tmp_path, capsys):
    folder = tmp_path / "kitchen"
    assert main(["realsense", "--file", str(recording), "--folder", str(folder)]) == 0
    assert f"{FRAMES} taken" in capsys.readouterr().out
    for kind, column in (("rgb", 0), ("depth", 1)):
        lines = [line.split() for line in (folder / f"{kind}.txt").read_text().splitlines()]
        assert len(lines) == FRAMES
        for (time_s, name), drawn in zip(lines, film(FRAMES, size=TRACKED)):
            assert float(time_s) == pytest.approx(drawn[2] / 1000, abs=1e-6)
            assert np.array_equal(np.asarray(PIL.Image.open(folder / name)), drawn[column])
    given = yaml.safe_load((folder / "camera.yaml").read_text())
    assert given == open_realsense(Wanted(file=recording)).rig
    done = subprocess.run([PROGRAM, "run", folder, "--poses", "track", "--masks", "none", "--encoder", "none", "-o", tmp_path / "a.ovimap"],
                          capture_output=True, text=True)  # fmt: skip
    assert done.returncode == 0 and ovimap.Map.open(tmp_path / "a.ovimap").frames > 0, done.stderr
    assert main(["realsense", "--file", str(recording), "--folder", str(folder)]) == 2
    assert "is not empty; name a new folder" in capsys.readouterr().err


def test_a_folder_keeps_what_the_gyroscope_measured(tmp_path, capsys):
    SoftwareCamera(size=TRACKED, gyroscope_hz=200).record(tmp_path / "a.db3", film(FRAMES, size=TRACKED), RATES)
    assert main(["realsense", "--file", str(tmp_path / "a.db3"), "--folder", str(tmp_path / "a")]) == 0
    assert "sending images and how its gyroscope turns to" in capsys.readouterr().err
    lines = [[float(number) for number in line.split()] for line in (tmp_path / "a/gyroscope.txt").read_text().splitlines()]
    assert [line[0] for line in lines] == pytest.approx([1 + 0.005 * i for i in range(len(lines))], abs=1e-6)
    assert len(lines) > 65 and np.allclose([line[1:] for line in lines], [TURN, 0, 0], atol=1e-6)


@pytest.mark.parametrize("model, name", [(rs.distortion.kannala_brandt4, "kannala_brandt"), (rs.distortion.inverse_brown_conrady, "brown_conrady")])
def test_lenses_bend_as_the_library_says(tmp_path, model, name):
    file, given = tmp_path / "a.db3", lens(55.0, model, [-0.05, 0.06, 0.001, -0.0005, 0 if name == "kannala_brandt" else -0.02])
    SoftwareCamera(color_lens=given).record(file, film(2))
    found = open_realsense(Wanted(file=file)).rig["color_camera"]["distortion"]
    assert found["model"] == name
    if name == "kannala_brandt":
        assert found["coefficients"] == pytest.approx([-0.05, 0.06, 0.001, -0.0005])
        return
    k1, k2, p1, p2, k3 = found["coefficients"]
    for pixel in ([0.0, 0.0], [63.0, 20.0], [31.0, 47.0]):
        x, y, _ = rs.rs2_deproject_pixel_to_point(given, pixel, 1.0)
        r2 = x * x + y * y
        radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
        bent = [x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y]
        assert [bent[0] * 55 + 31.5, bent[1] * 56 + 23.5] == pytest.approx(pixel, abs=0.1)


def test_blue_first_is_turned_over(tmp_path):
    frames = film(3)
    SoftwareCamera(color_format=rs.format.bgr8).record(tmp_path / "a.db3", [(color[..., ::-1].copy(), depth, ms) for color, depth, ms in frames])
    sent, _ = read(open_realsense(Wanted(file=tmp_path / "a.db3")))
    assert all(np.array_equal(color, drawn) for (color, *_), (drawn, *_) in zip(sent, frames)) and len(sent) == 3


def fault_of(*arguments):
    with pytest.raises(ovimap.Error) as told:
        open_realsense(*arguments)
    assert "\n" not in str(told.value)
    return str(told.value)


def test_what_is_no_recording_is_told(tmp_path):
    assert "there is no recording" in fault_of(Wanted(file=tmp_path / "none.bag"))
    for name in ("a.bag", "a.db3", "a.txt"):
        (tmp_path / name).write_bytes(b"#ROSBAG V2.0\n" + bytes(5000))
        assert "cannot be read as a RealSense recording" in fault_of(Wanted(file=tmp_path / name))
    (tmp_path / "cut.bag").write_bytes(OLD_BAG.read_bytes()[:50_000])
    assert "it is cut off" in fault_of(Wanted(file=tmp_path / "cut.bag"))
    SoftwareCamera(kinds=("depth",)).record(tmp_path / "depth.db3", film(3))
    assert "holds no colour images" in fault_of(Wanted(file=tmp_path / "depth.db3"))
    SoftwareCamera(color_lens=lens(0.0)).record(tmp_path / "bare.db3", film(3))
    assert fault_of(Wanted(file=tmp_path / "bare.db3")).startswith("Color holds no calibration (fx 0, fy 1)")


def test_no_camera_several_and_two_of_one_number_are_told():
    small = {"width": 64, "height": 48}
    assert fault_of(Wanted(**small), Sockets()).startswith("no RealSense camera is plugged in; plug it in")
    two = Sockets(SoftwareCamera("1"), SoftwareCamera("2"))
    assert fault_of(Wanted(**small), two) == "2 RealSense cameras are plugged in (1, 2); choose one with --serial"
    assert open_realsense(Wanted(serial="2", **small), two).name == "Drawn camera 2"
    assert "no RealSense camera has the serial number 3; plugged in: 1, 2" in fault_of(Wanted(serial="3", **small), two)
    same = Sockets(SoftwareCamera("1"), SoftwareCamera("1"))
    for wanted in (Wanted(**small), Wanted(serial="1", **small)):
        assert fault_of(wanted, same) == "2 RealSense cameras have the serial number 1; unplug all but the one you mean"
    assert fault_of(Wanted(), Sockets(SoftwareCamera())).endswith("choose with --size and --fps among: 64x48 at 30")


class Watched:
    """A session on a thread of its own, and what it was told and sent."""

    def __init__(self, drawn, sockets, **options):
        self.told, self.sent, self.drawn, self.sockets = [], Sent(), drawn, sockets
        self.relay = Relay(self.sent, self.told.append, waits=False)
        self.session = Session(self.open(), self.open, self.relay, self.told.append, **options)
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def open(self):
        return open_realsense(Wanted(width=64, height=48), self.sockets)

    def run(self):
        self.whole = self.session.run()

    def show(self, frames):
        """Each until it arrives: a software device loses what comes while nobody listens."""
        for frame in frames:
            before, end = len(self.sent), time.monotonic() + 30
            while len(self.sent) == before and time.monotonic() < end:
                self.drawn.show_all([frame])
                time.sleep(0.05)
            assert len(self.sent) > before

    def until(self, words):
        end = time.monotonic() + 30
        while not any(words in line for line in self.told):
            assert time.monotonic() < end, self.told
            time.sleep(0.02)

    def ended(self):
        self.thread.join(timeout=30)
        assert not self.thread.is_alive()
        return self.whole


def test_a_camera_that_is_unplugged_is_waited_for_and_goes_on():
    drawn = SoftwareCamera()
    sockets = Sockets(drawn)
    watched = Watched(drawn, sockets, wait_s=20, quiet_s=30)
    watched.show(film(5))
    sockets.unplug(drawn.device)
    watched.until("Drawn camera 000111 was unplugged; waiting 20 s for it to come back")
    sockets.devices.append(drawn.device)
    watched.until("Drawn camera 000111 is back")
    watched.show(film(5, start_ms=2000.0))
    watched.session._wait_s = 0
    sockets.unplug(drawn.device)
    assert watched.ended() is False
    times = [time_s for *_, time_s in watched.sent]
    assert times == sorted(times) and times[0] == pytest.approx(1.0) and times[-1] == pytest.approx(2.133, abs=0.001)


def test_a_camera_that_falls_silent_is_lost():
    drawn = SoftwareCamera()
    watched = Watched(drawn, Sockets(drawn), wait_s=0, quiet_s=0.5)
    assert watched.ended() is False
    assert watched.told == ["Drawn camera 000111 has sent no image for 0.5 s; waiting 0 s for it to come back"]


def test_another_camera_in_its_place_is_refused():
    small = Wanted(width=64, height=48)
    camera, other = (open_realsense(small, Sockets(SoftwareCamera(color_lens=lens(focal)))) for focal in (55.0, 50.0))
    session = Session(camera, lambda: other, Relay(Sent(), print, waits=False), print, wait_s=5, quiet_s=0.2)
    with pytest.raises(ovimap.Error, match="has another calibration than the camera that was lost"):
        session.run()


def test_no_server_and_no_library_are_told(recording, capsys, monkeypatch):
    assert main(["realsense", "--file", str(recording), "--url", "http://localhost:1/"]) == 2
    said = capsys.readouterr().err
    assert "http://localhost:1/ cannot be reached" in said and "ovimap serve --live http --poses track" in said
    monkeypatch.setitem(__import__("sys").modules, "pyrealsense2", None)
    assert main(["realsense"]) == 2
    assert capsys.readouterr().err == "ovimap-camera: pyrealsense2 is not installed; pip install 'ovimap[realsense]'\n"


def test_a_library_that_lacks_one_of_the_system_is_told(tmp_path, capsys, monkeypatch):
    (tmp_path / "pyrealsense2.py").write_text("raise ImportError('libusb-1.0.so.0: no such file', name='pyrealsense2.pyrealsense2')")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(__import__("sys").modules, "pyrealsense2")
    assert main(["realsense"]) == 2
    said = capsys.readouterr().err
    assert said.startswith("ovimap-camera: pyrealsense2 cannot be loaded (libusb-1.0.so.0: no such file); install")


def test_oak_messages_become_a_rig_and_images():
    dai = pytest.importorskip("depthai", reason="depthai is not installed; run tools/setup.sh --tests")
    from ovimap.cameras.oak import image_of, rig_of_messages

    def message(kind, pixels, model=dai.CameraModel.Perspective, coefficients=(), focal=500.0):
        made = dai.ImgFrame()
        made.setType(dai.ImgFrame.Type.RAW16 if kind == "depth" else dai.ImgFrame.Type.RGB888i)
        made.setWidth(64), made.setHeight(48), made.setFrame(pixels)
        made.setTimestampDevice(datetime.timedelta(seconds=12.5))
        matrix = [[focal, 0, 31.0], [0, focal + 1, 23.0], [0, 0, 1]]
        made.setTransformation(dai.ImgTransformation(64, 48, matrix, model, list(coefficients)))
        return made

    color, depth, _ = film(1)[0]
    made = {"color": message("color", color), "depth": message("depth", depth)}
    for kind, pixels in (("color", color), ("depth", depth)):
        image = image_of(kind, made[kind])
        assert image.time_s == 12.5 and np.array_equal(image.pixels, pixels) and image.pixels.dtype == pixels.dtype
    rig = rig_of_messages(dai, made)
    assert rig["color_camera"] == {"width": 64, "height": 48, "fx": 500, "fy": 501, "cx": 31, "cy": 23}
    assert rig["depth_camera"]["depth_scale"] == 1000 and rig["color_from_depth"]["translation"] == [0, 0, 0]

    def lens_of(*given):
        return rig_of_messages(dai, {**made, "color": message("color", color, *given)})["color_camera"]["distortion"]

    eight = [0.4, -0.3, 0.001, -0.002, 0.05, 0.6, -0.1, 0.02]
    assert lens_of(dai.CameraModel.Perspective, eight + 6 * [0.0])["coefficients"] == pytest.approx(eight)
    assert lens_of(dai.CameraModel.Fisheye, [0.05, -0.02, 0.006, -0.001])["model"] == "kannala_brandt"
    with pytest.raises(ovimap.Error, match="Perspective one with 14 numbers, which is not read"):
        lens_of(dai.CameraModel.Perspective, eight + 6 * [0.01])
    with pytest.raises(ovimap.Error, match="holds no calibration"):
        made["depth"].setTransformation(dai.ImgTransformation(64, 48))
        rig_of_messages(dai, made)


def test_orbbec_frames_become_a_rig_and_images():
    ob = pytest.importorskip("pyorbbecsdk", reason="pyorbbecsdk2 is not installed; docs/cameras.md says how")
    from ovimap.cameras.orbbec import images_of, rig_of_frames
    ob.Context.set_logger_to_file(ob.OBLogLevel.NONE, "")  # else it leaves a folder Log here

    def frame(kind, pixels, focal, **lens):
        form, said = (ob.OBFormat.Y16, ob.OBFrameType.DEPTH_FRAME) if kind == "depth" else (ob.OBFormat.RGB, ob.OBFrameType.COLOR_FRAME)
        made = ob.Frame.create_video_frame(said, form, 64, 48, 128 if kind == "depth" else 192)
        made.update_data(np.ascontiguousarray(pixels).view(np.uint8).reshape(-1))
        ob.Frame.set_frame_device_timestamp_us(made, 12_500_000)
        profile, inner, bent = made.get_stream_profile().as_video_stream_profile(), ob.OBCameraIntrinsic(), ob.OBCameraDistortion()
        inner.width, inner.height, inner.fx, inner.fy, inner.cx, inner.cy = 64, 48, focal, focal + 1, 31.0, 23.0
        bent.model = ob.OBCameraDistortionModel.BROWN_CONRADY_K6
        for name, value in lens.items():
            setattr(bent, name, value)
        profile.set_intrinsic(inner), profile.set_distortion(bent)
        made.set_stream_profile(profile)
        return made

    color, depth, _ = film(1)[0]
    frames = ob.Frame.create_frame_set()
    for kind, pixels, lens in (("depth", depth, {}), ("color", color, {"k1": 0.1, "p1": 0.01, "k4": 0.2})):
        frames.push_frame(frame(kind, pixels, 60.0 if kind == "depth" else 55.0, **lens))
    for image, (kind, pixels) in zip(images_of(frames), (("depth", depth), ("color", color))):
        assert image.kind == kind and image.time_s == 12.5 and np.array_equal(image.pixels, pixels)
    of, to = frames.get_depth_frame(), frames.get_color_frame()
    offset = ob.OBExtrinsic()
    offset.rot, offset.transform = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]], np.float32), np.array([15, 1, -2], np.float32)
    of.get_stream_profile().bind_extrinsic_to(to.get_stream_profile(), offset)
    of.set_value_scale(0.25)  # mm
    rig = rig_of_frames(ob, of, to)
    assert rig["depth_camera"] == {"width": 64, "height": 48, "fx": 60, "fy": 61, "cx": 31, "cy": 23, "depth_scale": 4000}
    assert rig["color_camera"]["distortion"]["coefficients"] == pytest.approx([0.1, 0, 0.01, 0, 0, 0.2, 0, 0])
    assert rig["color_from_depth"]["translation"] == pytest.approx([0.015, 0.001, -0.002])
    assert rig["color_from_depth"]["rotation_vector"] == pytest.approx([0, 0, np.pi / 2])
    inner, bent = (getattr(to.get_stream_profile().as_video_stream_profile(), name)() for name in ("get_intrinsic", "get_distortion"))
    bent.model = ob.OBCameraDistortionModel.NONE
    seen = ob.transformation3dto2d(ob.OBPoint3f(0.0, -1000.0, 1000.0), inner, bent, offset)  # mm: the turn takes -y to x
    assert [seen.x, seen.y] == pytest.approx([55 * 1015 / 998 + 31, 56 * 1 / 998 + 23], abs=1e-3)


@pytest.mark.parametrize("maker, library, said", [("oak", "depthai", "no OAK camera is plugged in"), ("orbbec", "pyorbbecsdk", "no Orbbec camera is plugged in")])
def test_no_other_camera_is_told(maker, library, said, capsys):
    pytest.importorskip(library, reason=f"{library} is not installed; docs/cameras.md says how")
    assert main([maker]) == 2
    assert capsys.readouterr().err.startswith(f"ovimap-camera: {said}; plug it in")
    assert main([maker, "--file", "a.bag"]) == 2
    assert "are not read; leave --file out" in capsys.readouterr().err
