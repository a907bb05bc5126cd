# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A map as a MuJoCo model: a body and a convex hull for each object."""

from __future__ import annotations

import os
import pathlib
import xml.etree.ElementTree as ET

from .scene import Points, Scene

LARGEST_FREE_M = 0.6  # what is longer stays where it is
DENSITY = 300.0  # kg/m3 of the hull: things are hollow


def write_mjcf(scene: Scene, path: str | os.PathLike[str]) -> list[str]:
    """Writes MJCF. Small things that stand on others can move; the rest is fixed, on a floor at z = 0. Walls, floors and
    ceilings (SceneObject.is_shell) have no hull that would leave the room free; the keys of those left out are returned."""
    root = ET.Element("mujoco", model="map")
    ET.SubElement(root, "compiler", angle="radian", inertiafromgeom="true")
    assets, world = ET.SubElement(root, "asset"), ET.SubElement(root, "worldbody")
    ET.SubElement(world, "geom", name="floor", type="plane", size="0 0 0.1")
    stand = {said["object"] for said in scene.graph["relations"] if said["relation"] == "on"}
    left_out = []
    for thing in scene.objects:
        if thing.is_shell:
            left_out.append(thing.key)
            continue
        ET.SubElement(assets, "mesh", name=thing.key, vertex=_numbers(thing.hull - thing.center))
        body = ET.SubElement(world, "body", name=thing.key, pos=_numbers(thing.center))
        if thing.id in stand and thing.size.max() <= LARGEST_FREE_M:
            ET.SubElement(body, "freejoint")
        color = thing.colors.mean(axis=0) / 255 if len(thing.colors) else [0.5, 0.5, 0.5]
        ET.SubElement(body, "geom", type="mesh", mesh=thing.key, density=str(DENSITY), rgba=" ".join(f"{part:.3f}" for part in color) + " 1")
    ET.indent(root)
    pathlib.Path(path).write_text(ET.tostring(root, encoding="unicode") + "\n", encoding="utf-8")
    return left_out


def _numbers(values: Points) -> str:
    return " ".join(f"{value:.4f}" for value in values.ravel())
