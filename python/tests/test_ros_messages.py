# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Messages that a real ROS 2 wrote (ros2/written.json, by ros2/write_messages.py) are read, written and named as ROS 2 does."""
import json
import pathlib
import re

import numpy as np
import ovimap
import pytest

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed; tools/setup.sh --tests installs it")
pytest.importorskip("rosbags")
from ovimap import bag_messages
from ovimap.ros import types
from ovimap.ros.node import qualified, split_header, topic_of, with_header
from ovimap.transforms import TransformTree

WRITTEN = json.loads((pathlib.Path(__file__).parent / "ros2/written.json").read_text())
MESSAGES = WRITTEN["messages"]
# A message of /tf of ROS 2's turtlesim, from the tests of foxglove/rosmsg2-serialization (ros2/NOTICE.md).
TURTLE = bytes.fromhex(
    "0001000001000000286fae6169ddd73108000000747572746c6531000e000000747572746c65315f616865616400000000000000000000000000f03f"
    "00000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000f03f")  # fmt: skip
for _name, _text in (("Request", "bool data"), ("Response", "bool success\nstring message")):  # a service, of which rosbags has none
    types.register(f"std_srvs/srv/SetBool_{_name}", _text)


def read(kind, encoding=None):
    """The messages of that type as we read them."""
    return [types.decode(kind, bytes.fromhex(entry["cdr"])) for entry in MESSAGES
            if entry["type"] == kind and encoding in (None, entry["fields"].get("encoding"))]  # fmt: skip


def holds(message, fields):
    for name, value in fields.items():
        ours = getattr(message, name)
        if isinstance(value, dict):
            holds(ours, value)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            assert len(ours) == len(value)
            for part, expected in zip(ours, value):
                holds(part, expected)
        else:
            assert np.array_equal(ours, value), name


@pytest.mark.parametrize("entry", MESSAGES, ids=[f"{i} {entry['type']}" for i, entry in enumerate(MESSAGES)])
def test_what_ros_wrote_is_read_and_written_to_the_byte(entry):
    data = bytes.fromhex(entry["cdr"])
    assert data[:4] == b"\0\1\0\0", "CDR, little-endian"
    message = types.decode(entry["type"], data)
    holds(message, entry["fields"])
    ours = types.encode(entry["type"], message)
    assert len(ours) <= len(data) < len(ours) + 4
    for at in np.flatnonzero(np.frombuffer(ours, np.uint8) != np.frombuffer(data[: len(ours)], np.uint8)):
        changed = data[:at] + bytes([data[at] ^ 255]) + data[at + 1:]
        assert types.encode(entry["type"], types.decode(entry["type"], changed)) == ours, "ROS leaves chance in what is skipped, nowhere else"


def is_whole_service(name):
    """DDS knows requests and replies alone."""
    return "/srv/" in name and "_Re" not in name or name.startswith("service_msgs/")


@pytest.mark.parametrize("name", sorted(name for name in WRITTEN["hashes"] if not is_whole_service(name)))
def test_hashes_are_those_of_rosidls_generator(name):
    assert types.type_hash(name) == WRITTEN["hashes"][name]


def test_no_type_is_without_a_hash_of_ros_own():
    """Neither those that ovimap-ros names, nor those that these consist of."""
    folder = pathlib.Path(types.__file__).parent
    sources = [*folder.glob("*.py"), folder.parent / "bag_messages.py"]
    named = {name for source in sources for name in re.findall(r"\b[a-z0-9_]+/(?:msg|srv)/[A-Z]\w+", source.read_text())}
    services = {f"{name}_{side}" for name in named if "/srv/" in name for side in ("Request", "Response")}
    used = {name for name in named if "/msg/" in name} | services
    assert {"nav_msgs/msg/Path", f"{types.APPROACH}_Response", f"{types.QUERY}_Request", "tf2_msgs/msg/TFMessage"} <= used
    while more := {part for name in used for part in parts_of(name)} - used:
        used |= more
    assert used - set(WRITTEN["hashes"]) == set()


def parts_of(name):
    """The types of a message's fields."""
    for _, (kind, what) in types.store().fielddefs[name][1]:
        kind, what = what[0] if kind.name in ("ARRAY", "SEQUENCE") else (kind, what)
        if kind.name == "NAME":
            yield what


def test_names_are_those_of_dds():
    assert types.dds_name("sensor_msgs/msg/Image") == "sensor_msgs::msg::dds_::Image_"
    assert types.message_type("tf2_msgs/msg/TFMessage").__idl__.idl_transformed_typename == "tf2_msgs::msg::dds_::TFMessage_"
    assert types.service_type(f"{types.QUERY}_Request").__idl__.idl_transformed_typename == "ovimap_msgs::srv::dds_::Query_Request_"
    assert (qualified("camera/info"), topic_of("/camera/info")) == ("/camera/info", "rt/camera/info")


def test_a_message_of_tf_is_read():
    tree = TransformTree()
    bag_messages.add_transforms(tree, types.decode("tf2_msgs/msg/TFMessage", TURTLE), static=False)
    time_ns = 1638821672 * 10**9 + 836230505
    assert tree.links["turtle1_ahead"].times_ns == [time_ns]
    assert np.array_equal(tree.target_from("turtle1", "turtle1_ahead", time_ns)[:3], [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0]])


