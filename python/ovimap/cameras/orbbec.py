# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Orbbec cameras through pyorbbecsdk (the package pyorbbecsdk2).

What makes a rig and images of the library's frames is tested on such frames; the rest was never run on a camera."""

from __future__ import annotations

import contextlib
import queue
from collections.abc import Callable
from typing import Any

import numpy as np

from .._ovimap import Error
from ..distortion import distortion_of
from ..transforms import Matrix
from .camera import Feed, Image, Wanted, chosen_serial, rig_of, units_per_m

HINT = "plug it in (docs/cameras.md, 'When no camera is found')"
FIRST_S = 20.0  # until the first images
MM_PER_M = 1000


def open_orbbec(wanted: Wanted) -> Orbbec:
    import pyorbbecsdk as ob

    if wanted.file is not None:
        raise Error("recordings of Orbbec cameras are not read; leave --file out")
    ob.Context.set_logger_to_file(ob.OBLogLevel.NONE, "")  # else it leaves a folder Log where the command was called
    found = ob.Context().query_devices()
    serials = [found.get_device_serial_number_by_index(i) for i in range(len(found))]
    serial = chosen_serial("Orbbec", serials, wanted.serial, HINT)
    return Orbbec(ob, found[serials.index(serial)], serial, wanted)


class Orbbec:
    """A device of pyorbbecsdk, which runs from here on: its images tell its depth scale."""

    recorded = False
    gyroscope = False  # not read

    def __init__(self, ob: Any, device: Any, serial: str, wanted: Wanted) -> None:
        self.serial, self.name = serial, f"{device.get_device_info().get_name()} {serial}"
        first: queue.Queue[Any] = queue.Queue()
        self._take: Callable[[Any], None] = first.put
        try:
            self._pipeline = ob.Pipeline(device)
            self._pipeline.start(_streams(ob, self._pipeline, wanted), lambda frames: self._take(frames))
            self.rig = _first_rig(ob, first)
        except (RuntimeError, queue.Empty) as fault:
            why = str(fault) or "it sent no images"
            raise Error(f"{self.name} cannot be started ({why}); close other programs that use it, and plug it in anew") from None

    def start(self, feed: Feed) -> None:
        def take(frames: Any) -> None:
            for image in images_of(frames):
                feed.put(image)

        self._take = take

    def close(self) -> None:
        with contextlib.suppress(RuntimeError):  # of a camera that was unplugged
            self._pipeline.stop()


def _streams(ob: Any, pipeline: Any, wanted: Wanted) -> Any:
    config = ob.Config()
    for sensor, form in ((ob.OBSensorType.DEPTH_SENSOR, ob.OBFormat.Y16), (ob.OBSensorType.COLOR_SENSOR, ob.OBFormat.RGB)):
        profiles = pipeline.get_stream_profile_list(sensor)
        config.enable_stream(profiles.get_video_stream_profile(wanted.width, wanted.height, form, wanted.fps))
    return config


def _first_rig(ob: Any, frames: queue.Queue[Any]) -> dict[str, Any]:
    while True:
        found = frames.get(timeout=FIRST_S)
        if found.get_depth_frame() and found.get_color_frame():
            return rig_of_frames(ob, found.get_depth_frame(), found.get_color_frame())


def rig_of_frames(ob: Any, depth: Any, color: Any) -> dict[str, Any]:
    """The cameras that a DepthFrame and a ColorFrame tell."""
    to, of = color.get_stream_profile(), depth.get_stream_profile()
    extrinsic = of.get_extrinsic_to(to)
    offset: Matrix = np.eye(4)
    offset[:3, :3] = np.reshape(extrinsic.rot, (3, 3))
    offset[:3, 3] = np.asarray(extrinsic.transform) / MM_PER_M
    scale = units_per_m(depth.get_depth_scale() / MM_PER_M)
    return rig_of({**_camera(ob, of), "depth_scale": scale}, _camera(ob, to), offset)


def _camera(ob: Any, profile: Any) -> dict[str, Any]:
    video = profile.as_video_stream_profile()
    inner, lens = video.get_intrinsic(), video.get_distortion()
    if not inner.fx > 0:
        raise Error("the camera holds no calibration; write it with the maker's tools, and try again")
    figures = {"width": inner.width, "height": inner.height, "fx": inner.fx, "fy": inner.fy, "cx": inner.cx, "cy": inner.cy}
    return {**figures, **_distortion(ob, lens)}


def _distortion(ob: Any, lens: Any) -> dict[str, Any]:
    numbers = [lens.k1, lens.k2, lens.p1, lens.p2, lens.k3, lens.k4, lens.k5, lens.k6]
    models = ob.OBCameraDistortionModel
    if lens.model == models.NONE or not any(numbers):
        return {}
    if lens.model == models.KANNALA_BRANDT4:
        return distortion_of("kannala_brandt", [lens.k1, lens.k2, lens.k3, lens.k4])
    if lens.model in (models.BROWN_CONRADY, models.BROWN_CONRADY_K6):
        return distortion_of("brown_conrady", numbers)
    raise Error(f"the camera's lens is a {lens.model.name} one, which is not read; accepted are BROWN_CONRADY, BROWN_CONRADY_K6 and KANNALA_BRANDT4")


def images_of(frames: Any) -> list[Image]:
    """Of a FrameSet."""
    found = []
    for kind, frame in (("depth", frames.get_depth_frame()), ("color", frames.get_color_frame())):
        if frame is not None:
            data = np.asarray(frame.get_data()).view(np.uint16 if kind == "depth" else np.uint8)
            shape = (frame.get_height(), frame.get_width()) + ((3,) if kind == "color" else ())
            found.append(Image(kind, frame.get_timestamp_us() / 1e6, np.array(data.reshape(shape))))
    return found
