# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A robot of a real ROS 2 (rclpy): publishes the frames of a .npz file, and tells as JSON what comes back under NAME.

    peer.py FRAMES.npz NAME
"""
import json
import sys
import time

import numpy as np
import rclpy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import CameraInfo, Image, PointCloud2
from visualization_msgs.msg import MarkerArray

FOREVER_S = 90


def stamped(message, number):
    message.header.stamp.sec, message.header.stamp.nanosec = 1_000_000 + number // 30, number % 30 * 33_000_000
    message.header.frame_id = "optical"
    return message


def image(number, pixels, encoding):
    height, width = pixels.shape[:2]
    data = np.ascontiguousarray(pixels).tobytes()
    message = Image(height=height, width=width, encoding=encoding, step=len(data) // height)
    message.data.frombytes(data)
    return stamped(message, number)


def pose(number, position, turn):
    message = stamped(PoseStamped(), number)
    message.header.frame_id = "map"
    for target, values, names in ((message.pose.position, position, "xyz"), (message.pose.orientation, turn, "xyzw")):
        for name, value in zip(names, values):
            setattr(target, name, float(value))
    return message


def holds_something(message):
    """The first of a live map may be empty."""
    return getattr(message, "width", 1) > 0 and len(getattr(message, "markers", [1, 2])) > 1


def main():
    frames, name = np.load(sys.argv[1]), sys.argv[2]
    rclpy.init()
    node = rclpy.create_node("robot")
    color, depth, where = (node.create_publisher(kind, f"/{name}/{topic}", 10) for kind, topic in (
        (Image, "color/image"), (Image, "depth/image"), (PoseStamped, "pose")))
    infos = [node.create_publisher(CameraInfo, f"/{name}/{kind}/camera_info", 10) for kind in ("color", "depth")]
    latched, got = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL), {}
    for kind, topic in ((PointCloud2, "objects"), (MarkerArray, "markers"), (OccupancyGrid, "grid")):
        node.create_subscription(kind, f"/{name}/{topic}", lambda message, topic=topic: got.update({topic: message}), latched)
    end, number = time.monotonic() + FOREVER_S, 0
    wanted = sys.argv[3:]
    while time.monotonic() < end and not all(topic in got and holds_something(got[topic]) for topic in wanted):
        rclpy.spin_once(node, timeout_sec=0.1)
        if len(frames.files) and where.get_subscription_count() and color.get_subscription_count() and infos[0].get_subscription_count():
            i = number % len(frames["color"])
            k = [float(value) for value in frames["k"].reshape(9)]
            for out in infos:
                out.publish(stamped(CameraInfo(width=frames["color"].shape[2], height=frames["color"].shape[1], k=k), number))
            where.publish(pose(number, frames["position"][i], frames["turn"][i]))
            color.publish(image(number, frames["color"][i], "rgb8"))
            depth.publish(image(number, frames["depth"][i], "16UC1"))
            number += 1
            time.sleep(0.15)
    told = {topic: {"hash": str(node.get_publishers_info_by_topic(f"/{name}/{topic}")[0].topic_type_hash)} for topic in got}
    for topic, message in got.items():
        if topic == "objects":
            told[topic] |= {"width": message.width, "step": message.point_step, "fields": [field.name for field in message.fields],
                            "bytes": len(message.data), "frame": message.header.frame_id}
        elif topic == "markers":
            told[topic] |= {"texts": [marker.text for marker in message.markers if marker.text]}
        else:
            told[topic] |= {"cells": len(message.data), "size": message.info.width * message.info.height, "values": sorted(set(message.data))}
    nodes = sorted({f"{space}{name}" for name, space in node.get_node_names_and_namespaces()})
    print(json.dumps({"nodes": nodes, "rmw": rclpy.get_rmw_implementation_identifier(), "sent": number, "got": told}), flush=True)
    rclpy.shutdown()


main()
