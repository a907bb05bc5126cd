# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes written.json: messages as a real ROS 2 serializes them, and the hashes that its own generator gives their types.

    python -m venv .venv-ros2 && .venv-ros2/bin/pip install -r python/tests/ros2/requirements.txt
    .venv-ros2/bin/python python/tests/ros2/write_messages.py python/tests/ros2/written.json
"""
import array
import importlib
import importlib.metadata
import json
import math
import pathlib
import sys
import tempfile

from rclpy.serialization import serialize_message
from rosidl_adapter.msg import convert_msg_to_idl
from rosidl_adapter.srv import convert_srv_to_idl
from rosidl_generator_type_description import generate_type_hash

STAMP = {"sec": 1700000000, "nanosec": 123456789}
HEADER = {"stamp": STAMP, "frame_id": "camera_optical"}
POSE = {"position": {"x": 1.5, "y": -2.25, "z": 0.125}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.6, "w": 0.8}}
COVARIANCE = {"pose": POSE, "covariance": [i / 8 for i in range(36)]}
FLOATS = list(b"\x00\x00\xc0\x7f\x00\x00\x80\x3f\x00\x00\x00\x00\x00\x00\x20\x40")  # NaN, 1, 0, 2.5

# The pictures: rows with two bytes of padding, all kinds of pixels; strings of lengths that leave every alignment.
MESSAGES = [
    ("sensor_msgs/msg/Image", {"header": HEADER, "height": 2, "width": 3, "encoding": "rgb8", "is_bigendian": 0, "step": 11, "data": list(range(22))}),
    ("sensor_msgs/msg/Image", {"header": HEADER, "height": 2, "width": 1, "encoding": "bgr8", "is_bigendian": 0, "step": 3, "data": [1, 2, 3, 4, 5, 6]}),
    ("sensor_msgs/msg/Image", {"header": HEADER, "height": 1, "width": 3, "encoding": "mono8", "is_bigendian": 0, "step": 3, "data": [7, 8, 9]}),
    ("sensor_msgs/msg/Image", {"header": HEADER, "height": 1, "width": 2, "encoding": "16UC1", "is_bigendian": 0, "step": 4, "data": [0xE8, 3, 0, 0]}),
    ("sensor_msgs/msg/Image", {"header": HEADER, "height": 1, "width": 2, "encoding": "16UC1", "is_bigendian": 1, "step": 4, "data": [3, 0xE8, 0, 0]}),
    ("sensor_msgs/msg/Image", {"header": HEADER, "height": 2, "width": 2, "encoding": "32FC1", "is_bigendian": 0, "step": 8, "data": FLOATS}),
    ("sensor_msgs/msg/CompressedImage", {"header": HEADER, "format": "rgb8; jpeg compressed bgr8", "data": [0xFF, 0xD8, 0xFF, 0xE0, 1]}),
    ("sensor_msgs/msg/CameraInfo", {
        "header": HEADER, "height": 480, "width": 640, "distortion_model": "plumb_bob", "d": [0.1, -0.25, 0.001, 0.002, 0.0],
        "k": [525.0, 0.0, 319.5, 0.0, 526.0, 239.5, 0.0, 0.0, 1.0], "r": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        "p": [525.0, 0.0, 319.5, 0.0, 0.0, 526.0, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0], "binning_x": 0, "binning_y": 0,
        "roi": {"x_offset": 1, "y_offset": 2, "height": 3, "width": 4, "do_rectify": True}}),
    ("geometry_msgs/msg/TransformStamped", {
        "header": HEADER, "child_frame_id": "base_link",
        "transform": {"translation": {"x": 0.5, "y": 0.25, "z": -1.0}, "rotation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}}),
    ("geometry_msgs/msg/PoseStamped", {"header": HEADER, "pose": POSE}),
    ("geometry_msgs/msg/PoseWithCovarianceStamped", {"header": HEADER, "pose": COVARIANCE}),
    ("nav_msgs/msg/Odometry", {"header": HEADER, "child_frame_id": "base", "pose": COVARIANCE, "twist": {
        "twist": {"linear": {"x": 1.0, "y": 2.0, "z": 3.0}, "angular": {"x": 4.0, "y": 5.0, "z": 6.0}}, "covariance": [0.0] * 36}}),
    ("rosgraph_msgs/msg/Clock", {"clock": STAMP}),
    ("sensor_msgs/msg/PointCloud2", {
        "header": HEADER, "height": 1, "width": 2, "is_bigendian": False, "point_step": 8, "row_step": 16, "data": list(range(16)),
        "is_dense": True, "fields": [{"name": "x", "offset": 0, "datatype": 7, "count": 1}, {"name": "instance", "offset": 4, "datatype": 6, "count": 1}]}),
    ("nav_msgs/msg/OccupancyGrid", {"header": HEADER, "data": [-1, 0, 100, 0, -1, 100], "info": {
        "map_load_time": STAMP, "resolution": 0.0625, "width": 3, "height": 2, "origin": POSE}}),
    ("visualization_msgs/msg/MarkerArray", {"markers": [
        {"header": HEADER, "ns": "boxes", "id": 12, "type": 1, "action": 0, "pose": POSE, "scale": {"x": 1.0, "y": 2.0, "z": 3.0},
         "color": {"r": 1.0, "g": 0.5, "b": 0.25, "a": 0.75}, "text": ""},
        {"header": HEADER, "ns": "names", "id": 12, "type": 9, "action": 0, "pose": POSE, "scale": {"x": 0.0, "y": 0.0, "z": 0.125},
         "color": {"r": 1.0, "g": 1.0, "b": 1.0, "a": 1.0}, "text": "mug 12"}]}),
    ("geometry_msgs/msg/PoseArray", {"header": HEADER, "poses": [POSE, POSE]}),
    ("nav_msgs/msg/Path", {"header": HEADER, "poses": [{"header": HEADER, "pose": POSE}, {"header": HEADER, "pose": POSE}]}),
    ("std_msgs/msg/String", {"data": "mug 12"}),
    ("std_srvs/srv/SetBool_Request", {"data": True}),
    ("std_srvs/srv/SetBool_Response", {"success": True, "message": "done"}),
]  # fmt: skip

# Types that the core of ROS 2 does not hold, by which its generator makes hashes: vision_msgs 4, tf2_msgs, and our services.
PACKAGES = {
    "tf2_msgs": {"msg/TFMessage.msg": "geometry_msgs/TransformStamped[] transforms"},
    "vision_msgs": {
        "msg/ObjectHypothesis.msg": "string class_id\nfloat64 score",
        "msg/ObjectHypothesisWithPose.msg": "ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose",
        "msg/BoundingBox3D.msg": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size",
        "msg/Detection3D.msg": "std_msgs/Header header\nObjectHypothesisWithPose[] results\nBoundingBox3D bbox\nstring id",
        "msg/Detection3DArray.msg": "std_msgs/Header header\nDetection3D[] detections",
    },
    "ovimap_msgs": {
        "srv/Query.srv": "string text\n---\nbool found\nstring message\nvision_msgs/Detection3DArray matches",
        "srv/Approach.srv": "string text\ngeometry_msgs/Point[<=1] start\n---\nbool found\nstring message\nvision_msgs/Detection3DArray matches\n"
                            "geometry_msgs/PoseArray poses\nnav_msgs/Path way",
    },
}
GRAPH = "rmw_dds_common/msg/ParticipantEntitiesInfo"  # by which nodes tell each other what they have
CORE = ("builtin_interfaces", "geometry_msgs", "nav_msgs", "rmw_dds_common", "rosgraph_msgs", "sensor_msgs", "service_msgs", "std_msgs", "std_srvs", "visualization_msgs")


def made(name, fields):
    package, kind, message = name.split("/")
    module = importlib.import_module(f"{package}.{kind}")
    part = message.partition("_")
    value = (getattr(getattr(module, part[0]), part[2]) if kind == "srv" else getattr(module, message))()
    return fill(value, fields)


def fill(message, fields):
    kinds = message.get_fields_and_field_types()
    for field, value in fields.items():
        if isinstance(value, dict):
            fill(getattr(message, field), value)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            setattr(message, field, [made(kinds[field].removeprefix("sequence<").removesuffix(">").replace("/", "/msg/"), part) for part in value])
        elif isinstance(value, list) and kinds[field] == "sequence<uint8>":
            setattr(message, field, array.array("B", value))
        else:
            setattr(message, field, value)
    return message


def core_hashes(share):
    """Of the messages above and of GRAPH, and of all that they consist of."""
    wanted = {GRAPH, *(name.partition("_Re")[0] for name, _ in MESSAGES)}
    found = {}
    for package in CORE:
        for file in [*(share / package).glob("msg/*.json"), *(share / package).glob("srv/*.json")]:
            if f"{package}/{file.parent.name}/{file.stem}" in wanted:
                found |= hashes_in(file)
    return found


def hashes_in(file):
    return {entry["type_name"]: entry["hash_string"] for entry in json.loads(pathlib.Path(file).read_text())["type_hashes"]}


def other_hashes(share):
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        base = pathlib.Path(folder)
        includes = [f"{name}:{share / name}" for name in CORE]
        for package, files in PACKAGES.items():
            source, out = base / "source" / package, base / "share" / package
            tuples = []
            for file, text in files.items():
                path = source / file
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
                convert = convert_msg_to_idl if path.suffix == ".msg" else convert_srv_to_idl
                convert(source, package, pathlib.Path(file), out / path.parent.name)
                tuples.append(f"{out}:{pathlib.Path(file).with_suffix('.idl')}")
            arguments = base / f"{package}.json"
            arguments.write_text(json.dumps({"package_name": package, "output_dir": str(out), "idl_tuples": tuples, "include_paths": includes}))
            for described in generate_type_hash(str(arguments)):
                found |= hashes_in(described)
            includes.append(f"{package}:{out}")
    return found


def json_value(value):
    """NaN is no JSON; none of the fields above is."""
    assert not isinstance(value, float) or math.isfinite(value)
    return value


def main():
    share = pathlib.Path(sys.prefix, "share")
    hashes = core_hashes(share) | other_hashes(share)
    written = [{"type": name, "fields": fields, "cdr": bytes(serialize_message(made(name, fields))).hex()} for name, fields in MESSAGES]
    versions = {name: importlib.metadata.version(name) for name in ("ros-rclpy", "ros-rmw-fastrtps-cpp", "ros-sensor-msgs")}
    text = json.dumps({"written by": versions, "hashes": dict(sorted(hashes.items())), "messages": written}, indent=0, default=json_value)
    pathlib.Path(sys.argv[1]).write_text(text + "\n")


if __name__ == "__main__":
    main()
