#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Open3D's RGB-D odometry and its dense SLAM on the frames of a recording: poses as TUM lines, and what a frame takes.

Usage: open3d_odometry.py FUSION_STEPS RECORDING --method odometry|slam -o TRAJECTORY [--step N] [--fps FPS] [--json]
Needs open3d and numpy. ovimap decodes the frames and brings colour to the depth, so both sides see the same. The time
of frame N is N / FPS.
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
from open3d_fusion import MAX_RANGE_M, TRUNCATION_VOXELS, VOXEL_M, Ours

DEPTH_SCALE = 1000.0  # units per metre


class Recording:
    """Frames of a recording as Open3D's images."""

    def __init__(self, ours):
        self.ours = ours

    def load(self, position):
        self.ours.do("load", position)
        width, height, fx, fy, cx, cy = self.ours.raw("camera", numpy.float64)
        shape = (int(height), int(width))
        self.intrinsic = core.Tensor([[fx, 0, cx], [0, fy, cy], [0, 0, 1]], core.float64)
        metres = self.ours.raw("depth", numpy.float32).reshape(*shape, 1)
        depth = numpy.rint(metres * DEPTH_SCALE).astype(numpy.uint16)  # as cameras store it, which their SLAM demands
        color = self.ours.raw("color", numpy.uint8).reshape(*shape, 3)
        return open3d.t.geometry.RGBDImage(open3d.t.geometry.Image(core.Tensor(numpy.ascontiguousarray(color))),
                                           open3d.t.geometry.Image(core.Tensor(numpy.ascontiguousarray(depth))))


class Odometry:
    """From frame to frame: the hybrid of point to plane and intensity, as their documentation recommends."""

    def __init__(self):
        self.last, self.pose = None, numpy.eye(4)

    def track(self, image, intrinsic):
        if self.last is not None:
            criteria = [open3d.t.pipelines.odometry.OdometryConvergenceCriteria(n) for n in (10, 5, 3)]
            found = open3d.t.pipelines.odometry.rgbd_odometry_multi_scale(
                image, self.last, intrinsic, core.Tensor(numpy.eye(4)), DEPTH_SCALE, MAX_RANGE_M, criteria,
                open3d.t.pipelines.odometry.Method.Hybrid)
            self.pose = self.pose @ found.transformation.numpy()
        self.last = image
        return self.pose


class Slam:
    """Their dense SLAM: from frame to model, as in their example dense_slam.py."""

    def __init__(self):
        self.model, self.pose, self.count = None, core.Tensor(numpy.eye(4)), 0

    def track(self, image, intrinsic):
        slam = open3d.t.pipelines.slam
        rows, columns = image.depth.rows, image.depth.columns
        if self.model is None:
            self.model = slam.Model(VOXEL_M, 16, 20000, core.Tensor(numpy.eye(4)), core.Device("CPU:0"))
            self.seen, self.cast = (slam.Frame(rows, columns, intrinsic, core.Device("CPU:0")) for _ in range(2))
        self.seen.set_data_from_image("depth", image.depth)
        self.seen.set_data_from_image("color", image.color)
        if self.count > 0:
            found = self.model.track_frame_to_model(self.seen, self.cast, DEPTH_SCALE, MAX_RANGE_M, 0.07)
            self.pose = self.pose @ found.transformation
        self.model.update_frame_pose(self.count, self.pose)
        self.model.integrate(self.seen, DEPTH_SCALE, MAX_RANGE_M, TRUNCATION_VOXELS)
        self.model.synthesize_model_frame(self.cast, DEPTH_SCALE, 0.1, MAX_RANGE_M, TRUNCATION_VOXELS, False)
        self.count += 1
        return self.pose.numpy()


def quaternion(rotation):
    """x y z w, by the eigenvector of Bar-Itzhack's matrix: good for every angle."""
    r = rotation
    k = numpy.array([[r[0, 0] - r[1, 1] - r[2, 2], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0], r[2, 1] - r[1, 2]],
                     [r[0, 1] + r[1, 0], r[1, 1] - r[0, 0] - r[2, 2], r[1, 2] + r[2, 1], r[0, 2] - r[2, 0]],
                     [r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], r[2, 2] - r[0, 0] - r[1, 1], r[1, 0] - r[0, 1]],
                     [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], r[0, 0] + r[1, 1] + r[2, 2]]]) / 3
    return numpy.linalg.eigh(k)[1][:, -1]


def tum_line(time_s, pose):
    return " ".join([f"{time_s:.6f}", *(f"{value:.7f}" for value in [*pose[:3, 3], *quaternion(pose[:3, :3])])])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("--method", choices=["odometry", "slam"], default="odometry")
    parser.add_argument("--step", type=int, default=1)
    parser.add_argument("--fps", type=float, default=30)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    open3d.utility.set_verbosity_level(open3d.utility.VerbosityLevel.Error)  # warnings go to stdout, where the result goes
    tracker, lines, times, failed = (Odometry if arguments.method == "odometry" else Slam)(), [], [], 0
    with tempfile.TemporaryDirectory() as folder:
        ours = Ours(arguments.program, arguments.recording, pathlib.Path(folder))
        recording = Recording(ours)
        for position in range(0, ours.frames, arguments.step):
            image = recording.load(position)
            start = time.perf_counter()
            try:
                pose = tracker.track(image, recording.intrinsic)
            except RuntimeError:  # theirs throws where it finds no motion
                failed += 1
                continue
            times.append(1e3 * (time.perf_counter() - start))
            lines.append(tum_line(position / arguments.fps, pose))
    arguments.output.write_text("\n".join(lines) + "\n")
    result = {"frames": len(lines), "failed": failed, "p50_ms": statistics.median(times or [0.0]), "open3d": open3d.__version__}
    print(json.dumps(result) if arguments.json else result)


if __name__ == "__main__":
    main()
