# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of frames, and a node whose topics are lists."""
import numpy as np
from ovimap.ros import types
from ovimap.ros.messages import header_of
from ovimap.transforms import quaternion_of

MS = 1_000_000
make = types.make


def image(time_ns, pixels, encoding, frame="optical"):
    data = np.ascontiguousarray(pixels).view(np.uint8).reshape(-1)
    height, width = pixels.shape[:2]
    return make("sensor_msgs/msg/Image", header=header_of(frame, time_ns), height=height, width=width, encoding=encoding, is_bigendian=0,
                step=data.size // height, data=data)  # fmt: skip


def compressed(time_ns, data, kind, frame="optical"):
    return make("sensor_msgs/msg/CompressedImage", header=header_of(frame, time_ns), format=kind, data=np.frombuffer(data, np.uint8))


def info(camera, frame="optical", d=(0.0,) * 5):
    k = np.array([camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1], np.float64)
    roi = make("sensor_msgs/msg/RegionOfInterest", x_offset=0, y_offset=0, height=0, width=0, do_rectify=False)
    return make("sensor_msgs/msg/CameraInfo", header=header_of(frame, 1), height=camera.height, width=camera.width, distortion_model="plumb_bob",
                d=np.array(d, np.float64), k=k, r=np.eye(3).reshape(-1), p=np.zeros(12), binning_x=0, binning_y=0, roi=roi)  # fmt: skip


def xyz(kind, values):
    return make(f"geometry_msgs/msg/{kind}", **dict(zip("xyzw", map(float, values))))


def placed(matrix, kind="Point"):
    """Position and orientation."""
    return xyz(kind, matrix[:3, 3]), xyz("Quaternion", quaternion_of(matrix))


def transforms(*links):
    """links: (parent, child, time in ns, 4x4 matrix)."""
    entries = []
    for parent, child, time_ns, matrix in links:
        place, turn = placed(matrix, "Vector3")
        transform = make("geometry_msgs/msg/Transform", translation=place, rotation=turn)
        entries.append(make("geometry_msgs/msg/TransformStamped", header=header_of(parent, time_ns), child_frame_id=child, transform=transform))
    return make("tf2_msgs/msg/TFMessage", transforms=entries)


def pose(time_ns, matrix, frame="map"):
    place, turn = placed(matrix)
    return make("geometry_msgs/msg/PoseStamped", header=header_of(frame, time_ns), pose=make("geometry_msgs/msg/Pose", position=place, orientation=turn))


def odometry(time_ns, matrix, child):
    stamped = pose(time_ns, matrix, "odom")
    still = make("geometry_msgs/msg/Twist", linear=xyz("Vector3", (0, 0, 0)), angular=xyz("Vector3", (0, 0, 0)))
    twist = make("geometry_msgs/msg/TwistWithCovariance", twist=still, covariance=np.zeros(36))
    return make("nav_msgs/msg/Odometry", header=stamped.header, child_frame_id=child, twist=twist,
                pose=make("geometry_msgs/msg/PoseWithCovariance", pose=stamped.pose, covariance=np.zeros(36)))  # fmt: skip


def moved(x):
    matrix = np.eye(4)
    matrix[0, 3] = x
    return matrix


class Topic:
    """In the place of a Subscription: `came` is what came since."""

    def __init__(self, name, topic):
        self.name, self.topic, self.came, self.publishers, self.mismatched = name, topic, [], 0, 0

    def take(self):
        came, self.came = self.came, []
        return iter(came)


class Topics:
    """In the place of a Node."""

    def __init__(self):
        self.by_name = {}

    def subscription(self, name, topic, quality):
        return self.by_name.setdefault((name, topic), Topic(name, topic))

    def give(self, topic, message):
        self.by_name[message.__msgtype__, topic].came.append(message)
        self.by_name[message.__msgtype__, topic].publishers = 1


class Sent(list):
    """In the place of a FrameSender."""

    taken = skipped = 0
    finished = False

    def __call__(self, rig):
        self.rig = rig
        return self

    def send(self, *frame):
        self.append(frame)
        self.taken += 1
        return True

    def finish(self):
        self.finished = True
