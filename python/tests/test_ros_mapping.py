# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Images, cameras and transforms of a robot become frames; what goes wrong is said once, counted, and costs only itself."""
import numpy as np
import ovimap
import pytest

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed; tools/setup.sh --tests installs it")
pytest.importorskip("rosbags")
from ovimap.ros.mapping import Mapping, Options, info_topic
from ovimap.ros.pairing import KEPT_IMAGES, Pairing, Poses
from ovimap.ros.reporter import Reporter
from ovimap.sender import SendError
from ros_fixture import MS, Sent, Topics, compressed, image, info, moved, odometry, pose, transforms

COLOR, DEPTH = np.full((2, 4, 3), 7, np.uint8), np.full((2, 4), 500, np.uint16)
CAMERA = ovimap.PinholeCamera(4, 2, 5.0, 6.0, 1.5, 0.5)
START = 10**18


class Robot:
    """A camera at `optical`, which hangs on `base`, which moves in `odom` at 1 m/s; and what maps it."""

    def __init__(self, capsys, sent=None, **options):
        self.topics, self.sent, self.capsys = Topics(), sent if sent is not None else Sent(), capsys
        self.mapping = Mapping(self.topics, Options("/color/image", "/depth/image", **options), self.sent, Reporter())
        self.heard = ""

    def begin(self, **camera):
        for kind in ("color", "depth"):
            self.topics.give(f"/{kind}/camera_info", info(CAMERA, **camera))
        self.topics.give("/tf_static", transforms(("base", "optical", 1, moved(0.5))))
        return self

    def frame(self, number, *, color=None, depth=None, tf=True, step=33 * MS, start=START):
        time_ns = start + number * step
        self.topics.give("/color/image", color if color is not None else image(time_ns, COLOR, "rgb8"))
        self.topics.give("/depth/image", depth if depth is not None else image(time_ns, DEPTH, "16UC1"))
        if tf:
            self.topics.give("/tf", transforms(("odom", "base", time_ns, moved(number * step / 1e9))))
        self.mapping.step()

    def frames(self, *numbers, **options):
        for number in numbers:
            self.frame(number, **options)

    def said(self):
        """Lines since the last call."""
        return [line.removeprefix("ovimap-ros: ") for line in self.capsys.readouterr().err.splitlines()]

    @property
    def counts(self):
        return dict(self.mapping._report.counts)


@pytest.fixture
def robot(capsys):
    return Robot(capsys).begin()


def test_images_and_transforms_become_frames(robot):
    robot.frames(0, 1, 2)
    assert len(robot.sent) == 3 and robot.counts == {}
    color, depth, matrix, seconds = robot.sent[2]
    assert np.array_equal(color, COLOR) and np.array_equal(depth, DEPTH) and seconds == (START + 66 * MS) / 1e9
    assert np.allclose(matrix, moved(0.566)), "optical in base in odom"
    assert robot.sent.rig["depth_camera"] == {"width": 4, "height": 2, "fx": 5, "fy": 6, "cx": 1.5, "cy": 0.5, "depth_scale": 1000}
    assert robot.sent.rig["color_from_depth"] == {"rotation_vector": [0, 0, 0], "translation": [0, 0, 0]}
    assert robot.said() == ["poses are in the frame 'odom'; --world names another"]


def test_a_pose_is_that_of_the_images_time(robot):
    robot.frame(0)
    robot.frame(1, tf=False)
    assert len(robot.sent) == 1, "its transform may still come"
    robot.frame(2)
    assert [round(float(frame[2][0, 3]), 6) for frame in robot.sent] == [0.5, 0.533, 0.566]


def test_depth_is_matched_with_the_nearest_colour():
    pairing = Pairing()
    for time_ns, depth in ((25, True), (20, False), (30, False), (90, True), (140, False)):
        pairing.add(time_ns * MS, f"{'depth' if depth else 'color'} {time_ns}", depth=depth)
    [pair] = pairing.take()
    assert (pair.color, pair.depth, pair.time_ns) == ("color 20", "depth 25", 25 * MS) and pairing.unpaired == 1
    assert pairing.depths == [], "what has no colour is never sent later"


def test_only_so_much_is_kept():
    pairing, poses = Pairing(), Poses()
    for i in range(200):
        pairing.add(i, i, depth=True)
        poses.add_transforms(transforms(("odom", "base", i * 10**9, np.eye(4))), static=False)
    assert len(pairing.depths) == KEPT_IMAGES and pairing.unpaired == 200 - KEPT_IMAGES
    assert len(poses.tree.links["base"].times_ns) == 12


