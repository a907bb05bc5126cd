# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Colour and depth images put together by the camera's clock, which may jump."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .camera import Image

MAX_GAP_S = 0.02  # colour and depth farther apart do not belong together
MAX_JUMP_S = 5.0  # a clock that goes ahead by more has been set
KEEP = 30  # images of a kind that wait for the other: a second
LONELY = 30  # depth images in a row without colour are worth a line
STEP_S = 1 / 30  # between the last frame before a clock was set and the first after it


@dataclass(frozen=True)
class Pair:
    color: npt.NDArray[np.uint8]
    depth: npt.NDArray[np.uint16]
    time_s: float  # of depth; grows from pair to pair
    clock_s: float  # of depth, by the camera's clock


class Pairing:
    """Gives depth the colour nearest in time. What has no partner is left out and counted.

    A clock that jumps begins a new era, within which images are compared; the times of pairs go on where they were."""

    def __init__(self, tell: Callable[[str], None]) -> None:
        self.left_out = 0
        self._tell = tell
        self._waiting: dict[str, list[tuple[int, Image]]] = {"color": [], "depth": []}  # with their eras
        self._era = {"color": 0, "depth": 0}
        self._last_s: dict[str, float] = {}
        self._sent_era, self._sent_s, self._shift_s = 0, 0.0, 0.0
        self._lonely = 0

    def add(self, image: Image) -> list[Pair]:
        """The pairs that are known by now, in order."""
        self._check_clock(image)
        waiting = self._waiting[image.kind]
        waiting.append((self._era[image.kind], image))
        self.left_out += image.kind == "depth" and len(waiting) > KEEP
        del waiting[:-KEEP]
        return self._pairs(wait=True)

    def rest(self) -> list[Pair]:
        """Those that were left, when no more images come."""
        pairs = self._pairs(wait=False)
        self._waiting["color"].clear()
        return pairs

    def _check_clock(self, image: Image) -> None:
        last_s = self._last_s.get(image.kind, image.time_s)
        self._last_s[image.kind] = image.time_s
        if last_s <= image.time_s <= last_s + MAX_JUMP_S:
            return
        self._era[image.kind] += 1
        if self._era[image.kind] == max(self._era.values()) and len(set(self._era.values())) > 1:  # the first to show it
            self._tell(f"the camera's clock jumped by {image.time_s - last_s:+.3f} s; the times of frames go on from the last one")

    def _pairs(self, *, wait: bool) -> list[Pair]:
        colors, pairs = self._waiting["color"], []
        newest = (colors[-1][0], colors[-1][1].time_s) if colors else (-1, 0.0)
        while self._waiting["depth"]:
            era, depth = self._waiting["depth"][0]
            if wait and newest < (era, depth.time_s):
                break
            del self._waiting["depth"][0]
            pair = self._pair(era, depth)
            if pair:
                pairs.append(pair)
        return pairs

    def _pair(self, era: int, depth: Image) -> Pair | None:
        near = [color for color_era, color in self._waiting["color"] if color_era == era]
        color = min(near, key=lambda image: abs(image.time_s - depth.time_s), default=None)
        if color is None or abs(color.time_s - depth.time_s) > MAX_GAP_S:
            self._leave_out(depth, color)
            return None
        self._lonely = 0
        if era != self._sent_era:
            self._sent_era, self._shift_s = era, self._sent_s + STEP_S - depth.time_s
        self._sent_s = depth.time_s + self._shift_s
        return Pair(color.pixels, depth.pixels, self._sent_s, depth.time_s)

    def _leave_out(self, depth: Image, color: Image | None) -> None:
        self.left_out += 1
        self._lonely += 1
        if self._lonely != LONELY:
            return
        nearest = f"the nearest is {abs(color.time_s - depth.time_s):.3f} s away" if color else "none comes"
        self._tell(f"{LONELY} depth images in a row have no colour image within {MAX_GAP_S:g} s ({nearest}); let both run at one rate and "
                   "by one clock")
