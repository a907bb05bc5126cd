# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Sends a camera's images as frames, and says in a line what is wrong with them."""

from __future__ import annotations

import http.client
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from .._ovimap import Error
from ..gyroscope import Quaternion, Rate
from ..sender import SendError
from .camera import CameraLost, Image, TurnRate
from .pairing import Pair, Pairing
from .turns import Turns

PATIENCE_S = 60.0  # for a mapper that is busy, while a recording is read
MOST_REFUSED = 30  # frames, before the first is taken: then none will be
FLICKER_FRAMES = 30
MAX_FLICKER = 0.03  # how far a frame's brightness may be off that of its neighbours, as a share of it
FINISHED = 409  # the map takes no more, or another camera has begun it


class Sink(Protocol):
    """Takes frames: a FrameSender, or a folder that is written."""

    taken: int
    skipped: int

    def send(self, color: npt.NDArray[np.uint8], depth: npt.NDArray[Any], pose: None, timestamp: float, *,
             orientation: Quaternion | None, patience_s: float) -> bool: ...  # fmt: skip


class Relay:
    """Pairs images and hands them to a sink; goes on for as long as that makes sense.

    tell: takes a line that a person should know. waits: for a mapper that is busy, instead of skipping frames. keep_rate: takes the samples of a
    gyroscope, by the times of frames."""

    def __init__(self, sink: Sink, tell: Callable[[str], None], *, waits: bool, keep_rate: Callable[[float, Rate], None] | None = None) -> None:
        self.sink = sink
        self.refused = 0
        self.pairing = Pairing(tell)
        self._turns = Turns(tell, keep_rate)
        self._tell, self._waits = tell, waits
        self._flicker = Flicker(tell)

    def take(self, entries: Iterable[Image | TurnRate]) -> None:
        """Raises Error when the server is gone, takes no more, or took none of many frames; CameraLost when `entries` does."""
        try:
            for entry in entries:
                if isinstance(entry, TurnRate):
                    self._turns.add(entry)
                else:
                    self._send_all(self.pairing.add(entry))
        except CameraLost:
            self._send_all(self.pairing.rest())
            raise
        self._send_all(self.pairing.rest())

    def _send_all(self, pairs: list[Pair]) -> None:
        for pair in pairs:
            self._send(pair)

    def _send(self, pair: Pair) -> None:
        self._flicker.see(pair.color)
        try:
            self.sink.send(pair.color, pair.depth, None, pair.time_s, orientation=self._turns.orientation_of(pair),
                           patience_s=PATIENCE_S if self._waits else 0.0)  # fmt: skip
        except SendError as fault:
            self._refuse(fault)
        except (OSError, http.client.HTTPException) as fault:
            raise Error(f"the server cannot be reached any more ({fault!r}); what it printed says why") from None

    def _refuse(self, fault: SendError) -> None:
        self.refused += 1
        if fault.status == FINISHED:
            raise Error(str(fault))
        if self.sink.taken == 0 and self.refused >= MOST_REFUSED:
            raise Error(f"none of {self.refused} frames was taken: {fault}")
        if self.refused & (self.refused - 1) == 0:  # 1, 2, 4, ...: a fault that stays does not fill the screen
            self._tell(f"a frame was refused ({self.refused} so far): {fault}")


class Flicker:
    """Light that changes from frame to frame and back, as lamps do against a camera's exposure. Told once."""

    def __init__(self, tell: Callable[[str], None]) -> None:
        self._tell: Callable[[str], None] | None = tell
        self._brightness: deque[float] = deque(maxlen=FLICKER_FRAMES)

    def see(self, color: npt.NDArray[np.uint8]) -> None:
        if self._tell is None:
            return
        self._brightness.append(float(color[::16, ::16].mean()))
        if len(self._brightness) < FLICKER_FRAMES:
            return
        b = np.array(self._brightness)
        off = float(np.median(np.abs(b[1:-1] - (b[:-2] + b[2:]) / 2)) / max(float(b.mean()), 1.0))
        if off > MAX_FLICKER:
            self._tell(f"brightness changes by {100 * off:.0f} % from frame to frame; set the camera's power line frequency to that of your lamps, "
                       "or its exposure to a fixed time")
            self._tell = None
