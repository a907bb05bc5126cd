# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What all exporters need: the scene graph of a map, and the surface of each object."""

from __future__ import annotations

import json
import os
import re
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .._ovimap import Map

Points = npt.NDArray[np.float32]
SHELL_HOLDS = 3  # objects whose middle lies in another one's hull: that one is a wall around them
DIRECTIONS = 256


@dataclass(frozen=True)
class SceneObject:
    """An object and its surface. Metres, in a frame whose z is up and whose floor is at z = 0."""

    id: int
    title: str
    room: int  # 0: none
    center: Points  # [3], of its box
    size: Points  # [3]
    vertices: Points  # [vertices, 3]
    triangles: npt.NDArray[np.uint32]  # [triangles, 3]
    colors: npt.NDArray[np.uint8]  # [vertices, 3], or none
    hull: Points  # [at most 256, 3] corners of its convex hull
    is_shell: bool  # its hull holds other things: a wall, a floor, a ceiling
    parts: list[tuple[Points, Points]]  # centre and size [3] of the boxes around its recognised parts

    @property
    def key(self) -> str:
        """A name of letters, digits and underscores, of this object alone."""
        return f"{re.sub('[^A-Za-z0-9]+', '_', self.title).strip('_') or 'object'}_{self.id}"


@dataclass(frozen=True)
class Scene:
    """A map, its z axis up and its floor at z = 0."""

    graph: dict[str, Any]  # docs/export.md, "Scene graph"
    objects: list[SceneObject]
    up_from_world: npt.NDArray[np.float64]  # [4, 4], what was done to get there

    def position(self, point: list[float]) -> Points:
        """A point of the graph, [3], in this scene's frame."""
        return np.asarray((self.up_from_world @ np.array([*point, 1.0]))[:3], dtype=np.float32)


def read_scene(path: str | os.PathLike[str]) -> Scene:
    """Reads a map file with its surface. Raises Error for what is no map, or has no surface."""
    opened = Map.open(path)
    graph = json.loads(opened.scene_graph())
    up_from_world = np.eye(4)
    up_from_world[:3, :3] = np.array(graph["grid_from_world"]).reshape(3, 3)
    up_from_world[2, 3] = -graph["floor_m"]
    mesh = opened.mesh()
    vertices = (mesh.vertices @ up_from_world[:3, :3].T + up_from_world[:3, 3]).astype(np.float32)
    labels, triangles = np.asarray(mesh.labels), np.asarray(mesh.triangles)
    # A triangle belongs to the object that its first corner is of: borders are closed, each once.
    owner = labels[triangles[:, 0]] if len(triangles) else np.empty(0, np.uint32)
    surfaces = {said["id"]: _surface(vertices, np.asarray(mesh.colors), triangles[owner == said["id"]]) for said in graph["objects"]}
    hulls = {id: hull_corners(surface[0]) for id, surface in surfaces.items() if len(surface[0])}
    middles = np.array([surfaces[id][0].mean(axis=0) for id in hulls])
    objects = []
    for said in graph["objects"]:
        if said["id"] not in hulls:
            continue
        points, faces, colors = surfaces[said["id"]]
        low, high = points.min(axis=0), points.max(axis=0)
        hull = hulls[said["id"]]
        holds = int(inside_hull(hull, middles).sum()) - 1  # itself
        objects.append(SceneObject(said["id"], said["title"], said["room"], (low + high) / 2, high - low, points, faces, colors, hull, holds >= SHELL_HOLDS, _part_boxes(said["parts"], up_from_world)))
    return Scene(graph, objects, up_from_world)


def hull_corners(points: Points, margin_m: float = 0.005) -> Points:
    """[at most 256, 3] the points that lie furthest in evenly spread directions: the corners of the convex hull, but for such as
    stick out by next to nothing. Everything is thickened by a margin, so that a sheet of paper has a volume."""
    furthest = points[np.unique(np.argmax(points @ _directions().T, axis=0))]
    steps = margin_m * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], np.float32)
    thick = (furthest[:, None] + steps).reshape(-1, 3)
    return np.asarray(thick[np.unique(np.argmax(thick @ _directions().T, axis=0))], dtype=np.float32)


def inside_hull(hull: Points, points: Points) -> npt.NDArray[np.bool_]:
    """[points] whether each lies in the convex hull, as far as the directions tell."""
    reach = (hull @ _directions().T).max(axis=0)
    return np.asarray((points @ _directions().T <= reach + 1e-6).all(axis=1))


def _part_boxes(parts: list[dict[str, Any]], up_from_world: npt.NDArray[np.float64]) -> list[tuple[Points, Points]]:
    """The boxes of the map's axes, boxed anew where those of the scene are others."""
    boxes = []
    for part in parts:
        ends = np.array([part["box"]["min"], part["box"]["max"]])
        corners = np.array([[x, y, z] for x in ends[:, 0] for y in ends[:, 1] for z in ends[:, 2]])
        turned = corners @ up_from_world[:3, :3].T + up_from_world[:3, 3]
        low, high = turned.min(axis=0).astype(np.float32), turned.max(axis=0).astype(np.float32)
        boxes.append(((low + high) / 2, high - low))
    return boxes


def _directions() -> npt.NDArray[np.float32]:
    """[256, 3] unit vectors, spread by the golden angle."""
    z = 1 - (2 * np.arange(DIRECTIONS) + 1) / DIRECTIONS
    turn = np.pi * (1 + 5**0.5) * np.arange(DIRECTIONS)
    level = np.sqrt(1 - z * z)
    return np.stack([level * np.cos(turn), level * np.sin(turn), z], axis=1).astype(np.float32)


def _surface(vertices: Points, colors: npt.NDArray[np.uint8], triangles: npt.NDArray[np.uint32]) -> tuple[Points, npt.NDArray[np.uint32], npt.NDArray[np.uint8]]:
    """The triangles with the vertices that they use alone."""
    used, faces = np.unique(triangles, return_inverse=True)
    return vertices[used], faces.reshape(-1, 3).astype(np.uint32), colors[used] if len(colors) else colors
