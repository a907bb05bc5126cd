# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Adds up the turns that a gyroscope measures, for FrameSender.send(orientation=...). Needs nothing but Python, and may be copied with sender.py."""

from __future__ import annotations

import bisect
import math
from collections.abc import Sequence

Quaternion = tuple[float, float, float, float]  # x, y, z, w
Rate = tuple[float, float, float]  # radians a second about x, y and z

KEEP_S = 5.0  # for images that come so late
MAX_GAP_S = 0.1  # between samples; in a longer one anything may happen
AHEAD_S = 0.02  # after the last sample the camera is taken to turn on for so long


class Gyroscope:
    """How a camera is turned, in a world in which it began without a rotation and which drifts: what two moments near each other differ by is
    how the camera turned between them. Rates change evenly from sample to sample (the midpoint rule)."""

    def __init__(self) -> None:
        self._times: list[float] = []
        self._rates: list[Rate] = []
        self._orientations: list[Quaternion] = []

    def add(self, time_s: float, rate: Sequence[float]) -> None:
        """A sample: radians a second about the axes of the depth camera (x right, y down, z forward). Where the clock goes back or stands still for
        longer than MAX_GAP_S, what was before is forgotten."""
        now: Rate = (float(rate[0]), float(rate[1]), float(rate[2]))
        orientation: Quaternion = self._orientations[-1] if self._orientations else (0.0, 0.0, 0.0, 1.0)
        if self._times and not self._times[-1] < time_s <= self._times[-1] + MAX_GAP_S:
            self._forget(len(self._times))
        elif self._times:
            orientation = _turned(orientation, self._rates[-1], now, time_s - self._times[-1])
        self._times.append(time_s)
        self._rates.append(now)
        self._orientations.append(orientation)
        if time_s - self._times[0] > 2 * KEEP_S:
            self._forget(bisect.bisect_left(self._times, time_s - KEEP_S))

    def at(self, time_s: float) -> Quaternion | None:
        """world_from_camera at a time of the same clock; None where it was not measured."""
        after = bisect.bisect_left(self._times, time_s)
        if after == 0:
            return self._orientations[0] if self._times and self._times[0] == time_s else None
        before_s, before = self._times[after - 1], self._rates[after - 1]
        if after == len(self._times):
            return _turned(self._orientations[-1], before, before, time_s - before_s) if time_s - before_s <= AHEAD_S else None
        share = (time_s - before_s) / (self._times[after] - before_s)
        a, b = before, self._rates[after]
        then: Rate = (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]))
        return _turned(self._orientations[after - 1], before, then, time_s - before_s)

    def _forget(self, count: int) -> None:
        del self._times[:count], self._rates[:count], self._orientations[:count]


def _turned(orientation: Quaternion, first: Rate, last: Rate, seconds: float) -> Quaternion:
    """Turned on for so long at the mean of two rates; of length 1."""
    half = [seconds * (a + b) / 4 for a, b in zip(first, last)]  # of the rotation vector
    angle = math.sqrt(half[0] ** 2 + half[1] ** 2 + half[2] ** 2)
    scale = math.sin(angle) / angle if angle > 0 else 1.0
    x, y, z, w = half[0] * scale, half[1] * scale, half[2] * scale, math.cos(angle)
    i, j, k, r = orientation
    turned = (r * x + i * w + j * z - k * y, r * y - i * z + j * w + k * x, r * z + i * y - j * x + k * w, r * w - i * x - j * y - k * z)
    length = math.sqrt(turned[0] ** 2 + turned[1] ** 2 + turned[2] ** 2 + turned[3] ** 2)
    return (turned[0] / length, turned[1] / length, turned[2] / length, turned[3] / length)
