#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Open3D's VoxelBlockGrid and OpenCV's HashTSDF against ovimap's map: the same frames, voxel size and truncation, frame by frame in turn.

Usage: open3d_fusion.py FUSION_STEPS RECORDING [--frames N] [--json]
Needs open3d, cv2 and numpy. Prints medians and ratios, and how far apart both surfaces are: speed counts only when they
are the same surface.
"""
import argparse
import json
import pathlib
import statistics
import tempfile
import time

import numpy
import open3d
import open3d.core as core
from opencv_fusion import OpenCv
from ours import MAX_RANGE_M, Ours

VOXEL_M, TRUNCATION_VOXELS = 0.01, 5.0


class Theirs:
    """As Open3D's own tutorial on dense reconstruction uses it."""

    def __init__(self):
        self.device = core.Device("CPU:0")
        self.grid = open3d.t.geometry.VoxelBlockGrid(
            ("tsdf", "weight", "color"), (core.float32, core.float32, core.float32), ((1), (1), (3)),
            VOXEL_M, 16, 20000, self.device)

    def load(self, ours):
        width, height, fx, fy, cx, cy = ours.raw("camera", numpy.float64)
        self.size = (int(width), int(height))
        shape = (self.size[1], self.size[0])
        self.intrinsic = core.Tensor([[fx, 0, cx], [0, fy, cy], [0, 0, 1]], core.float64)
        pose = ours.raw("pose", numpy.float64).reshape(4, 4)
        self.extrinsic = core.Tensor(numpy.ascontiguousarray(numpy.linalg.inv(pose)))
        depth = ours.raw("depth", numpy.float32).reshape(*shape, 1)
        color = ours.raw("color", numpy.uint8).reshape(*shape, 3).astype(numpy.float32) / 255
        self.depth = open3d.t.geometry.Image(core.Tensor(depth))
        self.color = open3d.t.geometry.Image(core.Tensor(numpy.ascontiguousarray(color)))

    def fuse(self):
        start = time.perf_counter()
        self.blocks = self.grid.compute_unique_block_coordinates(
            self.depth, self.intrinsic, self.extrinsic, 1.0, MAX_RANGE_M, TRUNCATION_VOXELS)
        self.grid.integrate(self.blocks, self.depth, self.color, self.intrinsic, self.extrinsic, 1.0, MAX_RANGE_M,
                            TRUNCATION_VOXELS)
        return 1e3 * (time.perf_counter() - start)

    def cast(self):
        start = time.perf_counter()
        self.grid.ray_cast(self.blocks, self.intrinsic, self.extrinsic, *self.size, ["depth", "index"],
                           1.0, 0.1, MAX_RANGE_M, 1.0, TRUNCATION_VOXELS, 8)
        return 1e3 * (time.perf_counter() - start)

    def mesh(self):
        return self.grid.extract_triangle_mesh(weight_threshold=1.0)


def surface_gap(mesh, other):
    """Distances in metres from points on `mesh` to the surface of `other`: median and 95th percentile."""
    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(other)
    points = mesh.to_legacy().sample_points_uniformly(50000)
    distances = scene.compute_distance(core.Tensor(numpy.asarray(points.points), core.float32)).numpy()
    return float(numpy.median(distances)), float(numpy.percentile(distances, 95))


def measure(program, recording, frames):
    times = {name: [] for name in ("ours_segment", "ours_fuse", "ours_guided", "ours_cast", "theirs_fuse", "theirs_cast", "opencv_fuse", "opencv_cast")}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        ours, theirs, opencv = Ours(program, recording, folder), Theirs(), OpenCv(VOXEL_M, TRUNCATION_VOXELS)
        for position in range(min(frames, ours.frames)):
            times["ours_segment"].append(ours.do("load", position))
            theirs.load(ours)
            opencv.load(ours)
            times["ours_fuse"].append(ours.do("fuse"))
            times["theirs_fuse"].append(theirs.fuse())
            times["opencv_fuse"].append(opencv.fuse())
            times["ours_cast"].append(ours.do("cast"))
            times["theirs_cast"].append(theirs.cast())
            times["opencv_cast"].append(opencv.cast())
            times["ours_guided"].append(ours.do("guided"))
        mesh_file = folder / "mesh.ply"
        ours.do("mesh", mesh_file)
        mine = open3d.t.io.read_triangle_mesh(str(mesh_file))
        other = theirs.mesh().to(core.Device("CPU:0"))
        gaps = [surface_gap(mine, other), surface_gap(other, mine)]
    skip = len(times["ours_fuse"]) // 10  # the first frames find an empty map
    result = {name: statistics.median(values[skip:]) for name, values in times.items()}
    result.update({"fuse_ratio": result["ours_fuse"] / result["theirs_fuse"],
                   "cast_ratio": result["ours_cast"] / result["theirs_cast"],
                   "guided_ratio": result["ours_guided"] / result["theirs_cast"],
                   "gap_median_mm": 1e3 * max(gap[0] for gap in gaps), "gap_p95_mm": 1e3 * max(gap[1] for gap in gaps),
                   "frames": len(times["ours_fuse"]), "open3d": open3d.__version__,
                   "opencv": OpenCv.VERSION, "opencv_error_mm": statistics.median(opencv.errors_mm)})
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=200)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    result = measure(arguments.program, arguments.recording, arguments.frames)
    if arguments.json:
        print(json.dumps(result, indent=2))
        return
    print(f"{result['frames']} frames, Open3D {result['open3d']}, medians in ms")
    print(f"fuse     ours {result['ours_fuse']:.1f}, theirs {result['theirs_fuse']:.1f}: {result['fuse_ratio']:.2f}x")
    print(f"ray cast ours {result['ours_cast']:.1f}, theirs {result['theirs_cast']:.1f}: {result['cast_ratio']:.2f}x")
    print(f"  guided ours {result['ours_guided']:.1f}: {result['guided_ratio']:.2f}x")
    print(f"OpenCV {result['opencv']}: fuse {result['opencv_fuse']:.1f}, ray cast {result['opencv_cast']:.1f}, "
          f"{result['opencv_error_mm']:.1f} mm from the depth images in the median")
    print(f"surfaces apart: median {result['gap_median_mm']:.1f} mm, 95 % {result['gap_p95_mm']:.1f} mm")


if __name__ == "__main__":
    main()
