#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""How much closer to objects convex parts are than convex hulls (docs/export.md).

Usage: bench/scene_shapes.py MAP [ID...]
Prints of each object, or of those, the volume of its hull and of its parts, and how far from what was seen of it the surface of
either is. Needs the package with its optional group scene, and scipy.
"""
import argparse
import time

import numpy as np
from ovimap.scene import read_scene
from ovimap.scene.parts import convex_parts
from scipy.spatial import ConvexHull, cKDTree

PARTS = 32
SAMPLES = 20000


def surface_of(hulls, random):
    """Points spread evenly over the surfaces of hulls, but for those that lie in another one."""
    corners = np.concatenate([hull.points[hull.simplices] for hull in hulls])
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(sides, axis=1)
    chosen = random.choice(len(corners), SAMPLES, p=areas / areas.sum())
    a, b = np.sort(random.random((2, SAMPLES)), axis=0)
    points = (corners[chosen] * np.stack([a, b - a, 1 - b], axis=1)[:, :, None]).sum(axis=1)
    buried = np.any([(points @ hull.equations[:, :3].T + hull.equations[:, 3] < -1e-4).all(axis=1) for hull in hulls], axis=0)
    return points[~buried]


def describe(shapes, tree, random):
    hulls = [ConvexHull(corners.astype(float)) for corners in shapes]
    away, _ = tree.query(surface_of(hulls, random))
    return f"{sum(hull.volume for hull in hulls):.4f} m3, {away.mean() * 1e3:.0f} mm away, 95 % {np.quantile(away, 0.95) * 1e3:.0f} mm"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("map")
    parser.add_argument("ids", nargs="*", type=int)
    options = parser.parse_args()
    random = np.random.default_rng(1)
    for thing in read_scene(options.map).objects:
        if options.ids and thing.id not in options.ids:
            continue
        begin = time.perf_counter()
        parts = convex_parts(thing, PARTS)
        spent_s = time.perf_counter() - begin
        tree = cKDTree(thing.vertices)
        print(f"{thing.key}: hull {describe([thing.hull], tree, random)}; {len(parts)} parts in {spent_s:.1f} s {describe(parts, tree, random)}")


if __name__ == "__main__":
    main()
