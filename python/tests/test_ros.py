# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""ovimap-ros as a process between a robot (these tests, or a real ROS 2) and a map server: all that goes over DDS is checked for values."""
import contextlib
import itertools
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import ovimap
import pytest

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed; tools/setup.sh --tests installs it")
pytest.importorskip("rosbags")
from ovimap.ros import messages, types
from ovimap.ros.messages import POINT, header_of
from ovimap.ros.node import CLOCK, EVENTS, LATCHED, SENSOR_DATA, STATIC_TRANSFORMS, TRANSFORMS, Node, Quality
from ros_fixture import image, info, moved, transforms

PROGRAM = os.environ.get("OVIMAP_PROGRAM")
ROS2 = os.environ.get("OVIMAP_ROS2_PYTHON")
DOMAIN = 1 + os.getpid() % 100
FRAMES = 10
WRITTEN = json.loads((pathlib.Path(__file__).parent / "ros2/written.json").read_text())["messages"]
RELIABLE = Quality(depth=30)
# This machine alone, without multicast, which many places forbid.
LOOPBACK = """<CycloneDDS><Domain><General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>40</MaxAutoParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>"""
needs_program = pytest.mark.skipif(not PROGRAM, reason="the program was not built; set OVIMAP_PROGRAM")


@pytest.fixture(scope="module", autouse=True)
def loopback():
    os.environ.setdefault("CYCLONEDDS_URI", LOOPBACK)


@pytest.fixture(scope="module")
def node(loopback):
    return Node(DOMAIN)


class Program:
    """A process whose lines on stderr are kept; Ctrl-C ends it."""

    def __init__(self, *command, stdout=None):
        self.process = subprocess.Popen(command, stdout=stdout, stderr=subprocess.PIPE, text=True)
        self.lines = []
        self._reading = threading.Thread(target=lambda: self.lines.extend(self.process.stderr), daemon=True)
        self._reading.start()

    def __enter__(self):
        return self

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        code = self.process.wait(timeout=60)
        self._reading.join()
        return code

    def __exit__(self, kind, *_):
        self.end()
        if kind:
            print(*self.lines)  # pytest shows it
        for stream in (self.process.stdout, self.process.stderr):
            if stream:
                stream.close()


def ovimap_ros(*options):
    return Program(sys.executable, "-m", "ovimap.ros.command", "--domain", str(DOMAIN), *map(str, options))


@contextlib.contextmanager
def live_server(out):
    command = PROGRAM, "serve", "http", "--live", "-o", str(out), "--set", "live.queue=60", "--port", "0", "--viewer", "none", "--json"
    with Program(*command, stdout=subprocess.PIPE) as program:
        program.address = json.loads(program.process.stdout.readline())["address"]
        yield program


def until(what, seconds=60):
    """Its value, once it is one; waits long, for machines that do much else."""
    end = time.monotonic() + seconds
    while not (value := what()):
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.02)
    return value


def first(subscription):
    return until(lambda: next(subscription.take(), None))


