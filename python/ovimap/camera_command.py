# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The command ovimap-camera: what a camera sees goes to `ovimap serve --live http`, or into a folder (docs/cameras.md)."""

from __future__ import annotations

import argparse
import itertools
import json
import pathlib
import sys
import time
from collections.abc import Callable, Iterator

from ._ovimap import Error
from .cameras import MAKERS, Camera, CameraLost, Feed, Image, Relay, TurnRate, Wanted, open_camera
from .cameras.folder import FolderWriter
from .command_line import DONE, NO, run_command
from .sender import FrameSender, SendError

PACKAGES = ("pyrealsense2", "depthai", "pyorbbecsdk")
QUIET_S = 5.0  # a camera that sends nothing for so long is lost
LOOK_S = 1.0  # between looks for a camera that was lost


def main(arguments: list[str] | None = None) -> int:
    """The command ovimap-camera."""
    options = _parser().parse_args(arguments)
    return run_command("ovimap-camera", options, extra=options.maker, packages=PACKAGES)


class Session:
    """One camera from when it is found until it ends; a camera that is lost meanwhile may come back within wait_s.

    open_again: finds it. seconds: how long to go on; None: for as long as there are images."""

    def __init__(self, camera: Camera, open_again: Callable[[], Camera], relay: Relay, tell: Callable[[str], None], *,
                 wait_s: float = 30.0, quiet_s: float = QUIET_S, seconds: float | None = None) -> None:  # fmt: skip
        self._camera, self._open_again, self._relay, self._tell = camera, open_again, relay, tell
        self._wait_s, self._quiet_s = wait_s, quiet_s
        self._end = None if seconds is None else time.monotonic() + seconds
        self.dropped = 0

    def run(self) -> bool:
        """False when the camera was lost for good."""
        rig = self._camera.rig
        while True:
            fault = self._stream()
            if fault is None:
                return True
            if self._camera.recorded:
                self._tell(f"the recording of {self._camera.name} {fault}; what it gave until then is kept")
                return False
            self._tell(f"{self._camera.name} {fault}; waiting {self._wait_s:g} s for it to come back")
            back = self._found_again()
            if back is None:
                return False
            if back.rig != rig:
                raise Error(f"{back.name} has another calibration than the camera that was lost; begin a new map with it")
            self._camera = back
            self._tell(f"{back.name} is back")

    def _stream(self) -> str | None:
        """Until it ends, or how it was lost."""
        feed = Feed(waits=self._camera.recorded)
        try:
            self._camera.start(feed)
            self._relay.take(self._in_time(feed.entries(self._quiet_s)))
        except CameraLost as lost:
            return str(lost)
        finally:
            feed.close()
            self._camera.close()
            self.dropped += feed.dropped
        return None

    def _in_time(self, entries: Iterator[Image | TurnRate]) -> Iterator[Image | TurnRate]:
        return itertools.takewhile(lambda _: self._end is None or time.monotonic() < self._end, entries)

    def _found_again(self) -> Camera | None:
        end = time.monotonic() + self._wait_s
        while time.monotonic() < end:
            try:
                return self._open_again()
            except Error:
                time.sleep(LOOK_S)
        return None


def _command(options: argparse.Namespace) -> int:
    width, height = options.size
    wanted = Wanted(options.serial, options.file, width, height, options.fps)
    camera = open_camera(options.maker, wanted)
    sink = _sink(options, camera)
    relay = Relay(sink, _tell, waits=camera.recorded, keep_rate=sink.keep_rate if isinstance(sink, FolderWriter) else None)
    again = Wanted(camera.serial, None, width, height, options.fps)
    session = Session(camera, lambda: open_camera(options.maker, again), relay, _tell, wait_s=options.wait_s, seconds=options.seconds)
    turns = " and how its gyroscope turns" if camera.gyroscope else ""
    _tell(f"{camera.name}: sending images{turns} to {options.folder or options.url}; Ctrl-C ends")
    try:
        whole = session.run()
    except KeyboardInterrupt:
        whole = True
    finally:
        saved = _finish(sink)
    counts = {"taken": sink.taken, "skipped": sink.skipped + session.dropped, "refused": relay.refused, "left_out": relay.pairing.left_out}
    said = ", ".join(f"{count} {name.replace('_', ' ')}" for name, count in counts.items())
    print(json.dumps({"camera": camera.name, **counts, "saved": saved}) if options.json else f"{camera.name}: frames: {said}")
    return DONE if whole and saved else NO


def _sink(options: argparse.Namespace, camera: Camera) -> FrameSender | FolderWriter:
    if options.folder:
        return FolderWriter(options.folder, camera.rig)
    try:
        return FrameSender(options.url, camera.rig, cafile=options.cafile)
    except (ValueError, SendError) as fault:
        raise Error(str(fault)) from None
    except OSError as fault:
        raise Error(f"{options.url} cannot be reached ({fault}); start there: ovimap serve --live http --poses track -o room.ovimap") from None


def _finish(sink: FrameSender | FolderWriter) -> bool:
    """Whether what was taken is saved; with nothing taken there is nothing to save, and the server waits for another try."""
    if not sink.taken:
        return False
    try:
        sink.finish()
    except SendError as fault:
        _tell(f"the map was not seen to be saved: {fault}")
        return False
    return True


def _tell(line: str) -> None:
    print(f"ovimap-camera: {line}", file=sys.stderr, flush=True)


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    if not (width.isdigit() and height.isdigit()):
        raise argparse.ArgumentTypeError(f"'{text}' is no size; give WIDTHxHEIGHT, as 640x480")
    return int(width), int(height)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="ovimap-camera", description="sends what a depth camera sees to `ovimap serve --live http --poses track`")
    parser.add_argument("maker", choices=MAKERS, help="whose camera")
    parser.add_argument("--url", default="http://localhost:8080/", help="what the server printed, with its token (http://localhost:8080/)")
    parser.add_argument("--cafile", help="certificate to trust, for a server with one of its own")
    parser.add_argument("--folder", type=pathlib.Path, help="write a recording for `ovimap run` there, instead of sending")
    parser.add_argument("--file", type=pathlib.Path, help="read a recording of the maker's own tools, instead of a camera")
    parser.add_argument("--serial", default="", help="serial number (of an OpenNI camera its URI), where several cameras are plugged in")
    parser.add_argument("--size", type=_size, default=(640, 480), help="of colour and depth (640x480)")
    parser.add_argument("--fps", type=int, default=30, help="frames a second (30)")
    parser.add_argument("--seconds", type=float, help="end after so long")
    parser.add_argument("--wait-s", type=float, default=30.0, help="how long to wait for a camera that was unplugged (30)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.set_defaults(command=_command)
    return parser


if __name__ == "__main__":
    sys.exit(main())
