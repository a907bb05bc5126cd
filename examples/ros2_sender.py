# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""How do I map from a ROS 2 robot? Start `ovimap serve --live http -o room.ovimap`, then this node:

    ros2_sender.py --color /camera/color/image_raw --depth /camera/depth/image_rect_raw --info /camera/depth/camera_info \
        --poses /odom --url http://localhost:8080/

Depth must be registered to colour, or --color-info given: /tf_static then says how the cameras stand. Poses are Odometry or
PoseStamped of the camera's optical frame (x right, y down, z forward). Ctrl-C finishes the map and saves it. A message that
cannot be read and a frame that the mapper refuses are left out, told and counted. rclpy is imported only where the node runs:
the rest works on messages of any origin."""
import argparse
import bisect
import sys

import numpy as np
from ovimap import Error
from ovimap.bag_messages import distortion_notice, quaternion, raw_color, raw_depth, stamp_ns, vector
from ovimap.sender import FrameSender, SendError
from ovimap.transforms import Link, TransformTree, matrix_of, rotation_vector_of

POSES_AN_IMAGE = 20  # at most: odometry is faster than cameras
MAX_GAP_NS = 20_000_000  # colour and depth farther apart do not belong together


def camera_of(info):
    """The figures of a CameraInfo message, for FrameSender; depth in millimetres, as ROS has it."""
    k = info.k if hasattr(info, "k") else info.K
    return {"width": info.width, "height": info.height, "fx": k[0], "fy": k[4], "cx": k[2], "cy": k[5]}


def rig_of(depth_info, color_info=None, color_from_depth=None):
    """Both cameras; without color_info depth is registered to colour. color_from_depth: [4, 4], goes with color_info."""
    depth = {**camera_of(depth_info), "depth_scale": 1000}
    if color_info is None:
        return depth
    offset = {"rotation_vector": rotation_vector_of(color_from_depth).tolist(), "translation": color_from_depth[:3, 3].tolist()}
    return {"depth_camera": depth, "color_camera": camera_of(color_info), "color_from_depth": offset}


def color_of(message):
    """An Image as an array, a CompressedImage (JPEG or PNG) as its bytes."""
    return raw_color(message, "colour") if hasattr(message, "encoding") else bytes(message.data)


def depth_of(message):
    """Millimetres as uint16, or metres as float32."""
    return raw_depth(message, "depth")


def pose_of(message):
    """[4, 4] of a PoseStamped, Odometry or PoseWithCovarianceStamped message."""
    pose = message.pose.pose if hasattr(message.pose, "pose") else message.pose
    return matrix_of(vector(pose.position), quaternion(pose.orientation))


READ = {"color": color_of, "depth": depth_of, "pose": pose_of}


class Matcher:
    """Puts together what belongs together: depth with the nearest colour, and the pose at depth's time."""

    def __init__(self, keep=60):
        self.keep = keep
        self.colors, self.depths = [], []  # (ns, image), by time
        self.poses = Link("world", static=False)

    def add(self, kind, message):
        """Returns the frames that can be sent by now: (colour, depth, pose, seconds)."""
        self.put(kind, message)
        return self.take()

    def put(self, kind, message):
        """Raises ovimap.Error for a message that cannot be read."""
        time_ns, value = stamp_ns(message.header), READ[kind](message)
        if kind == "pose":
            self.poses.add(time_ns, value)
            del self.poses.times_ns[: -self.keep * POSES_AN_IMAGE], self.poses.matrices[: -self.keep * POSES_AN_IMAGE]
        else:
            images = self.colors if kind == "color" else self.depths
            bisect.insort(images, (time_ns, value), key=time_of)
            del images[: -self.keep]

    def take(self):
        if not self.colors or not self.poses.times_ns:
            return []
        # Nothing can come any more between what is older and what is newer.
        due = bisect.bisect_right(self.depths, min(self.colors[-1][0], self.poses.times_ns[-1]), key=time_of)
        depths, self.depths = self.depths[:due], self.depths[due:]
        return [frame for frame in (self._frame(*entry) for entry in depths) if frame]

    def _frame(self, time_ns, depth):
        color_ns, color = min(self.colors, key=lambda entry: abs(entry[0] - time_ns))
        pose = self.poses.at(time_ns)
        if abs(color_ns - time_ns) > MAX_GAP_NS or pose is None:
            return None
        return color, depth, pose, time_ns / 1e9


def time_of(entry):
    return entry[0]