def test_bytes_of_ros_pass_and_others_do_not(node):
    other = Node(DOMAIN)
    for number, entry in enumerate(WRITTEN):
        if entry["type"].startswith("std_srvs"):
            continue
        writer = other.publisher(entry["type"], f"/bytes{number}", RELIABLE)
        reader = node.subscription(entry["type"], f"/bytes{number}", RELIABLE)
        until(lambda: writer.subscribers and reader.publishers)
        data = bytes.fromhex(entry["cdr"])
        writer.publish_bytes(data)
        message = first(reader)
        assert types.encode(entry["type"], message) == types.encode(entry["type"], types.decode(entry["type"], data)), entry["type"]
        with contextlib.suppress(Exception):  # the writer may see it already
            writer.publish_bytes(data[: len(data) // 2 // 4 * 4])
        writer.publish_bytes(data)
        assert first(reader) is not None, "what is cut off is not read as something else"


def test_a_late_subscriber_gets_what_is_latched(node):
    writer = Node(DOMAIN).publisher("rosgraph_msgs/msg/Clock", "/latched", LATCHED)
    for second in (1, 2):
        writer.publish(types.make("rosgraph_msgs/msg/Clock", clock=messages.stamp_of(second * 10**9)))
    assert first(node.subscription("rosgraph_msgs/msg/Clock", "/latched", LATCHED)).clock.sec == 2


class Robot:
    """Publishes a recording's frames; colour as JPEG where asked."""

    def __init__(self, node, room, name):
        self.node, self.name, self.recorded = node, name, list(ovimap.open_source(room).frames(f":{FRAMES}"))
        self.color = node.publisher("sensor_msgs/msg/Image", f"/{name}/color/image", RELIABLE)
        self.depth = node.publisher("sensor_msgs/msg/Image", f"/{name}/depth/image", RELIABLE)
        self.infos = [node.publisher("sensor_msgs/msg/CameraInfo", f"/{name}/{kind}/camera_info", RELIABLE) for kind in ("color", "depth")]
        self.tf = node.publisher("tf2_msgs/msg/TFMessage", "/tf", TRANSFORMS)
        self.tf_static = node.publisher("tf2_msgs/msg/TFMessage", "/tf_static", STATIC_TRANSFORMS)
        self.tf_static.publish(transforms((f"{name}_base", f"{name}_optical", 1, moved(0.25))))

    def topics(self):
        return "--color", f"/{self.name}/color/image", "--depth", f"/{self.name}/depth/image", "--reliable"

    def wait_for_listener(self):
        until(lambda: all(one.subscribers for one in (self.color, self.depth, self.tf, self.tf_static, *self.infos)))

    def send(self, number, metres=False):
        frame, time_ns, optical = self.recorded[number % FRAMES], 10**18 + number * 33_000_000, f"{self.name}_optical"
        for out in self.infos:
            out.publish(info(frame.camera, optical))
        pose = np.array(frame.world_from_camera) @ np.linalg.inv(moved(0.25))
        self.tf.publish(transforms(("map", f"{self.name}_base", time_ns, pose)))
        depth = np.array(frame.depth) if metres else np.rint(np.array(frame.depth) * 1000).astype(np.uint16)
        self.color.publish(image(time_ns, np.array(frame.color), "rgb8", optical))
        self.depth.publish(image(time_ns, depth, "32FC1" if metres else "16UC1", optical))


def distances_to_depth(world_points, frame):
    """How far points (N x 3, metres) are from the frame's depth along its viewing rays' z, in metres; of those in the image alone."""
    camera, depth = frame.camera, np.array(frame.depth)
    x, y, z = (np.linalg.inv(frame.world_from_camera) @ np.c_[world_points, np.ones(len(world_points))].T)[:3]
    column, row = np.rint(camera.fx * x / z + camera.cx).astype(int), np.rint(camera.fy * y / z + camera.cy).astype(int)
    inside = (z > 0) & (column >= 0) & (column < camera.width) & (row >= 0) & (row < camera.height)
    assert inside.sum() > 100, "the camera saw the cloud"
    return np.abs(z[inside] - depth[row[inside], column[inside]])


@needs_program
@pytest.mark.parametrize("metres", [False, True])
def test_a_robots_images_are_mapped_and_the_map_comes_back(node, room, tmp_path, metres):
    robot = Robot(node, room, f"robot{int(metres)}")
    out = tmp_path / "ros.ovimap"
    objects = node.subscription("sensor_msgs/msg/PointCloud2", f"/{robot.name}/objects", LATCHED)
    with live_server(out) as server, ovimap_ros(server.address, *robot.topics(), "--name", robot.name) as bridge:
        robot.wait_for_listener()
        numbers = itertools.count()

        def map_after_a_frame():
            robot.send(next(numbers), metres)
            time.sleep(0.25)  # the map is handed out about once a second, while frames come
            return next((cloud for cloud in objects.take() if cloud.width), None)

        cloud = until(map_after_a_frame)
        found = first(node.subscription("vision_msgs/msg/Detection3DArray", f"/{robot.name}/detections", LATCHED))
        bridge.end()
        sent = next(numbers)
        lines = [line.removeprefix("ovimap-ros: ") for line in bridge.lines]
        assert "poses are in the frame 'map'; --world names another\n" in lines
        # A writer learns of a reader before the reader learns of it: the first image may come before any transform does.
        told = re.fullmatch(r"(\d+) frames sent, 0 skipped; the map is saved(?:; (1) without a transform)?\n", lines[-1])
        assert told and int(told[1]) + int(told[2] or 0) == sent, lines
        assert json.loads(server.process.stdout.readline())["saved"]["frames"] == int(told[1])
    assert cloud.header.frame_id == found.header.frame_id == "map"
    points = cloud.data.view(POINT)
    assert {str(number) for number in np.unique(points["instance"])} - {"0"}
    # Which objects the first cloud holds is a matter of timing; each of them lies where the camera saw it.
    assert np.median(distances_to_depth(np.stack([points["x"], points["y"], points["z"]], 1), robot.recorded[0])) < 0.03
    assert len(ovimap.Map.open(out)) > 0


@pytest.fixture(scope="module")
def named_map(saved_map, tmp_path_factory):
    """A copy of the map with one object that people named."""
    path = tmp_path_factory.mktemp("named") / "room.ovimap"
    shutil.copyfile(saved_map, path)
    number = int(ovimap.Map.open(path).instances.ids[3])
    subprocess.run([PROGRAM, "edit", path, "rename", str(number), "Tea pot"], check=True, capture_output=True)
    return path, number


@needs_program
def test_what_a_map_holds_is_published(node, named_map):
    path, named = named_map
    with ovimap_ros(path, "--name", "/kept", "--world", "house", "--sim-time") as bridge:
        clock = node.publisher("rosgraph_msgs/msg/Clock", "/clock", CLOCK)
        until(lambda: clock.publish(types.make("rosgraph_msgs/msg/Clock", clock=messages.stamp_of(5 * 10**9))) or clock.subscribers)
        cloud, found, markers, grid = (first(node.subscription(kind, f"/kept/{topic}", LATCHED)) for kind, topic in (
            (messages.CLOUD, "objects"), (messages.DETECTIONS, "detections"), (messages.MARKERS, "markers"), (messages.GRID, "grid")))
        frames = node.subscription(messages.TRANSFORM, "/tf_static", STATIC_TRANSFORMS)
        frame = until(lambda: next((entry for message in frames.take() for entry in message.transforms if entry.child_frame_id.startswith("object/")), None))
        assert bridge.end() == 0 and bridge.lines == []
    instances = ovimap.Map.open(path).instances
    assert [int(one.id) for one in found.detections] == instances.ids.tolist() and found.header.frame_id == "house"
    for one, box in zip(found.detections, instances.boxes):
        center, size = one.bbox.center.position, one.bbox.size
        assert np.allclose([[center.x, center.y, center.z], [size.x, size.y, size.z]], [box.mean(0), box[1] - box[0]], atol=1e-3)
    assert found.header.stamp.sec in (0, 5), "of /clock"
    [tea] = [one for one in found.detections if one.id == str(named)]
    assert (tea.results[0].hypothesis.class_id, tea.results[0].hypothesis.score) == ("Tea pot", 1.0)
    assert (frame.child_frame_id, frame.header.frame_id) == (f"object/tea_pot_{named}", "house")
    shift, middle = frame.transform.translation, instances.boxes[3].mean(0)
    assert np.allclose([shift.x, shift.y, shift.z], middle, atol=1e-3)
    assert [field.name for field in cloud.fields] == ["x", "y", "z", "rgb", "instance"] and cloud.point_step == POINT.itemsize == 20
    points = cloud.data.view(POINT)
    assert set(np.unique(points["instance"])) <= set(instances.ids.tolist()) and len(points) == cloud.width > 10_000
    inside = points[points["instance"] == named]
    xyz = np.stack([inside["x"], inside["y"], inside["z"]], 1)
    in_box = ((xyz >= instances.boxes[3][0] - 0.02) & (xyz <= instances.boxes[3][1] + 0.02)).all(axis=1)
    assert in_box.mean() > 0.9  # specks of it lie outside
    assert markers.markers[0].action == messages.DELETE_ALL and len(markers.markers) == 1 + 2 * len(instances)
    assert {marker.text for marker in markers.markers} >= {f"Tea pot {named}"}
    assert (grid.info.width * grid.info.height, set(np.unique(grid.data))) == (len(grid.data), {-1, 0, 100})


def test_a_simulated_clock_is_listened_to_while_nothing_else_happens(node):
    """What is not taken would keep the process busy."""
    from ovimap.ros.publishing import Publishing
    from ovimap.ros.reporter import Reporter
    from ovimap.ros.served import MapServer

    publishing = Publishing(Node(DOMAIN), MapServer("http://localhost:1"), lambda: "", Reporter(), name="/idle", simulated_clock=True)
    clock = node.publisher("rosgraph_msgs/msg/Clock", "/clock", CLOCK)
    until(lambda: clock.publish(types.make("rosgraph_msgs/msg/Clock", clock=messages.stamp_of(7 * 10**9))) or publishing.serve(0.05) or
          publishing._clock._latest_ns == 7 * 10**9)  # fmt: skip


@needs_program
def test_the_grid_is_that_of_map_server(named_map, tmp_path):
    from ovimap.ros.grid import grid_of
    pillow = pytest.importorskip("PIL.Image")
    grid = grid_of(named_map[0])
    subprocess.run([PROGRAM, "export", named_map[0], tmp_path / "grid.yaml"], check=True, capture_output=True)
    picture = np.array(pillow.open(tmp_path / "grid_grid.png"))
    assert np.array_equal(grid.cells[::-1] == 100, picture == 0) and np.array_equal(grid.cells[::-1] == 0, picture == 254)
    assert grid.cell_m == 0.05 and np.allclose(grid.world_from_grid @ grid.world_from_grid.T, np.eye(3), atol=1e-5)


@needs_program
def test_a_service_answers_in_words(node, named_map):
    client = node.client(types.QUERY, "/asked/query")
    with ovimap_ros(named_map[0], "--name", "/asked", "--no-grid"):
        until(lambda: client.ready)

        def ask(text):
            number = client.ask(types.make(f"{types.QUERY}_Request", text=text))
            got, reply = until(lambda: next(client.answers(), None))
            assert got == number
            return reply

        reply = until(lambda: (answer := ask("chair")).matches.detections and answer)  # the encoder may still be opened
        expected = ovimap.Map.open(named_map[0]).query("chair")
        assert reply.found and [int(one.id) for one in reply.matches.detections] == [match.id for match in expected.matches]
        assert np.allclose([one.results[0].hypothesis.score for one in reply.matches.detections], [match.probability for match in expected.matches], atol=1e-6)
        nothing = ask("")
        assert not nothing.found and nothing.message and not nothing.matches.detections


@needs_program
def test_a_service_says_where_to_stand(node, named_map):
    client = node.client(types.APPROACH, "/stood/approach")
    robot = {"radius_m": 0.15, "camera_height_m": 1.0}
    with ovimap_ros(named_map[0], "--name", "/stood", "--world", "house", "--no-grid", "--radius", 0.15, "--camera-height", 1):
        until(lambda: client.ready)

        def ask(text, *start):
            points = [types.make("geometry_msgs/msg/Point", **dict(zip("xyz", place))) for place in start]
            number = client.ask(types.make(f"{types.APPROACH}_Request", text=text, start=points))
            got, reply = until(lambda: next(client.answers(), None))
            assert got == number
            return reply

        reply = until(lambda: (answer := ask("chair")).matches.detections and answer)
        opened = ovimap.Map.open(named_map[0])
        expected = opened.approach(int(reply.matches.detections[0].id), **robot)
        assert reply.found and reply.poses.header.frame_id == "house" and len(reply.poses.poses) == len(expected.poses) > 0
        for pose, wanted in zip(reply.poses.poses, expected.poses):
            assert np.allclose([pose.position.x, pose.position.y], [wanted.x, wanted.y], atol=1e-3)
            assert np.isclose(np.cos(2 * np.arctan2(pose.orientation.z, pose.orientation.w) - wanted.yaw), 1, atol=1e-4)
        assert not reply.way.poses, "nobody said where the robot is"
        start = reply.poses.poses[-1].position
        way = ask("chair", (start.x, start.y, start.z))
        assert way.found and way.way.header.frame_id == "house"
        end, best = way.way.poses[-1].pose, way.poses.poses[0]
        assert np.allclose([end.position.x, end.position.y], [best.position.x, best.position.y], atol=1e-3)
        assert np.isclose(end.orientation.z, best.orientation.z, atol=1e-6), "it looks at what is to be seen"
        nothing = ask("elephant skeleton")
        assert not nothing.found and not nothing.poses.poses and nothing.message


@needs_program
def test_a_map_that_is_corrected_or_replaced_is_followed(node, named_map, tmp_path):
    path = tmp_path / "changing.ovimap"
    shutil.copyfile(named_map[0], path)
    found = node.subscription(messages.DETECTIONS, "/changing/detections", LATCHED)

    def names():
        return {one.results[0].hypothesis.class_id for message in found.take() for one in message.detections}

    with ovimap_ros(path, "--name", "/changing", "--no-grid") as bridge:
        until(lambda: "Tea pot" in names())
        subprocess.run([PROGRAM, "edit", path, "rename", str(named_map[1]), "Kettle"], check=True, capture_output=True)
        until(lambda: "Kettle" in names())
        path.rename(tmp_path / "away.ovimap")
        until(lambda: any("there is no map" in line for line in bridge.lines))
        shutil.copyfile(named_map[0], path)
        until(lambda: "Tea pot" in names())
        bridge.end()
        assert len(bridge.lines) == 1


@needs_program
def test_what_becomes_of_standing_queries_is_told_also_to_who_comes_late(node, named_map, tmp_path):
    path = tmp_path / "watched.ovimap"
    shutil.copyfile(named_map[0], path)

    def told_to(subscription, count, events=()):
        def enough():
            nonlocal events
            events = (*events, *(json.loads(message.data) for message in subscription.take()))
            return len(events) >= count and events

        return [(event["event"], event["query"], event.get("object", {}).get("id")) for event in until(enough)]

    with ovimap_ros(path, "--name", "/watched", "--no-grid", "--watch", "Tea pot", "--watch", "elephant skeleton"):
        events = node.subscription(messages.TEXT_LINE, "/watched/events", EVENTS)
        found = ("found", "Tea pot", named_map[1])
        assert told_to(events, 1) == [found]
        subprocess.run([PROGRAM, "edit", path, "hide", str(named_map[1])], check=True, capture_output=True)
        gone = ("gone", "Tea pot", named_map[1])
        assert told_to(events, 1) == [gone]
        assert told_to(node.subscription(messages.TEXT_LINE, "/watched/events", EVENTS), 2) == [found, gone]


@needs_program
def test_publishers_that_double_vanish_or_do_not_fit_are_told(room, tmp_path, node):
    with live_server(tmp_path / "a.ovimap") as server, ovimap_ros(server.address, "--color", "/two/c", "--depth", "/two/d", "--no-publish") as bridge:
        tf = node.publisher("tf2_msgs/msg/TFMessage", "/tf_static", TRANSFORMS)
        until(lambda: any("a publisher of /tf_static offers less than is asked for" in line for line in bridge.lines))
        del tf
        publishers = [Node(DOMAIN).publisher("sensor_msgs/msg/Image", "/two/c", SENSOR_DATA) for _ in range(2)]
        until(lambda: any("2 publishers send images on /two/c" in line for line in bridge.lines))
        publishers.clear()
        until(lambda: any("the publisher of /two/c is gone" in line for line in bridge.lines))
        bridge.end()
        assert "no frame was sent" in bridge.lines[-1]


def test_a_configuration_that_is_none_is_one_line(monkeypatch):
    monkeypatch.setenv("CYCLONEDDS_URI", "<CycloneDDS><Nothing/></CycloneDDS>")
    with ovimap_ros("http://localhost:1") as bridge:
        assert bridge.process.wait(timeout=60) == 2
    assert "DDS cannot begin in domain" in bridge.lines[-1] and "check CYCLONEDDS_URI" in bridge.lines[-1]


def test_without_cyclonedds_one_line_says_so(tmp_path):
    (tmp_path / "cyclonedds.py").write_text("raise ModuleNotFoundError('no', name='cyclonedds')")
    environment = os.environ | {"PYTHONPATH": f"{tmp_path}:{os.environ['PYTHONPATH']}"}
    command = [sys.executable, "-m", "ovimap.ros.command", "http://localhost:1", "--color", "/c", "--depth", "/d"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr == "ovimap-ros: cyclonedds is not installed; pip install 'ovimap[ros]'\n"


@pytest.mark.parametrize(("options", "said"), [
    (("http://localhost:1", "--color", "/c"), "frames need colour and depth"),
    (("none.ovimap",), "there is no map 'none.ovimap'"),
    (("room.ovimap", "--color", "/c", "--depth", "/d"), "'room.ovimap' is no address"),
    (("http://localhost:1", "--no-publish", "--color", "/c", "--depth", "/d", "--domain", "233"), "'233' is no domain of DDS"),
])  # fmt: skip
def test_what_the_user_can_mend_is_one_line(options, said):
    with ovimap_ros(*options) as bridge:
        assert bridge.process.wait(timeout=60) == 2 and bridge.end() == 2
    assert len(bridge.lines) == 1 and said in bridge.lines[0]
