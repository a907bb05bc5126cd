# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A map as a MuJoCo model: a body for each object, which is its convex hull or a few convex parts."""

from __future__ import annotations

import os
import pathlib
import xml.etree.ElementTree as ET

import numpy as np

from .scene import Points, Scene, SceneObject

LARGEST_FREE_M = 0.6  # what is longer stays where it is
DENSITY = 300.0  # kg/m3 of the hull: things are hollow


def write_mjcf(scene: Scene, path: str | os.PathLike[str], parts: int = 0) -> list[str]:
    """Writes MJCF. Small things that stand on others can move; the rest is fixed, on a floor at z = 0. Walls, floors and
    ceilings (SceneObject.is_shell) have no hull that would leave the room free; the keys of those left out are returned.
    Recognised parts of objects are sites. parts: into how many convex parts an object is cut at most, for which nothing is left out; 0: it is its hull."""
    root = ET.Element("mujoco", model="map")
    ET.SubElement(root, "compiler", angle="radian", inertiafromgeom="true")
    assets, world = ET.SubElement(root, "asset"), ET.SubElement(root, "worldbody")
    ET.SubElement(world, "geom", name="floor", type="plane", size="0 0 0.1")
    stand = {said["object"] for said in scene.graph["relations"] if said["relation"] == "on"}
    left_out = []
    for thing in scene.objects:
        if thing.is_shell and not parts:
            left_out.append(thing.key)
            continue
        body = ET.SubElement(world, "body", name=thing.key, pos=_numbers(thing.center))
        if thing.id in stand and thing.size.max() <= LARGEST_FREE_M:
            ET.SubElement(body, "freejoint")
        color = thing.colors.mean(axis=0) / 255 if len(thing.colors) else [0.5, 0.5, 0.5]
        rgba = " ".join(f"{channel:.3f}" for channel in color) + " 1"
        for name, corners in _shapes(thing, parts):
            ET.SubElement(assets, "mesh", name=name, vertex=_numbers(corners - thing.center))
            ET.SubElement(body, "geom", type="mesh", mesh=name, density=str(DENSITY), rgba=rgba)
        for number, (center, size) in enumerate(thing.parts, 1):
            ET.SubElement(body, "site", name=f"{thing.key}_known_part_{number}", type="box", pos=_numbers(center - thing.center), size=_numbers(size / np.float32(2)))
    ET.indent(root)
    pathlib.Path(path).write_text(ET.tostring(root, encoding="unicode") + "\n", encoding="utf-8")
    return left_out


def _shapes(thing: SceneObject, parts: int) -> list[tuple[str, Points]]:
    """Names and corners of what it consists of."""
    if not parts:
        return [(thing.key, thing.hull)]
    from .parts import convex_parts

    return [(f"{thing.key}_part_{number}", corners) for number, corners in enumerate(convex_parts(thing, parts))]


def _numbers(values: Points) -> str:
    return " ".join(f"{value:.4f}" for value in values.ravel())