def test_metres_and_compressed_pictures_are_sent(capsys):
    robot, metres = Robot(capsys).begin(), np.full((2, 4), 1.25, np.float32)
    robot.frame(0, color=compressed(START, b"\xff\xd8 bytes", "jpeg"), depth=image(START, metres, "32FC1"))
    assert robot.sent[0][0] == b"\xff\xd8 bytes" and np.array_equal(robot.sent[0][1], metres)
    assert robot.sent.rig["depth_camera"]["depth_scale"] == 5000
    robot.frame(1)
    assert len(robot.sent) == 1, "millimetres would be read in the wrong unit"
    assert any("changes between depth in metres and in millimetres" in line for line in robot.said()) and robot.counts == {"refused": 1}


def test_frames_wait_for_the_cameras(capsys):
    robot = Robot(capsys)
    robot.frames(0, 1, 2)
    assert not robot.sent
    robot.begin().frames(3)
    assert len(robot.sent) == 4, "transforms of before were kept"


def test_a_separate_colour_camera_stands_where_tf_says(robot):
    robot.topics.give("/tf_static", transforms(("optical", "color_optical", 1, moved(0.05))))
    robot.frame(0, color=image(START, COLOR, "rgb8", "color_optical"))
    assert np.allclose(robot.sent.rig["color_from_depth"]["translation"], [-0.05, 0, 0])


def test_a_colour_camera_that_hangs_nowhere_is_told(robot):
    for number in range(3):
        robot.frame(number, color=image(START + number * 33 * MS, COLOR, "rgb8", "elsewhere"))
    assert not robot.sent and [line.split(";")[0] for line in robot.said()] == ["no transform from 'optical' to 'elsewhere' yet"]


@pytest.mark.parametrize(("give", "expected"), [
    (lambda number: pose(START + number * 33 * MS, moved(2.0 + number)), [2, 3]),  # of the camera itself
    (lambda number: odometry(START + number * 33 * MS, moved(2.0 + number), "base"), [2.5, 3.5]),
])  # fmt: skip
def test_a_topic_of_poses_stands_in_for_tf(capsys, give, expected):
    robot = Robot(capsys, poses="/where").begin()
    robot.frame(0)  # now it is known which frame depth is in
    assert not robot.sent
    for number in (0, 1):
        robot.topics.give("/where", give(number))
    robot.frame(1)
    assert [frame[2][0, 3] for frame in robot.sent] == expected


def test_without_poses_the_server_tracks(capsys):
    robot = Robot(capsys, poses="none").begin()
    robot.frames(0, 1, tf=False)
    assert [frame[2] for frame in robot.sent] == [None, None]


def test_a_topic_of_another_encoding_is_said_once_and_counted(robot):
    for number in range(3):
        robot.frame(number, color=image(START + number * 33 * MS, DEPTH, "bayer_rggb8"))
    assert "/color/image has the encoding 'bayer_rggb8'" in robot.said()[1] and robot.said() == [] and robot.counts == {"refused": 3}
    robot.frame(3)
    assert len(robot.sent) == 1


def test_a_camera_without_calibration_is_said(capsys):
    robot = Robot(capsys)
    blank = info(CAMERA)
    blank.k[:] = 0
    robot.topics.give("/depth/camera_info", blank)
    robot.frames(0, 1)
    assert not robot.sent and "/depth/camera_info holds no calibration" in robot.said()[0]


def test_missing_camera_info_is_said(capsys, monkeypatch):
    robot = Robot(capsys)
    robot.frame(0)
    monkeypatch.setattr("ovimap.ros.mapping.PATIENCE_S", 0)
    robot.frames(1, 2)
    assert [line.split(",")[0] for line in robot.said()] == ["no camera_info on /color/camera_info", "no camera_info on /depth/camera_info"]


def test_a_topic_that_nobody_publishes_is_said(capsys, monkeypatch):
    monkeypatch.setattr("ovimap.ros.mapping.PATIENCE_S", 0)
    robot = Robot(capsys)
    robot.mapping.step()
    robot.mapping.step()
    assert [line.split(";")[0] for line in robot.said()] == [f"nobody publishes images on /{kind}/image" for kind in ("color", "depth")]


def test_the_lens_is_told_to_the_server(capsys):
    robot = Robot(capsys).begin(d=(0.01, -0.3, 0, 0, 0))
    robot.frame(0)
    for camera in ("color_camera", "depth_camera"):
        assert robot.sent.rig[camera]["distortion"] == {"model": "brown_conrady", "coefficients": [0.01, -0.3, 0, 0, 0]}


def test_transforms_that_are_missing_are_said_once_and_counted(robot):
    robot.frames(*range(50), tf=False)
    said = robot.said()
    assert len(said) == 1 and said[0].startswith("nothing moves the camera's frame 'optical' in /tf (known: optical -> base)")
    assert not robot.sent and robot.counts["without a transform"] == 19, "a second of images waits, what is older is left out"
    robot.frames(50, 51)
    assert len(robot.sent) == 2


def test_a_world_that_is_none_is_said(capsys):
    robot = Robot(capsys, world="/earth").begin()
    robot.frames(*range(40))
    assert not robot.sent and "with the world 'earth' (its ancestors: base, odom)" in robot.said()[0]


