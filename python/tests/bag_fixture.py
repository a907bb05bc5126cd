# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Bags as recorders write them, made from frames."""
import io
import struct
from dataclasses import dataclass

import numpy as np
from ovimap.transforms import quaternion_of
from PIL import Image
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin, Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

START_NS = 1_700_000_000_000_000_000
STEP_NS = 33_333_333


@dataclass
class Shot:
    """One frame to record: the pixels, or the file they are in."""

    color: object  # uint8 [h, w, 3], or the bytes of a JPEG
    depth: np.ndarray  # uint16 millimetres or float32 metres
    pose: np.ndarray  # world_from_camera of the depth camera


@dataclass
class Options:
    kind: str = "mcap"  # mcap, sqlite3 or ros1
    color_camera: object = None
    color_from_depth: np.ndarray | None = None  # where colour has a camera of its own
    compressed_depth: bool = False
    poses: str = "tf"  # tf, odometry, stamped (as /pose) or none
    more_odometry: tuple[str, ...] = ()  # topics that say the camera stands a metre aside
    info: bool = True
    distortion: float = 0.0
    jump_after: int | None = None  # images, then the clock starts anew
    between: bool = False  # poses at other times than the images


class Recorder:
    def __init__(self, path, kind):
        self.ros1 = kind == "ros1"
        self.store = get_typestore(Stores.ROS1_NOETIC if self.ros1 else Stores.ROS2_HUMBLE)
        if self.ros1:
            self.store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage"))
            self.writer = Writer1(path)
        else:
            self.writer = Writer2(path, version=9, storage_plugin=StoragePlugin[kind.upper()])
        self.writer.open()
        self.topics = {}

    def type(self, name):
        return self.store.types[name]

    def header(self, time_ns, frame):
        stamp = self.type("builtin_interfaces/msg/Time")(sec=time_ns // 10**9, nanosec=time_ns % 10**9)
        return self.type("std_msgs/msg/Header")(stamp=stamp, frame_id=frame, **({"seq": 0} if self.ros1 else {}))

    def write(self, topic, name, time_ns, **fields):
        if topic not in self.topics:
            self.topics[topic] = self.writer.add_connection(topic, name, typestore=self.store)
        message = self.type(name)(**fields)
        data = self.store.serialize_ros1(message, name) if self.ros1 else self.store.serialize_cdr(message, name)
        self.writer.write(self.topics[topic], time_ns, data)

    def image(self, topic, time_ns, stamp_ns, frame, pixels, encoding):
        data = np.ascontiguousarray(pixels).view(np.uint8).reshape(-1)
        height, width = pixels.shape[:2]
        self.write(topic, "sensor_msgs/msg/Image", time_ns, header=self.header(stamp_ns, frame), height=height, width=width,
                   encoding=encoding, is_bigendian=0, step=data.size // height, data=data)  # fmt: skip

    def compressed(self, topic, time_ns, stamp_ns, frame, data, image_format):
        self.write(topic, "sensor_msgs/msg/CompressedImage", time_ns, header=self.header(stamp_ns, frame), format=image_format,
                   data=np.frombuffer(data, np.uint8))  # fmt: skip

    def info(self, topic, time_ns, frame, camera, distortion=0.0):
        names = "DKRP" if self.ros1 else "dkrp"
        k = np.array([camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1], np.float64)
        figures = dict(zip(names, (np.full(5, distortion), k, np.eye(3).reshape(-1), np.hstack([k.reshape(3, 3), np.zeros((3, 1))]).reshape(-1))))
        roi = self.type("sensor_msgs/msg/RegionOfInterest")(x_offset=0, y_offset=0, height=0, width=0, do_rectify=False)
        self.write(topic, "sensor_msgs/msg/CameraInfo", time_ns, header=self.header(time_ns, frame), height=camera.height,
                   width=camera.width, distortion_model="plumb_bob", binning_x=0, binning_y=0, roi=roi, **figures)  # fmt: skip

    def parts(self, pose):
        vector, rotation = self.type("geometry_msgs/msg/Vector3"), self.type("geometry_msgs/msg/Quaternion")
        q, p = quaternion_of(pose), pose[:3, 3]
        return vector(*map(float, p)), rotation(*map(float, q))

    def transform(self, topic, time_ns, parent, child, pose):
        translation, rotation = self.parts(pose)
        transform = self.type("geometry_msgs/msg/Transform")(translation=translation, rotation=rotation)
        stamped = self.type("geometry_msgs/msg/TransformStamped")
        self.write(topic, "tf2_msgs/msg/TFMessage", time_ns,
                   transforms=[stamped(header=self.header(time_ns, parent), child_frame_id=child, transform=transform)])  # fmt: skip

    def pose(self, pose):
        translation, rotation = self.parts(pose)
        position = self.type("geometry_msgs/msg/Point")(translation.x, translation.y, translation.z)
        return self.type("geometry_msgs/msg/Pose")(position=position, orientation=rotation)

    def odometry(self, time_ns, parent, child, pose, topic="/odom"):
        zero, none = self.type("geometry_msgs/msg/Vector3")(0.0, 0.0, 0.0), np.zeros(36)
        pose = self.pose(pose)
        twist = self.type("geometry_msgs/msg/Twist")(linear=zero, angular=zero)
        self.write(topic, "nav_msgs/msg/Odometry", time_ns, header=self.header(time_ns, parent), child_frame_id=child,
                   pose=self.type("geometry_msgs/msg/PoseWithCovariance")(pose=pose, covariance=none),
                   twist=self.type("geometry_msgs/msg/TwistWithCovariance")(twist=twist, covariance=none))  # fmt: skip


def png(pixels):
    out = io.BytesIO()
    Image.fromarray(pixels).save(out, "PNG")
    return out.getvalue()


def quantized(metres, most_m=10.0, quantization=100.0):
    """Metres as compressed_depth_image_transport stores them: a header, and 16 bits of inverse depth."""
    a = quantization * (quantization + 1)
    b = 1 - a / most_m
    stored = np.zeros(metres.shape, np.uint16)
    seen = metres > 0
    stored[seen] = np.rint(a / metres[seen] + b)
    return struct.pack("<iff", 0, a, b), stored


def write_depth(recorder, options, time_ns, stamp_ns, shot):
    encoding = "16UC1" if shot.depth.dtype == np.uint16 else "32FC1"
    if options.compressed_depth:
        header, stored = quantized(shot.depth) if encoding == "32FC1" else (bytes(12), shot.depth)
        recorder.compressed("/depth/image/compressedDepth", time_ns, stamp_ns, "depth_optical", header + png(stored),
                            f"{encoding}; compressedDepth png")  # fmt: skip
    else:
        recorder.image("/depth/image", time_ns, stamp_ns, "depth_optical", shot.depth, encoding)


def write_pose(recorder, options, time_ns, pose):
    base = np.eye(4)  # the camera is mounted on a robot, turned
    base[:3, :3], base[:3, 3] = [[0, 0, 1], [-1, 0, 0], [0, -1, 0]], [0.1, 0.2, 0.3]
    if options.poses == "tf":
        recorder.transform("/tf", time_ns, "map", "depth_optical", pose)
    elif options.poses == "odometry":
        recorder.odometry(time_ns, "odom", "base", pose @ np.linalg.inv(base))
        recorder.transform("/tf_static", time_ns, "base", "depth_optical", base)
    elif options.poses == "stamped":
        recorder.write("/pose", "geometry_msgs/msg/PoseStamped", time_ns, header=recorder.header(time_ns, "world"), pose=recorder.pose(pose))
    aside = np.eye(4)
    aside[1, 3] = 1
    for topic in options.more_odometry:
        recorder.odometry(time_ns, "odom", "depth_optical", aside @ pose, topic)


def record(path, shots, camera, options=Options()):
    """Writes a bag and returns its path."""
    recorder = Recorder(path, options.kind)
    own_camera = options.color_from_depth is not None
    color_frame = "color_optical" if own_camera else "depth_optical"
    for i, shot in enumerate(shots):
        time_ns = START_NS + i * STEP_NS
        stamp_ns = time_ns if options.jump_after is None or i < options.jump_after else START_NS + (i - options.jump_after) * STEP_NS
        if options.info:
            recorder.info("/color/camera_info", time_ns, color_frame, options.color_camera or camera, options.distortion)
            recorder.info("/depth/camera_info", time_ns, "depth_optical", camera, options.distortion)
        if own_camera and i == 0:
            recorder.transform("/tf_static", time_ns, "depth_optical", "color_optical", np.linalg.inv(options.color_from_depth))
        for shift in (-STEP_NS // 4, STEP_NS // 4) if options.between else (0,):
            write_pose(recorder, options, time_ns + shift, shot.pose)
        if isinstance(shot.color, bytes):
            recorder.compressed("/color/image/compressed", time_ns, stamp_ns, color_frame, shot.color, "jpeg")
        else:
            recorder.image("/color/image", time_ns, stamp_ns + 1_000_000, color_frame, shot.color, "rgb8")
        write_depth(recorder, options, time_ns, stamp_ns, shot)
    recorder.writer.close()
    return path
