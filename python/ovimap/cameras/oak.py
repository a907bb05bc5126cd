# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""OAK cameras through depthai 3. Depth is made and brought to the colour camera on the device, which takes the lens out of both.

What makes a rig and images of the library's messages is tested on such messages; the rest was never run on a camera."""

from __future__ import annotations

import contextlib
import queue
from collections.abc import Callable
from typing import Any

import numpy as np

from .._ovimap import Error
from ..distortion import distortion_of
from .camera import Feed, Image, Wanted, chosen_serial, rig_of

HINT = "plug it into a USB 3 socket (docs/cameras.md, 'When no camera is found')"
UNITS_PER_M = 1000  # the library's default
FIRST_S = 20.0  # until the first images: the device is given its program before them
BROWN_CONRADY = 8  # coefficients of 14 that the other six, thin prism and tilt, must not add to


def open_oak(wanted: Wanted) -> Oak:
    import depthai as dai

    if wanted.file is not None:
        raise Error("recordings of OAK cameras are not read; leave --file out")
    found = dai.Device.getAllAvailableDevices()
    serials = [device.getDeviceId() for device in found]
    serial = chosen_serial("OAK", serials, wanted.serial, HINT)
    return Oak(dai, found[serials.index(serial)], serial, wanted)


class Oak:
    """A device of depthai, which runs from here on: its images tell its calibration."""

    recorded = False
    gyroscope = False  # not read

    def __init__(self, dai: Any, info: Any, serial: str, wanted: Wanted) -> None:
        self.serial, self.name = serial, f"OAK {serial}"
        first: queue.Queue[tuple[str, Any]] = queue.Queue()
        self._take: Callable[[str, Any], None] = lambda kind, message: first.put((kind, message))
        try:
            self._pipeline = dai.Pipeline(dai.Device(info))
            for kind, output in _outputs(dai, self._pipeline, wanted).items():
                output.createOutputQueue().addCallback(lambda message, kind=kind: self._take(kind, message))
            self._pipeline.start()
            self.rig = rig_of_messages(dai, _first_of_each(first))
        except (RuntimeError, queue.Empty) as fault:
            why = str(fault) or "it sent no images"
            raise Error(f"{self.name} cannot be started ({why}); close other programs that use it, and plug it in anew") from None

    def start(self, feed: Feed) -> None:
        self._take = lambda kind, message: feed.put(image_of(kind, message))

    def close(self) -> None:
        with contextlib.suppress(RuntimeError):  # of a camera that was unplugged
            self._pipeline.stop()


def _outputs(dai: Any, pipeline: Any, wanted: Wanted) -> dict[str, Any]:
    size, socket = (wanted.width, wanted.height), dai.CameraBoardSocket
    camera = {name: pipeline.create(dai.node.Camera).build(getattr(socket, name)) for name in ("CAM_A", "CAM_B", "CAM_C")}
    color = camera["CAM_A"].requestOutput(size, type=dai.ImgFrame.Type.RGB888i, fps=float(wanted.fps), enableUndistortion=True)
    stereo = pipeline.create(dai.node.StereoDepth)
    camera["CAM_B"].requestOutput((640, 400), fps=float(wanted.fps)).link(stereo.left)
    camera["CAM_C"].requestOutput((640, 400), fps=float(wanted.fps)).link(stereo.right)
    stereo.setLeftRightCheck(True)  # which alignment needs
    stereo.setDepthAlign(socket.CAM_A)
    stereo.setOutputSize(*size)
    return {"color": color, "depth": stereo.depth}


def _first_of_each(messages: queue.Queue[tuple[str, Any]]) -> dict[str, Any]:
    first: dict[str, Any] = {}
    while len(first) < 2:
        kind, message = messages.get(timeout=FIRST_S)
        first.setdefault(kind, message)
    return first


def rig_of_messages(dai: Any, first: dict[str, Any]) -> dict[str, Any]:
    """The cameras that the device's own messages tell: {"color": ImgFrame, "depth": ImgFrame}."""
    cameras = {kind: _camera(dai, message.getTransformation()) for kind, message in first.items()}
    return rig_of({**cameras["depth"], "depth_scale": UNITS_PER_M}, cameras["color"], np.eye(4))


def _camera(dai: Any, transformation: Any) -> dict[str, Any]:
    matrix, (width, height) = transformation.getIntrinsicMatrix(), transformation.getSize()
    if not matrix[0][0] > 1:  # without one, the library gives the identity
        raise Error("the camera holds no calibration; write it with the maker's tools, and try again")
    figures = {"width": width, "height": height, "fx": matrix[0][0], "fy": matrix[1][1], "cx": matrix[0][2], "cy": matrix[1][2]}
    model, numbers = transformation.getDistortionModel(), list(transformation.getDistortionCoefficients())
    if not any(numbers):
        return figures
    if model == dai.CameraModel.Fisheye and len(numbers) >= 4:
        return {**figures, **distortion_of("kannala_brandt", numbers[:4])}
    if model == dai.CameraModel.Perspective and not any(numbers[BROWN_CONRADY:]):
        return {**figures, **distortion_of("brown_conrady", (numbers + BROWN_CONRADY * [0.0])[:BROWN_CONRADY])}
    raise Error(f"the camera's lens is a {model.name} one with {len(numbers)} numbers, which is not read; accepted are Brown-Conrady and fisheye")


def image_of(kind: str, message: Any) -> Image:
    return Image(kind, message.getTimestampDevice().total_seconds(), np.array(message.getFrame()))
