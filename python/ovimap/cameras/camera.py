# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What every camera gives, and the way of its images from the threads of its library to the one that sends them."""

from __future__ import annotations

import collections
import pathlib
import threading
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from .._ovimap import Error
from ..gyroscope import Rate
from ..transforms import Matrix, rotation_vector_of

WAITING_RATES = 4000  # of a gyroscope: ten seconds of 400 a second
WAITING_IMAGES = 8  # half a dozen frames' delay is worse than a frame left out


@dataclass(frozen=True)
class Wanted:
    """Which camera, and what of it."""

    serial: str = ""  # "": the only one
    file: pathlib.Path | None = None  # a recording instead
    width: int = 640
    height: int = 480
    fps: int = 30


@dataclass(frozen=True)
class Image:
    """color: uint8 [height, width, 3], red first; else depth: uint16 [height, width] in the camera's units."""

    kind: str
    time_s: float  # by the camera's clock
    pixels: npt.NDArray[Any]


@dataclass(frozen=True)
class TurnRate:
    """A sample of the camera's gyroscope."""

    time_s: float  # by the camera's clock
    rad_per_s: Rate  # about the axes of the depth camera


class CameraLost(Exception):
    """It sends no more; the text is a sentence's end, as "was unplugged"."""


class Camera(Protocol):
    """A camera that is plugged in, or its recording."""

    name: str
    serial: str
    rig: dict[str, Any]  # as FrameSender takes it
    recorded: bool  # it waits for whoever takes its images
    gyroscope: bool  # it tells how it turns

    def start(self, feed: Feed) -> None:
        """Puts images into the feed from now on, and ends it when there are no more."""

    def close(self) -> None: ...


class Feed:
    """Images between threads, and what a gyroscope measured between them.

    waits: where the images of a recording find no room its thread waits; a camera goes on, and its oldest image is dropped. Samples of a gyroscope
    are small and always find room."""

    def __init__(self, *, waits: bool) -> None:
        self.dropped = 0
        self._waits = waits
        self._entries: collections.deque[Image | TurnRate] = collections.deque()
        self._images = 0  # among them
        self._changed = threading.Condition()
        self._ended = self._closed = False
        self._fault = ""

    def put(self, image: Image) -> None:
        with self._changed:
            while self._waits and self._images >= WAITING_IMAGES and not self._closed:
                self._changed.wait()
            if self._images >= WAITING_IMAGES:
                del self._entries[next(i for i, entry in enumerate(self._entries) if isinstance(entry, Image))]
                self._images -= 1
                self.dropped += 1
            self._entries.append(image)
            self._images += 1
            self._changed.notify_all()

    def turn(self, rate: TurnRate) -> None:
        with self._changed:
            self._entries.append(rate)
            if len(self._entries) > self._images + WAITING_RATES:  # nobody takes any
                del self._entries[next(i for i, entry in enumerate(self._entries) if isinstance(entry, TurnRate))]

    def end(self, fault: str = "") -> None:
        """No more come; `fault`: as CameraLost has it, where that was not meant."""
        with self._changed:
            self._ended, self._fault = True, self._fault or fault
            self._changed.notify_all()

    def close(self) -> None:
        """Nobody takes any more: threads that wait go on."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def entries(self, patience_s: float) -> Iterator[Image | TurnRate]:
        """In the order in which they came, until the feed ends. Raises CameraLost when that was not meant, and when no image comes within
        patience_s."""
        while True:
            with self._changed:
                end = time.monotonic() + patience_s
                while not self._images and not self._ended and time.monotonic() < end:
                    self._changed.wait(max(0.0, end - time.monotonic()))
                if not self._images:
                    if self._ended and not self._fault:
                        return
                    raise CameraLost(self._fault or f"has sent no image for {patience_s:g} s")
                taken = self._up_to_an_image()
                self._changed.notify_all()
            yield from taken

    def _up_to_an_image(self) -> list[Image | TurnRate]:
        taken = [self._entries.popleft()]
        while not isinstance(taken[-1], Image):
            taken.append(self._entries.popleft())
        self._images -= 1
        return taken


def chosen_serial(maker: str, serials: list[str], wanted: str, hint: str) -> str:
    """The serial number that is meant. Raises Error where that is none or several; `hint` ends the sentence on an absent camera."""
    listed = ", ".join(sorted(set(serials)))
    if not serials:
        raise Error(f"no {maker} camera is plugged in; {hint}")
    if wanted and wanted not in serials:
        raise Error(f"no {maker} camera has the serial number {wanted}; plugged in: {listed}")
    serial = wanted or serials[0]
    if not wanted and len(set(serials)) > 1:
        raise Error(f"{len(serials)} {maker} cameras are plugged in ({listed}); choose one with --serial")
    if serials.count(serial) > 1:
        raise Error(f"{serials.count(serial)} {maker} cameras have the serial number {serial}; unplug all but the one you mean")
    return serial


def rig_of(depth: Mapping[str, Any], color: Mapping[str, Any], color_from_depth: Matrix) -> dict[str, Any]:
    """color_from_depth: [4, 4], metres."""
    turn, shift = rotation_vector_of(color_from_depth).tolist(), color_from_depth[:3, 3].tolist()
    return {"depth_camera": dict(depth), "color_camera": dict(color), "color_from_depth": {"rotation_vector": turn, "translation": shift}}


def units_per_m(unit_m: float) -> float:
    """Of a depth unit that passed through 32 bits: 0.0002500000118 m are 4000 a metre."""
    return float(np.round(1 / unit_m, 2))