class Bridge:
    """Sends what the messages give, from when the cameras are known; images and poses wait until then.

    open_sender: makes a FrameSender of the cameras. separate: colour has a camera of its own. topics: of the images, "depth" and
    "color". warn: takes a line that a person should know, once."""

    def __init__(self, open_sender, separate=False, topics=None, warn=print):
        self.open_sender, self.separate, self.topics, self.warn = open_sender, separate, topics or {}, warn
        self.infos, self.tree, self.matcher, self.sender = {}, TransformTree(), Matcher(), None
        self.refused = 0  # messages and frames

    def add(self, kind, message):
        """Returns what is to be told, or None."""
        try:
            self.matcher.put(kind, message)
        except Error as fault:
            return self._refuse(fault)
        if self.sender is None:
            rig = self._rig()
            if rig is None:
                return "waiting for camera_info" + (" of both cameras, and for /tf_static to connect their frames" if self.separate else "")
            self.sender = self.open_sender(rig)
            self._warn_of_distortion()
        told = [self._send(frame) for frame in self.matcher.take()]
        return next(filter(None, told), None)

    def finish(self):
        """Saves the map, if one was begun. Returns what is to be told, or None."""
        if self.sender is None:
            return None
        self.sender.finish()
        return f"{self.sender.taken} frames sent, {self.sender.skipped} skipped, {self.refused} refused; the map is saved"

    def _send(self, frame):
        try:
            return None if self.sender.send(*frame) else "the mapper is busy: a frame was skipped"
        except (SendError, ValueError) as fault:  # the next may be good
            return self._refuse(fault)

    def _refuse(self, fault):
        self.refused += 1
        return f"refused ({self.refused} so far): {fault}"

    def add_transforms(self, message):
        """Of /tf_static."""
        for entry in message.transforms:
            pose = matrix_of(vector(entry.transform.translation), quaternion(entry.transform.rotation))
            self.tree.add(entry.header.frame_id, entry.child_frame_id, stamp_ns(entry.header), pose, static=True)

    def _warn_of_distortion(self):
        for kind, info in self.infos.items():
            notice = distortion_notice(self.topics.get(kind, kind), info)
            if notice:
                self.warn(notice)

    def _rig(self):
        depth, color = self.infos.get("depth"), self.infos.get("color")
        if depth is None or not self.separate:
            return rig_of(depth) if depth else None
        offset = self._color_from_depth(color, depth) if color else None
        return None if offset is None else rig_of(depth, color, offset)

    def _color_from_depth(self, color, depth):
        if color.header.frame_id == depth.header.frame_id:
            return np.eye(4)
        try:
            return self.tree.target_from(color.header.frame_id, depth.header.frame_id, stamp_ns(depth.header))
        except Error:  # not connected yet
            return None


def run(spin, bridge):
    """Calls spin until it ends; however it does, the map is saved."""
    try:
        spin()
    except KeyboardInterrupt:
        pass
    finally:
        print(bridge.finish() or "no camera_info came, so no map was begun")


def main():
    import rclpy
    from geometry_msgs.msg import PoseStamped
    from nav_msgs.msg import Odometry
    from rclpy.node import Node
    from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
    from rclpy.utilities import remove_ros_args
    from sensor_msgs.msg import CameraInfo, CompressedImage, Image
    from tf2_msgs.msg import TFMessage

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("--color", "--depth", "--info", "--poses"):
        parser.add_argument(name, required=True)
    parser.add_argument("--color-info")
    parser.add_argument("--url", default="http://localhost:8080/")
    options = parser.parse_args(remove_ros_args(sys.argv)[1:])
    rclpy.init()
    node = Node("ovimap_sender")
    bridge = Bridge(lambda rig: FrameSender(options.url, rig), separate=bool(options.color_info),
                    topics={"depth": options.depth, "color": options.color}, warn=node.get_logger().warning)  # fmt: skip

    def take(kind, message):
        told = bridge.add(kind, message)
        if told:
            node.get_logger().info(told, throttle_duration_sec=5)

    def listen(kind, topic, message_type):
        node.create_subscription(message_type, topic, lambda message: take(kind, message), qos_profile_sensor_data)

    listen("color", options.color, CompressedImage if options.color.endswith("/compressed") else Image)
    listen("depth", options.depth, Image)
    listen("pose", options.poses, Odometry if "odom" in options.poses else PoseStamped)
    for kind, topic in (("depth", options.info), ("color", options.color_info)):
        if topic:
            node.create_subscription(CameraInfo, topic, lambda message, kind=kind: bridge.infos.update({kind: message}), qos_profile_sensor_data)
    kept = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)  # it is published once, maybe before we came
    node.create_subscription(TFMessage, "/tf_static", bridge.add_transforms, kept)
    run(lambda: rclpy.spin(node), bridge)


if __name__ == "__main__":
    main()
