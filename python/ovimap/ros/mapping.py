# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A robot's images become frames of the map that a server makes."""

from __future__ import annotations

import http.client
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .._ovimap import Error
from ..bag_messages import CAMERA, IMAGES, ODOMETRY, POSES, camera_of, color_of, depth_of, stamp_ns
from ..sender import FrameSender, SendError
from ..transforms import Matrix, rotation_vector_of
from .node import SENSOR_DATA, STATIC_TRANSFORMS, TRANSFORMS, Node, Quality, Subscription, qualified
from .pairing import CLOCK_BACK_NS, KEPT_IMAGES, Pair, Pairing, Poses
from .reporter import Reporter

TRANSFORM = "tf2_msgs/msg/TFMessage"
MILLIMETRES = 1000  # what 16-bit depth counts by ROS' convention (REP 118)
FLOAT_UNITS = 5000  # to which depth in metres is rounded: 0.2 mm, up to 13 m
KEPT_RELIABLE = 30  # images that wait for us where none is to be lost: a second of them
PATIENCE_S = 5.0  # until it is said what is missing
RETRY_S = 1.0  # between tries to reach a server that is gone


@dataclass
class Options:
    """What to take. color, depth: topics. poses: a topic, "tf" or "none", which leaves poses to the server."""

    color: str
    depth: str
    color_info: str | None = None
    depth_info: str | None = None
    poses: str = "tf"
    world: str | None = None
    reliable: bool = False


def info_topic(image_topic: str) -> str:
    """camera_info beside the images, as image_transport has it: of /camera/image_raw/compressed it is /camera/camera_info."""
    parts = qualified(image_topic).split("/")
    if parts[-1] in ("compressed", "compressedDepth"):
        parts.pop()
    return "/".join([*parts[:-1], "camera_info"])


@dataclass
class Stream:
    """The images of one topic, and the calibration of their camera."""

    topic: str
    info_topic: str
    depth: bool
    images: list[Subscription]
    infos: Subscription
    info: Any = None
    frame: str = ""
    newest_ns: int = 0
    publishers: int = 0
    told: bool = False  # that there are too many or none any more
    since: float = field(default_factory=time.monotonic)


