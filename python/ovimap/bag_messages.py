# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of ROS as plain values, whether a bag holds them (ROS 1, ROS 2, MCAP) or they come from a robot (ovimap.ros)."""

from __future__ import annotations

import pathlib
import struct
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from ._ovimap import Error, decode_gray_png
from .distortion import distortion_of
from .transforms import Matrix, TransformTree, matrix_of

IMAGES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
CAMERA = "sensor_msgs/msg/CameraInfo"
TRANSFORMS = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
ODOMETRY = "nav_msgs/msg/Odometry"
POSES = ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped")
STORAGE = (".bag", ".mcap", ".db3")
CUT_OFF = "it is cut off or was never closed; try `rosbag reindex`, `ros2 bag reindex` or `mcap recover`"


class Bag:
    """A bag, open for reading. Raises Error for what is none, is cut off, or needs a package that is missing."""

    def __init__(self, path: pathlib.Path) -> None:
        try:
            from rosbags.highlevel import AnyReader
            from rosbags.typesys import Stores, get_typestore
        except ImportError:
            raise Error("reading bags needs the package rosbags; run: pip install 'ovimap[bags]'") from None
        self.path = path
        if not path.exists():
            raise Error(f"there is no bag '{path}'; name a .bag file, a ROS 2 bag's folder or an .mcap file")
        if not _may_be_bag(path):
            raise Error(f"'{path}' is no bag; name a .bag file, a ROS 2 bag's folder or an .mcap file")
        store = get_typestore(Stores.ROS1_NOETIC if path.suffix == ".bag" else Stores.LATEST)
        try:
            self.reader: Any = AnyReader([path], default_typestore=store)
            self.reader.open()
        except Exception as fault:  # every storage fails in its own way
            raise Error(f"bag '{path}' cannot be opened ({_text(fault)}); {CUT_OFF}") from None
        self.types: dict[str, str] = {c.topic: c.msgtype for c in self.reader.connections}

    def __enter__(self) -> Bag:
        return self

    def __exit__(self, *_: object) -> None:
        self.reader.close()

    def topics(self, *types: str) -> list[str]:
        return sorted(topic for topic, kind in self.types.items() if kind in types)

    def messages(self, topics: set[str]) -> Iterator[tuple[str, int, Any]]:
        """(topic, when the bag got it in ns, message) in the order of recording."""
        chosen = [c for c in self.reader.connections if c.topic in topics]
        if not chosen:
            return
        try:
            for connection, time_ns, data in self.reader.messages(connections=chosen):
                yield connection.topic, time_ns, self.reader.deserialize(data, connection.msgtype)
        except Error:
            raise
        except Exception as fault:
            raise Error(f"bag '{self.path}' cannot be read to its end ({_text(fault)}); {CUT_OFF}") from None


def _may_be_bag(path: pathlib.Path) -> bool:
    if not path.is_dir():
        return path.suffix in STORAGE
    return any(file.name == "metadata.yaml" or file.suffix in STORAGE for file in path.iterdir())


def _text(fault: Exception) -> str:
    return f"{type(fault).__name__}: {fault}".splitlines()[0]


def stamp_ns(header: Any) -> int:
    return int(header.stamp.sec) * 1_000_000_000 + int(header.stamp.nanosec)


def field_of(info: Any, name: str) -> Any:
    return getattr(info, name) if hasattr(info, name) else getattr(info, name.upper())  # ROS 1 has capitals


def camera_of(info: Any, topic: str, images: str) -> dict[str, Any]:
    """width, height, fx, fy, cx and cy of a CameraInfo message of `topic`, pixels, and the lens of the topic of its images.

    Raises Error for one without calibration, or with a lens that is not read."""
    k = field_of(info, "k")
    if not (min(info.width, info.height, k[0], k[4]) > 0 and np.isfinite(k).all()):
        raise Error(
            f"{topic} holds no calibration ({info.width}x{info.height}, fx {k[0]:g}, fy {k[4]:g}); calibrate the "
            "camera, give its driver the result, and record the bag anew or start the driver again"
        )
    figures = {"fx": k[0], "fy": k[4], "cx": k[2], "cy": k[5]}
    size = {"width": int(info.width), "height": int(info.height)}
    return {**size, **{name: float(value) for name, value in figures.items()}, **lens_of(images, info)}


ROS_LENSES = {"plumb_bob": ("brown_conrady", 5), "rational_polynomial": ("brown_conrady", 8), "equidistant": ("kannala_brandt", 4),
              "fisheye": ("kannala_brandt", 4)}  # fmt: skip


def lens_of(topic: str, info: Any) -> dict[str, Any]:
    """The key `distortion` of a camera file for the images of a topic; empty where they have none. Raises Error for a lens that is not read.

    Images that were rectified come with the camera_info of those that were not, so the topic's name decides."""
    numbers = np.asarray(field_of(info, "d"), np.float64).ravel().tolist()
    if "rect" in topic or (not any(numbers) and info.distortion_model not in ("equidistant", "fisheye")):
        return {}
    model, count = ROS_LENSES.get(info.distortion_model, ("", 0))
    if not model or any(numbers[count:]):
        raise Error(
            f"the lens of {topic} has the model '{info.distortion_model}' with {len(numbers)} coefficients, which is not read; accepted are "
            f"{', '.join(ROS_LENSES)}, or record rectified images"
        )
    return distortion_of(model, (numbers + count * [0.0])[:count])


