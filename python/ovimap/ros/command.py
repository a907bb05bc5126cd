# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The command ovimap-ros: a robot's images into a map, and a map for a robot, without ROS (docs/robots.md)."""

from __future__ import annotations

import argparse
import pathlib
import signal
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

from .._ovimap import Error
from ..command_line import DONE, run_command
from ..sender import FrameSender, SendError
from ..watching import HOLD_S
from .reporter import Reporter
from .source import Source, is_address, open_source
from .standing import Standing

if TYPE_CHECKING:
    from .mapping import Mapping
    from .publishing import Publishing

WAIT_S = 0.05  # for messages, before what is late is looked at
UPDATE_S = 1.0  # between looks at whether the map changed


def main(arguments: list[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    options = _parser().parse_args(arguments)
    return run_command("ovimap-ros", options, extra="ros", packages=("cyclonedds", "rosbags", "PIL"))


def _run(options: argparse.Namespace) -> int:
    if bool(options.color) != bool(options.depth):
        raise Error("frames need colour and depth: give both --color and --depth, or neither")
    if options.color and not is_address(options.map):
        raise Error(f"'{options.map}' is no address; frames go to `ovimap serve --live http -o MAP`: give what it printed")
    reporter, stop = Reporter(), threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    with ThreadPoolExecutor(1) as pool:  # a question may take longer than images wait
        mapping = _mapping(options, reporter)
        publishing = None if options.no_publish else pool.submit(_publish, options, mapping, reporter, stop)
        try:
            _map(mapping, stop)
        finally:
            stop.set()
            _finish(mapping, reporter)
        if publishing is not None:
            publishing.result()
    return DONE


def _mapping(options: argparse.Namespace, reporter: Reporter) -> Mapping | None:
    from .mapping import Mapping, Options
    from .node import Node

    if not options.color:
        return None
    wanted = Options(options.color, options.depth, options.color_info, options.depth_info, options.poses, options.world, options.reliable)
    return Mapping(Node(options.domain, name="ovimap_frames"), wanted, lambda rig: FrameSender(options.map, rig, cafile=options.cafile), reporter)


def _map(mapping: Mapping | None, stop: threading.Event) -> None:
    while not stop.is_set():
        if mapping is None:
            stop.wait(UPDATE_S)
        else:
            mapping.node.wait(WAIT_S)
            mapping.step()


def _publish(options: argparse.Namespace, mapping: Mapping | None, reporter: Reporter, stop: threading.Event) -> None:
    """Until it is to stop; the command ends with it. Raises Error for a map that is none from the beginning."""
    publishing: Publishing | None = None
    try:
        standing = Standing(options.map, options.watch, options.hold, options.cafile, reporter)
        while not stop.is_set():
            try:
                with open_source(options.map) as source:
                    publishing = _publishing(options, source, mapping, standing, reporter, publishing)
                    while not stop.is_set() and not source.changed():
                        publishing.update()
                        publishing.serve(UPDATE_S)
            except Error as fault:
                if publishing is None:
                    raise
                reporter.once("source", f"{fault}; tried again every second")
                stop.wait(UPDATE_S)
    finally:
        stop.set()


def _publishing(options: argparse.Namespace, source: Source, mapping: Mapping | None, standing: Standing, reporter: Reporter,
                before: Publishing | None) -> Publishing:  # fmt: skip
    """That of before, if there is one, with the map as it is now."""
    from .node import Node
    from .publishing import Publishing
    from .served import MapServer

    def frame() -> str:
        return options.world or "map" if mapping is None or options.poses == "none" else mapping.poses.world

    server = MapServer(source.address, options.cafile)
    if before is not None:
        before.follow(server)
    made = before or Publishing(Node(options.domain, name="ovimap_map"), server, frame, reporter, name=options.name, most_points=options.points,
                                simulated_clock=options.sim_time, robot=_robot(options), standing=standing)  # fmt: skip
    if source.file is not None and not options.no_grid:
        _grid(made, source.file, reporter)
    reporter.again("source")
    return made


def _robot(options: argparse.Namespace) -> dict[str, float]:
    """What was said of it; for the rest the server has its own."""
    said = {"radius_m": options.radius, "camera_height_m": options.camera_height, "fov_deg": options.fov, "range_m": options.range}
    return {name: value for name, value in said.items() if value is not None}


def _grid(publishing: Publishing, file: pathlib.Path, reporter: Reporter) -> None:
    try:
        publishing.publish_grid(file)
    except Error as fault:
        reporter.say(f"no grid: {fault}")


def _finish(mapping: Mapping | None, reporter: Reporter) -> None:
    said = []
    if mapping is not None:
        try:
            said.append(mapping.finish())
        except (SendError, OSError) as fault:
            said.append(str(fault))
    if summary := reporter.summary():
        said.append(summary)
    if said:
        reporter.say("; ".join(said))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="ovimap-ros", description="speaks ROS 2 without ROS: sends a robot's images to a map server, publishes what a map holds",
        epilog="example: ovimap-ros http://localhost:8080/ --color /camera/color/image_raw --depth /camera/aligned_depth_to_color/image_raw")
    parser.add_argument("map", metavar="MAP|URL", help="a map file, or the address that `ovimap serve` printed")
    frames = parser.add_argument_group("frames, for `ovimap serve --live http -o MAP`")
    frames.add_argument("--color", metavar="TOPIC", help="of Image or CompressedImage (JPEG, PNG)")
    frames.add_argument("--depth", metavar="TOPIC", help="of Image (16UC1, 32FC1) or CompressedImage (compressedDepth, PNG)")
    frames.add_argument("--color-info", metavar="TOPIC", help="of CameraInfo; default: camera_info beside the images")
    frames.add_argument("--depth-info", metavar="TOPIC", help="likewise")
    frames.add_argument("--poses", default="tf", metavar="tf|TOPIC|none",
                        help="tf, a topic of Odometry or stamped poses instead, or none where the server tracks the camera")  # fmt: skip
    frames.add_argument("--world", metavar="FRAME", help="frame that poses are given in; default: the root of the transforms, or map")
    frames.add_argument("--reliable", action="store_true", help="ask for images again that were lost; their publisher must offer it")
    out = parser.add_argument_group("what is published")
    out.add_argument("--name", default="/ovimap", help="before the names of topics and of the service (/ovimap)")
    out.add_argument("--points", type=int, default=500_000, help="most points of the cloud (500000)")
    out.add_argument("--sim-time", action="store_true", help="stamp messages with the time of /clock")
    out.add_argument("--no-grid", action="store_true", help="leave the occupancy grid out")
    out.add_argument("--no-publish", action="store_true", help="send frames alone")
    out.add_argument("--watch", metavar="WORDS", action="append", default=[], help='tell once when such a thing is found, and when it is gone. Repeatable')
    out.add_argument("--hold", type=float, default=HOLD_S, metavar="SECONDS",
                     help="what is found on a map that is being made is told when it has stood so long (%(default)g)")  # fmt: skip
    robot = parser.add_argument_group("the robot, for the service approach (docs/robots.md, \"Where to stand\")")
    robot.add_argument("--radius", type=float, metavar="M", help="of the robot, which is round (0.25)")
    robot.add_argument("--camera-height", type=float, metavar="M", help="of its camera (1.2)")
    robot.add_argument("--fov", type=float, metavar="DEGREES", help="what its camera sees, a cone (60)")
    robot.add_argument("--range", type=float, metavar="M", help="from an object to the robot's middle, at most (2)")
    parser.add_argument("--domain", type=int, help="of DDS; default: ROS_DOMAIN_ID, or 0")
    parser.add_argument("--cafile", metavar="PEM", help="certificates to trust, for a server of https with one of its own")
    parser.set_defaults(command=_run)
    return parser


if __name__ == "__main__":
    sys.exit(main())
