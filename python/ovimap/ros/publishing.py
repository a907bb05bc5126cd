# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What a map holds, for other nodes: published anew when it changes, and a service that is asked in words."""

from __future__ import annotations

import json
import pathlib
import time
from collections.abc import Callable
from typing import Any

from .._ovimap import Error
from .grid import grid_of
from .messages import (
    CLOUD,
    DETECTIONS,
    GRID,
    MARKERS,
    TEXT_LINE,
    TRANSFORM,
    cloud_message,
    detections_message,
    frames_message,
    grid_message,
    header_of,
    markers_message,
    poses_message,
    way_message,
)
from .node import CLOCK, EVENTS, LATCHED, STATIC_TRANSFORMS, Node
from .reporter import Reporter
from .served import MapServer
from .standing import Standing
from .types import APPROACH, QUERY, make

SIMULATED_CLOCK = "rosgraph_msgs/msg/Clock"


class Clock:
    """The time that messages are stamped with: the machine's, or what /clock says."""

    def __init__(self, node: Node, simulated: bool) -> None:
        self._ticks = node.subscription(SIMULATED_CLOCK, "/clock", CLOCK) if simulated else None
        self._latest_ns = 0

    def listen(self) -> None:
        """Takes what /clock said; what is not taken keeps the node awake."""
        for tick in self._ticks.take() if self._ticks else ():
            if tick is not None:
                self._latest_ns = tick.clock.sec * 1_000_000_000 + tick.clock.nanosec

    def now_ns(self) -> int:
        self.listen()
        return self._latest_ns if self._ticks else time.time_ns()


class Publishing:
    """Publishes under `name`, "/ovimap" as a rule: objects, detections, markers, grid; what becomes of
    standing queries; and the services query and approach.

    frame: gives the world's frame by now, in which all of it is; "" while there is none. most_points: of the cloud. robot: its
    settings, as POST /api/approach takes them."""

    def __init__(self, node: Node, server: MapServer, frame: Callable[[], str], reporter: Reporter, *, name: str = "/ovimap",
                 most_points: int = 500_000, simulated_clock: bool = False, robot: dict[str, float] | None = None, standing: Standing | None = None) -> None:  # fmt: skip
        self._node, self._frame, self._report, self._most_points = node, frame, reporter, most_points
        self._robot, self._standing = robot or {}, standing
        self.follow(server)
        self._clock = Clock(node, simulated_clock)
        self._out = {kind: node.publisher(kind, f"{name}/{topic}", LATCHED)
                     for kind, topic in ((CLOUD, "objects"), (DETECTIONS, "detections"), (MARKERS, "markers"), (GRID, "grid"))}
        self._frames = node.publisher(TRANSFORM, "/tf_static", STATIC_TRANSFORMS)
        self._events = node.publisher(TEXT_LINE, f"{name}/events", EVENTS)
        self._services = [node.service(QUERY, f"{name}/query", self._answer), node.service(APPROACH, f"{name}/approach", self._stand)]

    def follow(self, server: MapServer) -> None:
        """From now on that server's map."""
        self._server = server
        self._published: tuple[Any, ...] = ()

    def serve(self, seconds: float) -> None:
        """Answers queries for that long."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self._node.wait(left)
            self._clock.listen()
            for service in self._services:
                service.serve()
            self._tell()

    def _tell(self) -> None:
        for event in self._standing.events() if self._standing else ():
            self._events.publish(make(TEXT_LINE, data=json.dumps(event.as_dict())))

    def update(self) -> None:
        """Publishes the map if it is another than last time. What the server refuses is said once."""
        try:
            about, frame = self._server.about(), self._frame()
            state = (*(about[key] for key in ("title", "live", "content_hash", "version", "mesh_version")), frame)
            if not frame or state == self._published:
                return
            self._publish(frame)
            self._published = state
            self._report.again("map")
        except Error as fault:
            self._report.once("map", str(fault))

    def publish_grid(self, map_file: pathlib.Path) -> None:
        self._out[GRID].publish(grid_message(grid_of(map_file), self._header()))

    def _publish(self, frame: str) -> None:
        things, header = self._server.objects(), self._header()
        self._out[CLOUD].publish(cloud_message(self._server.cloud(self._most_points), header))
        self._out[DETECTIONS].publish(detections_message(things, header))
        self._out[MARKERS].publish(markers_message(things, header))
        if any(thing["name"] for thing in things):
            self._frames.publish(frames_message(things, header))

    def _header(self) -> Any:
        return header_of(self._frame(), self._clock.now_ns())

    def _answer(self, request: Any) -> Any:
        """Of the service query: what matches, best first, with its probability; the message says how it was understood, or what is wrong."""
        header = self._header()
        try:
            found, message, matches, _ = self._find(request.text, header)
        except Error as fault:
            found, message, matches = False, str(fault), detections_message([], header)
        return make(f"{QUERY}_Response", found=found, message=message, matches=matches)

    def _stand(self, request: Any) -> Any:
        """Of the service approach: the same, and from where the best match is seen; found where it is and can be."""
        header = self._header()
        poses: list[dict[str, Any]] = []
        try:
            found, message, matches, best = self._find(request.text, header)
            if found and best is not None:
                start = [getattr(request.start[0], axis) for axis in "xyz"] if request.start else None
                said = self._server.approach(best, start, self._robot)
                poses, found = said["poses"], bool(said["poses"])
                message = message if found else f"object {best} cannot be reached: {said['reason']}"
        except Error as fault:
            found, message, matches = False, str(fault), detections_message([], header)
        return make(f"{APPROACH}_Response", found=found, message=message, matches=matches, poses=poses_message(poses, header),
                    way=way_message(poses, header))  # fmt: skip

    def _find(self, text: str, header: Any) -> tuple[bool, str, Any, int | None]:
        """Whether it is there, how it was understood, what matches, and the best of that. Raises Error for what the server refuses."""
        said = self._server.query(text)
        scores = {match["id"]: float(match["probability"] or 0) for match in said["matches"]}
        things = {thing["id"]: thing for thing in self._server.objects()}
        matching = [things[number] for number in scores if number in things]
        best = matching[0]["id"] if matching else None
        message = said["reason"] or said["reading"] or said["verdict"]
        return said["verdict"] == "found", message, detections_message(matching, header, scores), best
