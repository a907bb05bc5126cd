# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What a camera's gyroscope measures, brought to its frames."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from ..gyroscope import Gyroscope, Quaternion, Rate
from .camera import TurnRate
from .pairing import Pair

KEEP_SAMPLES = 4000  # that wait for a frame: ten seconds of 400 a second
NEAR_S = 1.0  # samples farther from their frame are of a clock that was set since
LONELY = 30  # frames in a row without orientation are worth a line


class Turns:
    """Tells how the camera was turned at each frame, and passes the samples on by the times of frames.

    tell: takes a line that a person should know. keep: takes a sample, its time and its rate; None: nobody wants them."""

    def __init__(self, tell: Callable[[str], None], keep: Callable[[float, Rate], None] | None = None) -> None:
        self._tell, self._keep = tell, keep
        self._gyroscope = Gyroscope()
        self._waiting: deque[TurnRate] = deque(maxlen=KEEP_SAMPLES)
        self._any, self._lonely = False, 0

    def add(self, rate: TurnRate) -> None:
        self._any = True
        self._gyroscope.add(rate.time_s, rate.rad_per_s)
        self._waiting.append(rate)

    def orientation_of(self, pair: Pair) -> Quaternion | None:
        """As FrameSender.send takes it; call it once for each frame, in order."""
        self._pass_on(pair)
        orientation = self._gyroscope.at(pair.clock_s)
        self._lonely = self._lonely + 1 if self._any and orientation is None else 0
        if self._lonely == LONELY:
            self._tell(f"the gyroscope measured nothing at the times of {LONELY} depth images in a row, so it is left out for now; let both run by "
                       "one clock")  # fmt: skip
        return orientation

    def _pass_on(self, pair: Pair) -> None:
        """What was measured up to the frame; what is far from it was measured before the clock was set."""
        while self._keep and self._waiting and not 0 < self._waiting[0].time_s - pair.clock_s < NEAR_S:
            rate = self._waiting.popleft()
            if abs(rate.time_s - pair.clock_s) < NEAR_S:
                self._keep(rate.time_s + pair.time_s - pair.clock_s, rate.rad_per_s)