def test_pictures_are_what_their_encoding_says():
    padded, swapped, grey = (bag_messages.color_of(*read("sensor_msgs/msg/Image", encoding), "/c") for encoding in ("rgb8", "bgr8", "mono8"))
    assert padded.tolist() == [[[0, 1, 2], [3, 4, 5], [6, 7, 8]], [[11, 12, 13], [14, 15, 16], [17, 18, 19]]]
    assert swapped.tolist() == [[[3, 2, 1]], [[6, 5, 4]]]
    assert grey.tolist() == [[[7] * 3, [8] * 3, [9] * 3]]
    little, big = (bag_messages.depth_of(message, "/d") for message in read("sensor_msgs/msg/Image", "16UC1"))
    assert little.tolist() == big.tolist() == [[1000, 0]] and little.dtype == np.uint16
    [metres] = read("sensor_msgs/msg/Image", "32FC1")
    assert np.array_equal(bag_messages.depth_of(metres, "/d"), [[np.nan, 1], [0, 2.5]], equal_nan=True)
    [jpeg] = read("sensor_msgs/msg/CompressedImage")
    assert bag_messages.color_of(jpeg, "/c") == b"\xff\xd8\xff\xe0\1"


def test_another_encoding_is_refused_by_name():
    [colour] = read("sensor_msgs/msg/Image", "rgb8")
    with pytest.raises(ovimap.Error, match="/d has the encoding 'rgb8', which is no depth; accepted are 16UC1"):
        bag_messages.depth_of(colour, "/d")
    with pytest.raises(ovimap.Error, match="/c has the encoding '16UC1', which is not read; accepted are rgb8"):
        bag_messages.color_of(read("sensor_msgs/msg/Image", "16UC1")[0], "/c")


@pytest.mark.parametrize("change", [{"height": 0}, {"width": 0}, {"height": 3}, {"step": 8}, {"width": 2**31}])
def test_a_picture_that_is_smaller_than_it_says_is_refused(change):
    [message] = read("sensor_msgs/msg/Image", "rgb8")
    for name, value in change.items():
        setattr(message, name, value)
    with pytest.raises(ovimap.Error, match="an image of /c has 22 bytes, too few for"):
        bag_messages.color_of(message, "/c")


@pytest.mark.parametrize("data", [b"", b"12345", bytes(11), bytes(12) + b"\xff\xd8"])
def test_compressed_depth_that_holds_no_png_is_refused(data):
    header = read("sensor_msgs/msg/Image")[0].header
    message = types.make("sensor_msgs/msg/CompressedImage", header=header, format="32FC1; compressedDepth png", data=np.frombuffer(data, np.uint8))
    with pytest.raises(ovimap.Error, match="which holds no PNG"):
        bag_messages.depth_of(message, "/d")


@pytest.mark.parametrize(("kind", "given", "metres"), [
    ("16UC1", [[1000, 0, 3]], None),
    ("32FC1", [[1000, 0, 4000]], [[100 / (1000 - 50), 0, 100 / (4000 - 50)]]),
])  # fmt: skip
def test_compressed_depth_is_a_header_and_a_png(kind, given, metres):
    png = ovimap.encode_png(np.array(given, np.uint16))
    data = np.frombuffer(b"\0\0\0\0" + np.array([100, 50], "<f4").tobytes() + png, np.uint8)
    header = read("sensor_msgs/msg/Image")[0].header
    read_back = bag_messages.depth_of(types.make("sensor_msgs/msg/CompressedImage", header=header, format=f"{kind}; compressedDepth png", data=data), "/d")
    if metres is None:
        assert read_back == png
    else:
        assert read_back.dtype == np.float32 and np.allclose(read_back, metres)


def test_a_few_bytes_do_not_unpack_to_gigabytes():
    png = bytearray(ovimap.encode_png(np.zeros((1, 1), np.uint16)))
    png[16:24] = np.array([16000, 8000], ">u4").tobytes()
    header = read("sensor_msgs/msg/Image")[0].header
    data = np.frombuffer(bytes(12) + bytes(png), np.uint8)
    message = types.make("sensor_msgs/msg/CompressedImage", header=header, format="32FC1; compressedDepth png", data=data)
    with pytest.raises(ovimap.Error, match="an image of /d has 16000x8000 pixels of depth"):
        bag_messages.depth_of(message, "/d")


def test_cameras_and_poses_are_read():
    [info] = read("sensor_msgs/msg/CameraInfo")
    info.k = info.k.copy()
    pinhole = {"width": 640, "height": 480, "fx": 525.0, "fy": 526.0, "cx": 319.5, "cy": 239.5}
    assert bag_messages.camera_of(info, "/i", "/c/image_rect") == pinhole
    lens = bag_messages.camera_of(info, "/i", "/c/image")["distortion"]
    assert lens["model"] == "brown_conrady" and -0.25 in lens["coefficients"]
    info.k[0] = 0
    with pytest.raises(ovimap.Error, match="/i holds no calibration"):
        bag_messages.camera_of(info, "/i", "/c")
    for kind in ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped", "nav_msgs/msg/Odometry"):
        pose = bag_messages.pose_of(read(kind)[0])
        assert np.allclose(pose, [[0.28, -0.96, 0, 1.5], [0.96, 0.28, 0, -2.25], [0, 0, 1, 0.125], [0, 0, 0, 1]])


def test_the_header_of_a_service_stands_before_the_body():
    request = types.encode("std_srvs/srv/SetBool_Request", read("std_srvs/srv/SetBool_Request")[0])
    header = bytes(range(16))
    wrapped = with_header(header, request)
    assert wrapped == request[:4] + header + request[4:] and split_header(wrapped) == (header, request)