def test_poses_that_never_come_are_said(capsys):
    robot = Robot(capsys, poses="where").begin()
    robot.frames(*range(40))
    assert not robot.sent and robot.said()[0].startswith("no pose came on /where; publish Odometry")


def test_a_clock_that_goes_back_begins_anew(robot):
    robot.frames(*range(100, 103))
    robot.frames(*range(3))
    assert [round(float(frame[3] - START / 1e9), 1) for frame in robot.sent] == [3.3, 3.3, 3.4, 0.0, 0.0, 0.1]
    assert robot.counts == {"times the clock went back": 1}
    assert [line for line in robot.said() if "went back" in line][0].startswith("the clock of /color/image went back by 3.366 s")


def test_images_out_of_order_are_put_in_order(robot):
    for number in (0, 2, 1, 3):
        robot.frame(number)
    assert len(robot.sent) == 4 and robot.counts == {}


def test_publishers_that_come_and_go_are_told(robot):
    robot.frame(0)
    color = robot.topics.by_name["sensor_msgs/msg/Image", "/color/image"]
    for publishers in (2, 2, 1, 0, 1):
        color.publishers = publishers
        robot.mapping.step()
    assert [line.split(",")[0].split(";")[0] for line in robot.said()[1:]] == [
        "2 publishers send images on /color/image", "/color/image has one publisher again", "the publisher of /color/image is gone",
        "/color/image has one publisher again"]  # fmt: skip
    robot.frame(1)
    assert len(robot.sent) == 2


def test_images_of_another_camera_are_refused(robot):
    robot.frame(0)
    robot.frame(1, color=image(START + 33 * MS, COLOR, "rgb8", "other_optical"))
    robot.frame(2)
    assert len(robot.sent) == 2 and robot.counts["refused"] == 1 and "of the frame 'other_optical', those before were of 'optical'" in robot.said()[1]


def test_images_without_time_are_refused(robot):
    robot.frame(0, color=image(0, COLOR, "rgb8"))
    assert "the images of /color/image have no time stamps" in robot.said()[0] and robot.counts == {"refused": 1}


def test_messages_that_cannot_be_read_are_counted(robot):
    robot.topics.by_name["tf2_msgs/msg/TFMessage", "/tf"].came.append(None)
    robot.topics.give("/tf", transforms(("odom", "base", START, np.eye(4))))
    robot.topics.by_name["tf2_msgs/msg/TFMessage", "/tf"].came[-1].transforms[0].transform.rotation.w = 0.0
    robot.frames(0)
    assert robot.counts == {"unreadable": 1, "refused": 1} and len(robot.sent) == 1


def test_what_the_server_refuses_is_counted_and_the_next_is_sent(capsys):
    class Picky(Sent):
        def send(self, *frame):
            self.taken += 1
            if self.taken == 2:
                raise SendError(400, "its depth has no value from 0.1 to 10 m")
            self.append(frame)
            return True

    robot = Robot(capsys, Picky()).begin()
    robot.frames(0, 1, 2)
    assert len(robot.sent) == 2 and robot.counts == {"refused by the server": 1}
    assert "did not take a frame: its depth has no value" in robot.said()[1]


def test_a_server_that_is_gone_is_asked_again(capsys, monkeypatch):
    class Gone(Sent):
        opened = 0
        away = True

        def __call__(self, rig):
            self.opened += 1
            if self.away:
                raise ConnectionRefusedError("connection refused")
            return super().__call__(rig)

    monkeypatch.setattr("ovimap.ros.mapping.RETRY_S", 0)
    robot = Robot(capsys, Gone()).begin()
    robot.frames(0, 1)
    assert robot.sent.opened >= 2 and [line.split(" (")[0] for line in robot.said()] == ["the server cannot be reached or refuses the camera"]
    robot.sent.away = False
    robot.frame(2)
    assert len(robot.sent) == 3 and robot.mapping.finish() == "3 frames sent, 0 skipped; the map is saved" and robot.sent.finished


def test_what_waited_too_long_for_the_cameras_is_counted(capsys):
    robot = Robot(capsys)
    robot.frames(*range(KEPT_IMAGES + 3))
    assert robot.counts == {"before the server was ready": 3}


def test_nothing_was_sent(capsys):
    assert Robot(capsys).mapping.finish() == "no frame was sent"


@pytest.mark.parametrize(("images", "expected"), [
    ("/camera/color/image_raw", "/camera/color/camera_info"), ("/camera/image_raw/compressed", "/camera/camera_info"),
    ("camera/depth/image_raw/compressedDepth", "/camera/depth/camera_info"), ("/image", "/camera_info"),
])  # fmt: skip
def test_camera_info_is_beside_the_images(images, expected):
    assert info_topic(images) == expected