class Mapping:
    """Sends pairs of images with their pose to the server of `open_sender`, which takes the cameras (docs/http-api.md, "Frames")."""

    def __init__(self, node: Node, options: Options, open_sender: Callable[[dict[str, Any]], FrameSender], reporter: Reporter) -> None:
        self.node, self._options, self._open, self._report = node, options, open_sender, reporter
        quality = Quality(depth=KEPT_RELIABLE) if options.reliable else SENSOR_DATA
        self._color = self._stream(options.color, options.color_info, False, quality)
        self._depth = self._stream(options.depth, options.depth_info, True, quality)
        self._transforms = [(node.subscription(TRANSFORM, "/tf", TRANSFORMS), False),
                            (node.subscription(TRANSFORM, "/tf_static", STATIC_TRANSFORMS), True)]
        topic = qualified(options.poses) if options.poses not in ("tf", "none") else ""
        self.poses = Poses(options.world, topic)
        self._given = [node.subscription(kind, topic, SENSOR_DATA) for kind in (ODOMETRY, *POSES)] if topic else []
        self._pairing = Pairing()
        self._waiting: list[Pair] = []
        self.sender: FrameSender | None = None
        self._rig: dict[str, Any] | None = None
        self._units = MILLIMETRES
        self._next_try = 0.0

    def _stream(self, topic: str, info: str | None, depth: bool, quality: Quality) -> Stream:
        named = info or info_topic(topic)
        images = [self.node.subscription(kind, topic, quality) for kind in IMAGES]
        return Stream(qualified(topic), qualified(named), depth, images, self.node.subscription(CAMERA, named, SENSOR_DATA))

    def step(self) -> None:
        """Takes what came, and sends what is complete."""
        for subscription, static in self._transforms:
            for message in self._messages(subscription):
                self._guarded("refused", subscription.topic, self.poses.add_transforms, message, static=static)
        for subscription in self._given:
            for message in self._messages(subscription):
                if self._depth.frame or hasattr(message, "child_frame_id"):
                    self._guarded("refused", subscription.topic, self.poses.add_pose, message, self._depth.frame)
        for stream in (self._color, self._depth):
            self._take(stream)
        self._send_due()
        self._tell_what_is_missing()

    def finish(self) -> str:
        """Saves the map, if one was begun; returns what came of it."""
        if self.sender is None:
            return "no frame was sent"
        sent = f"{self.sender.taken} frames sent, {self.sender.skipped} skipped"
        self.sender.finish()
        return f"{sent}; the map is saved"

    def _messages(self, subscription: Subscription) -> Any:
        for message in subscription.take():
            if message is None:
                self._report.count("unreadable", f"a message of {subscription.topic} cannot be read; it is left out", where=subscription.topic)
            else:
                yield message

    def _guarded(self, what: str, where: str, act: Callable[..., Any], *values: Any, **named: Any) -> Any:
        """None where it raises, which is said."""
        try:
            return act(*values, **named)
        except (Error, ValueError, TypeError) as fault:
            self._report.count(what, f"{fault}; what follows is counted", where=where)
            return None

    def _take(self, stream: Stream) -> None:
        for message in self._messages(stream.infos):
            if self._guarded("refused", stream.info_topic, camera_of, message, stream.info_topic, stream.topic):
                stream.info = message
        for subscription in stream.images:
            for message in self._messages(subscription):
                self._see_image(stream, message)
        self._tell_of_publishers(stream)

    def _see_image(self, stream: Stream, message: Any) -> None:
        time_ns = stamp_ns(message.header)
        if time_ns == 0:
            self._report.count("refused", f"the images of {stream.topic} have no time stamps; set header.stamp where they are taken",
                               where=stream.topic)
            return
        frame = message.header.frame_id.lstrip("/")
        if stream.frame and frame != stream.frame:
            self._report.count("refused", f"an image of {stream.topic} is of the frame '{frame}', those before were of '{stream.frame}'; let one "
                               "camera publish there, or start anew for another", where=f"{stream.topic} {frame}")
            return
        if stream.newest_ns - time_ns > CLOCK_BACK_NS:
            self._begin_anew(stream, time_ns)
        stream.newest_ns, stream.frame = max(stream.newest_ns, time_ns), frame
        self._pairing.add(time_ns, message, depth=stream.depth)

    def _begin_anew(self, stream: Stream, time_ns: int) -> None:
        self._report.say(f"the clock of {stream.topic} went back by {(stream.newest_ns - time_ns) / 1e9:.3f} s (a bag in a loop?); what "
                         "waits is dropped, transforms are learned anew, and the map goes on")
        self._report.counts["times the clock went back"] += 1
        self._pairing, self._waiting = Pairing(unpaired=self._pairing.unpaired), []
        self.poses.set_back(time_ns)
        self._color.newest_ns = self._depth.newest_ns = 0

    def _send_due(self) -> None:
        before = self._pairing.unpaired
        self._waiting += self._pairing.take()
        if self._pairing.unpaired > before:
            self._report.counts["without colour"] += self._pairing.unpaired - before
            self._report.once("without colour", f"depth of {self._depth.topic} has no colour of {self._color.topic} within 20 ms; let the "
                              "camera take both at once")
        if not self._waiting or not self._ready(self._waiting[0]):
            if len(self._waiting) > KEPT_IMAGES:
                self._report.counts["before the server was ready"] += len(self._waiting) - KEPT_IMAGES
                del self._waiting[:-KEPT_IMAGES]
            return
        waiting, self._waiting = self._waiting, []
        for at, pair in enumerate(waiting):
            if not self._send(pair):
                self._waiting = waiting[at:]
                return

    def _send(self, pair: Pair) -> bool:
        """False where its transform may still come."""
        pose, fault = self._pose(pair) if self._options.poses != "none" else (None, "")
        if fault:
            if self.poses.may_come(self._depth.frame, pair.time_ns, self._depth.newest_ns):
                return False
            self._report.count("without a transform", f"{fault}; images without are left out and counted", where=fault)
            return True
        color = self._guarded("refused", self._color.topic, color_of, pair.color, self._color.topic)
        depth = self._guarded("refused", self._depth.topic, self._depth_picture, pair.depth)
        if color is not None and depth is not None:
            self._post(color, depth, pose, pair.time_ns / 1e9)
        return True

    def _depth_picture(self, message: Any) -> Any:
        """In the units that the server was told."""
        if _in_metres(message) != (self._units == FLOAT_UNITS):
            raise Error(f"{self._depth.topic} changes between depth in metres and in millimetres; let one publisher send one encoding")
        return depth_of(message, self._depth.topic)

    def _pose(self, pair: Pair) -> tuple[Matrix | None, str]:
        """The pose, or None and why."""
        try:
            pose = self.poses.at(self._depth.frame, pair.time_ns)
        except Error as fault:
            return None, str(fault)
        if pose is None:
            return None, (f"no transform of '{self._depth.frame}' at the time of an image; publish /tf as often as images come, on the same clock")
        self._report.once("world", f"poses are in the frame '{self.poses.world}'; --world names another")
        return pose, ""

    def _post(self, color: Any, depth: Any, pose: Matrix | None, seconds: float) -> None:
        assert self.sender is not None
        try:
            if not self.sender.send(color, depth, pose, seconds):
                self._report.once("skipped", "the mapper is busy: frames are skipped and counted")
            self._report.again("server")
        except (SendError, ValueError, TypeError, OSError, http.client.HTTPException) as fault:
            self._report.count("refused by the server", f"the server did not take a frame: {fault}", where=str(fault)[:24])
            gone = isinstance(fault, OSError) or (isinstance(fault, SendError) and fault.status == 409)
            if gone:
                self._lose_server()

    def _lose_server(self) -> None:
        self._rig = None  # the next may be another, which does not know the cameras
        self._next_try = time.monotonic() + RETRY_S

    def _ready(self, first: Pair) -> bool:
        """Whether the server knows the cameras."""
        if self._rig is not None:
            return True
        if self._color.info is None or self._depth.info is None or time.monotonic() < self._next_try:
            return False
        rig = self._guarded("refused", "rig", self._make_rig, first)
        if rig is None:
            return False
        try:
            old, self.sender = self.sender, self._open(rig)
        except (OSError, SendError) as fault:
            self._report.once("server", f"the server cannot be reached or refuses the camera ({fault}); start "
                              "`ovimap serve --live http -o MAP`; tried again every second")
            self._next_try = time.monotonic() + RETRY_S
            return False
        if old is not None:
            self.sender.taken, self.sender.skipped = old.taken, old.skipped
        self._rig = rig
        return True

    def _make_rig(self, first: Pair) -> dict[str, Any] | None:
        self._units = FLOAT_UNITS if _in_metres(first.depth) else MILLIMETRES
        color, depth = (camera_of(stream.info, stream.info_topic, stream.topic) for stream in (self._color, self._depth))
        offset = self._color_from_depth(first.time_ns)
        if offset is None:
            self._report.once("offset", f"no transform from '{self._depth.frame}' to '{self._color.frame}' yet; publish /tf_static of the "
                              "camera, or send depth that is aligned to colour")
            return None
        turn, shift = rotation_vector_of(offset).tolist(), offset[:3, 3].tolist()
        return {"depth_camera": {**depth, "depth_scale": self._units}, "color_camera": color,
                "color_from_depth": {"rotation_vector": turn, "translation": shift}}

    def _color_from_depth(self, time_ns: int) -> Matrix | None:
        """None where tf does not say."""
        if self._color.frame == self._depth.frame:
            return np.eye(4)
        try:
            return self.poses.tree.target_from(self._color.frame, self._depth.frame, time_ns)
        except Error:
            return None

    def _tell_of_publishers(self, stream: Stream) -> None:
        now = sum(subscription.publishers for subscription in stream.images)
        if now == stream.publishers:
            return
        if now == 0:
            self._report.say(f"the publisher of {stream.topic} is gone; what it sends when it comes back is taken")
        elif now > 1:
            self._report.say(f"{now} publishers send images on {stream.topic}, which are taken for one camera's; stop all but one")
        elif stream.told:
            self._report.say(f"{stream.topic} has one publisher again")
        stream.told = now != 1
        stream.publishers, stream.since = now, time.monotonic()

    def _tell_what_is_missing(self) -> None:
        for subscription in (*self._color.images, *self._depth.images, *(one for one, _ in self._transforms)):
            if subscription.mismatched:
                remedy = "leave --reliable out" if subscription.topic not in ("/tf", "/tf_static") else "publish it as tf2 does (docs/robots.md)"
                self._report.once(f"quality {subscription.topic}", f"a publisher of {subscription.topic} offers less than is asked for (reliable "
                                  f"delivery, of /tf_static also to late listeners), so nothing of it comes; {remedy}")
        for stream in (self._color, self._depth):
            if time.monotonic() - stream.since < PATIENCE_S:
                continue
            if not stream.publishers and not stream.newest_ns and not any(one.mismatched for one in stream.images):
                self._report.once(f"no {stream.topic}", f"nobody publishes images on {stream.topic}; check the name (ros2 topic list), "
                                  "ROS_DOMAIN_ID, and that both sides see each other's network")
            elif stream.newest_ns and stream.info is None:
                self._report.once(f"no {stream.info_topic}", f"no camera_info on {stream.info_topic}, so the camera of {stream.topic} is "
                                  "unknown; publish it there, or name its topic as --color-info or --depth-info")


def _in_metres(message: Any) -> bool:
    kind: str = message.encoding if hasattr(message, "encoding") else message.format
    return kind.startswith("32FC1")
