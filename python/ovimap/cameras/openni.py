# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Cameras of OpenNI 2 (Kinect, Xtion, Astra) through the reader that `ovimap run openni:` has, which needs no package of Python's.

Tested with the library and a driver of software; never run on a camera."""

from __future__ import annotations

import threading

import numpy as np

from .._ovimap import Error, Frame, PinholeCamera, RgbdCamera
from .camera import Feed, Image, Wanted, rig_of

FIRST_S = 20.0  # until the first images
LOOK_S = 0.1  # between looks at whether to stop


def open_openni(wanted: Wanted) -> OpenNi:
    if wanted.file is not None:
        raise Error("ovimap run reads recordings of OpenNI itself: give it the .oni file, and leave --file out")
    if (wanted.width, wanted.height, wanted.fps) != (Wanted.width, Wanted.height, Wanted.fps):
        raise Error("OpenNI cameras are opened at 640x480 and 30 frames/s, or at the largest size that they have; leave --size and --fps out")
    return OpenNi(wanted.serial)


class OpenNi:
    """A device, which runs from here on: its first frame tells its calibration. `serial`: its URI; "": the only one."""

    recorded = False
    gyroscope = False  # these cameras have none

    def __init__(self, serial: str) -> None:
        camera = RgbdCamera(f"openni:{serial}")
        self.serial, self.name = serial, camera.name
        first = camera.next(FIRST_S)
        if first is None:
            raise Error(f"{self.name} {camera.fault or 'sends no images'}; plug it in anew")
        self.rig = rig_of({**_figures(first.camera), "depth_scale": camera.depth_units_per_m}, _figures(first.color_camera), first.color_from_depth)
        self._camera: RgbdCamera | None = camera
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self, feed: Feed) -> None:
        self._thread = threading.Thread(target=self._run, args=(self._camera, feed), daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._stop.set()
        if self._thread is not None:
            self._thread.join()
        self._camera = self._thread = None  # lets the device go

    def _run(self, camera: RgbdCamera, feed: Feed) -> None:
        while not self._stop.is_set():
            frame = camera.next(LOOK_S)
            if frame is not None:
                for image in images_of(frame, camera.depth_units_per_m):
                    feed.put(image)
            elif camera.fault:
                feed.end(camera.fault)
                return


def images_of(frame: Frame, units_per_m: float) -> list[Image]:
    """Depth in the camera's units again, which metres of 32 bits hold exactly."""
    depth = np.rint(np.asarray(frame.depth) * units_per_m)
    return [Image("color", frame.timestamp_s, np.array(frame.color)), Image("depth", frame.timestamp_s, depth.astype(np.uint16))]


def _figures(camera: PinholeCamera) -> dict[str, float]:
    return {name: getattr(camera, name) for name in ("width", "height", "fx", "fy", "cx", "cy")}
