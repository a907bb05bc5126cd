# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""An object as a few convex parts, which together are much closer to it than its convex hull."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import vhacdx

from .scene import Points, SceneObject, hull_corners

MOST_VOXELS = 100_000  # that an object is cut in; parts are thickened anyway
STEPS = 100  # of a grid along the longest side, in whose cells vertices become one


def convex_parts(thing: SceneObject, most: int) -> list[Points]:
    """[at most 256, 3] the corners of each part, at most so many: convex hulls of what lies together, thickened as hull_corners
    does. By V-HACD (Mamou 2016, version 4), which fills what is closed and takes an open surface for a thin one."""
    vertices, triangles = coarser(thing.vertices, thing.triangles, float(thing.size.max()) / STEPS)
    faces = np.column_stack([np.full(len(triangles), 3), triangles]).astype(np.uint32).ravel()
    found = vhacdx.compute_vhacd(vertices.astype(np.float64), faces, maxConvexHulls=most, resolution=MOST_VOXELS) if len(triangles) else []
    return [hull_corners(np.asarray(points, dtype=np.float32)) for points, _ in found] or [thing.hull]


def coarser(vertices: Points, triangles: npt.NDArray[np.uint32], cell_m: float) -> tuple[Points, npt.NDArray[np.uint32]]:
    """The surface with one vertex for all in a cell, their mean, and without the triangles that this leaves without area
    (Rossignac and Borrel 1993)."""
    _, cell, count = np.unique(np.floor(vertices / cell_m).astype(np.int64), axis=0, return_inverse=True, return_counts=True)
    cell = cell.ravel()
    sums = np.stack([np.bincount(cell, weights=vertices[:, axis]) for axis in range(3)], axis=1)
    kept = cell[triangles]
    a, b, c = kept.T
    return (sums / count[:, None]).astype(np.float32), kept[(a != b) & (b != c) & (c != a)].astype(np.uint32)
