# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Which images belong together, and where the camera was then."""

from __future__ import annotations

import bisect
from dataclasses import dataclass, field
from typing import Any

from .._ovimap import Error
from ..bag_messages import add_transforms, pose_of, stamp_ns
from ..transforms import Link, Matrix, TransformTree

MAX_GAP_NS = 20_000_000  # colour and depth farther apart do not belong together
KEPT_IMAGES = 60  # that wait for their counterpart or their pose; the oldest go
KEPT_TRANSFORMS_NS = 10_000_000_000  # as tf2 keeps them
MAX_WAIT_NS = 1_000_000_000  # for a transform, on the images' clock
CLOCK_BACK_NS = 1_000_000_000  # less is disorder on the way, more is a clock that was set back


@dataclass
class Pair:
    """A message of depth, the colour nearest in time, and the time of depth."""

    time_ns: int
    color: Any
    depth: Any


@dataclass
class Pairing:
    """Images by time; `unpaired` counts depth that came without colour."""

    colors: list[tuple[int, Any]] = field(default_factory=list)
    depths: list[tuple[int, Any]] = field(default_factory=list)
    unpaired: int = 0

    def add(self, time_ns: int, message: Any, *, depth: bool) -> None:
        images = self.depths if depth else self.colors
        at = bisect.bisect_left(images, time_ns, key=_time)
        if at < len(images) and images[at][0] == time_ns:
            return  # the same image twice
        images.insert(at, (time_ns, message))
        if depth and len(images) > KEPT_IMAGES:
            self.unpaired += len(images) - KEPT_IMAGES
        del images[:-KEPT_IMAGES]

    def take(self) -> list[Pair]:
        """Those that no image still to come can change."""
        if not self.colors:
            return []
        due = bisect.bisect_right(self.depths, self.colors[-1][0], key=_time)
        depths, self.depths = self.depths[:due], self.depths[due:]
        pairs = []
        for time_ns, depth in depths:
            color_ns, color = min(self.colors, key=lambda entry: abs(entry[0] - time_ns))
            if abs(color_ns - time_ns) > MAX_GAP_NS:
                self.unpaired += 1
            else:
                pairs.append(Pair(time_ns, color, depth))
        return pairs


def _time(entry: tuple[int, Any]) -> int:
    return entry[0]


class Poses:
    """Where frames are in the world: by tf, or by a topic of poses that is used in its place.

    world: None for the root of the transforms, which is settled when the first pose is asked for. topic: of poses; "" for none."""

    def __init__(self, world: str | None = None, topic: str = "") -> None:
        self.wanted, self.world, self.topic = world and world.lstrip("/"), "", topic
        self.tree = TransformTree()
        self._given: tuple[str, Link] | None = None  # of the topic of poses: which frame, and where it was

    def add_transforms(self, message: Any, *, static: bool) -> None:
        for entry in message.transforms:
            _restart(self.tree.links.get(entry.child_frame_id.lstrip("/")), stamp_ns(entry.header))
        add_transforms(self.tree, message, static=static)
        self._prefer_given()
        if not static and message.transforms:
            self.tree.forget(stamp_ns(message.transforms[-1].header) - KEPT_TRANSFORMS_NS)

    def add_pose(self, message: Any, camera: str) -> None:
        """Of an odometry, or of a pose, which names no frame: it is the camera's."""
        child = (getattr(message, "child_frame_id", "") or camera).lstrip("/")
        if self._given is None or self._given[0] != child:
            self._given = child, Link(message.header.frame_id.lstrip("/"), static=False)
        _restart(self._given[1], stamp_ns(message.header))
        self._given[1].add(stamp_ns(message.header), pose_of(message))
        self._given[1].forget(stamp_ns(message.header) - KEPT_TRANSFORMS_NS)
        self._prefer_given()

    def _prefer_given(self) -> None:
        if self._given is not None:
            self.tree.links[self._given[0]] = self._given[1]

    def set_back(self, time_ns: int) -> None:
        """The clock went back to that time: what moves is learned anew."""
        for link in self.tree.links.values():
            _restart(link, time_ns)

    def at(self, frame: str, time_ns: int) -> Matrix | None:
        """world_from_frame; None where it is not known for this time. Raises Error where it cannot come to be known as things are."""
        self._settle_world(frame)
        return self.tree.target_from(self.world, frame, time_ns)

    def may_come(self, frame: str, time_ns: int, newest_ns: int) -> bool:
        """Whether to wait for the transforms of this time: what is newest is not much newer."""
        if newest_ns - time_ns > MAX_WAIT_NS:
            return False
        until = self.tree.known_until_ns(self.world, frame) if self.world else None
        return until is None or until < time_ns

    def _settle_world(self, frame: str) -> None:
        if self.world:
            return
        if self.topic and self._given is None:
            raise Error(f"no pose came on {self.topic}; publish Odometry, PoseStamped or PoseWithCovarianceStamped there")
        chain = self.tree.chain(frame)
        if self.wanted is not None and self.wanted not in chain:
            raise Error(f"the transforms do not connect the camera's frame '{frame}' with the world '{self.wanted}' (its ancestors: "
                        f"{', '.join(chain[1:]) or 'none'}); publish /tf and /tf_static, or name another --world")
        world = self.wanted or chain[-1]
        if self.tree.known_until_ns(world, frame) is None:
            raise Error(f"nothing moves the camera's frame '{frame}' in /tf (known: {' -> '.join(chain)}); start what localizes the robot, "
                        "give a topic of poses as --poses, or --poses none where the server tracks the camera")
        self.world = world


def _restart(link: Link | None, time_ns: int) -> None:
    """Forgets where a frame was, if that was long after this time."""
    if link is not None and not link.static and link.times_ns and link.times_ns[-1] - time_ns > CLOCK_BACK_NS:
        link.times_ns.clear()
        link.matrices.clear()