def vector(value: Any) -> tuple[float, float, float]:
    return (value.x, value.y, value.z)


def quaternion(value: Any) -> tuple[float, float, float, float]:
    return (value.x, value.y, value.z, value.w)


def pose_of(message: Any) -> Matrix:
    """[4, 4] of a PoseStamped, PoseWithCovarianceStamped or Odometry message."""
    pose = message.pose.pose if hasattr(message.pose, "pose") else message.pose
    return matrix_of(vector(pose.position), quaternion(pose.orientation))


def add_transforms(tree: TransformTree, message: Any, *, static: bool) -> None:
    """Those of a message of /tf or /tf_static. Raises Error for what is no rotation."""
    for entry in message.transforms:
        pose = matrix_of(vector(entry.transform.translation), quaternion(entry.transform.rotation))
        tree.add(entry.header.frame_id, entry.child_frame_id, stamp_ns(entry.header), pose, static=static)


def is_depth(message: Any) -> bool:
    """By the encoding, which raw and compressed images both name."""
    if hasattr(message, "encoding"):
        return message.encoding in ("16UC1", "mono16", "32FC1")
    return "compressedDepth" in message.format or message.format.startswith(("16UC1", "32FC1"))


MOST_DEPTH_PIXELS = 1 << 24  # ten times what depth cameras have; unpacked, a few bytes of a PNG can be gigabytes
JPEG, PNG = b"\xff\xd8", b"\x89PNG"
CHANNELS = {"rgb8": 3, "bgr8": 3, "rgba8": 4, "bgra8": 4, "mono8": 1, "8UC1": 1, "8UC3": 3}


def color_of(message: Any, topic: str) -> npt.NDArray[np.uint8] | bytes:
    """An Image as uint8 [height, width, 3], red first; a CompressedImage as the bytes of its JPEG or PNG."""
    if hasattr(message, "encoding"):
        return raw_color(message, topic)
    data = bytes(message.data)
    if not data.startswith((JPEG, PNG)):
        raise Error(f"an image of {topic} is compressed as '{message.format}'; accepted are JPEG and PNG")
    return data


def depth_of(message: Any, topic: str) -> npt.NDArray[Any] | bytes:
    """uint16 millimetres or float32 metres [height, width], or the bytes of a PNG that holds millimetres."""
    if hasattr(message, "encoding"):
        return raw_depth(message, topic)
    data, image_format = bytes(message.data), message.format
    if "compressedDepth" not in image_format:
        return bytes(color_of(message, topic))
    png = data[12:]  # before it what compression, and two numbers for depth in metres
    if not png.startswith(PNG):
        raise Error(f"an image of {topic} is compressed as '{image_format}', which holds no PNG; record or send it as 16UC1")
    if not image_format.startswith("32FC1"):
        return png
    width, height = struct.unpack(">II", png[16:24].ljust(8, b"\0"))
    if width * height > MOST_DEPTH_PIXELS:
        raise Error(f"an image of {topic} has {width}x{height} pixels of depth; at most {MOST_DEPTH_PIXELS} are read")
    stored, (a, b) = decode_gray_png(png).astype(np.float32), np.frombuffer(data[4:12], "<f4")
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(stored > 0, a / (stored - b), np.float32(0)).astype(np.float32)


def raw_color(message: Any, topic: str) -> npt.NDArray[np.uint8]:
    """uint8 [height, width, 3], red first."""
    if message.encoding not in CHANNELS:
        raise Error(
            f"{topic} has the encoding '{message.encoding}', which is not read; accepted are "
            f"{', '.join(CHANNELS)}, JPEG and PNG"
        )
    channels = CHANNELS[message.encoding]
    image = _rows(message, topic, message.width * channels).reshape(message.height, message.width, channels)
    image = image[:, :, [0, 0, 0]] if channels == 1 else image[:, :, :3]
    reverse = message.encoding.startswith("bgr") or message.encoding == "8UC3"
    return np.ascontiguousarray(image[:, :, ::-1] if reverse else image)


def raw_depth(message: Any, topic: str) -> npt.NDArray[Any]:
    """uint16 millimetres or float32 metres [height, width]."""
    if not is_depth(message):
        raise Error(f"{topic} has the encoding '{message.encoding}', which is no depth; accepted are 16UC1, mono16 and 32FC1")
    size = 4 if message.encoding == "32FC1" else 2
    kind = np.dtype(np.float32 if size == 4 else np.uint16).newbyteorder(">" if message.is_bigendian else "<")
    rows = np.ascontiguousarray(_rows(message, topic, message.width * size))
    return rows.view(kind).reshape(message.height, message.width).astype(kind.newbyteorder("="))


def _rows(message: Any, topic: str, used: int) -> npt.NDArray[np.uint8]:
    """The bytes of the pixels, [height, used]: rows may be padded."""
    data = np.asarray(message.data, np.uint8)
    if min(used, message.height) < 1 or message.step < used or data.size < message.height * message.step:
        raise Error(
            f"an image of {topic} has {data.size} bytes, too few for {message.width}x{message.height} "
            f"{message.encoding}; record or send it anew"
        )
    return data[: message.height * message.step].reshape(message.height, message.step)[:, :used]
