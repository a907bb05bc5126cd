# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Depth cameras and their makers' recordings: one file for each maker's library, and what sends their images on (docs/cameras.md)."""

from __future__ import annotations

from .camera import Camera, CameraLost, Feed, Image, TurnRate, Wanted
from .relay import Relay

__all__ = ["Camera", "CameraLost", "Feed", "Image", "Relay", "TurnRate", "Wanted", "open_camera"]

MAKERS = ("realsense", "oak", "orbbec", "openni")


def open_camera(maker: str, wanted: Wanted) -> Camera:
    """The camera of one of MAKERS that is plugged in, or its recording.

    Raises Error where there is none, several fit, or it cannot do what is wanted; ModuleNotFoundError without the maker's library."""
    if maker == "realsense":
        from .realsense import open_realsense

        return open_realsense(wanted)
    if maker == "oak":
        from .oak import open_oak

        return open_oak(wanted)
    if maker == "openni":
        from .openni import open_openni

        return open_openni(wanted)
    from .orbbec import open_orbbec

    return open_orbbec(wanted)
