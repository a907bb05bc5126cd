#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What other trackers make of the frames of a recording: poses as TUM lines, and what a frame takes.

Usage: odometry.py FUSION_STEPS RECORDING --method METHOD -o TRAJECTORY [--step N] [--fps FPS] [--json]
Needs what the method is of (`make rivals`) and numpy. The time of frame N is N / FPS.
"""
import argparse
import importlib
import json
import pathlib
import statistics
import tempfile
import time

import numpy
from ours import Ours

METHODS = {"open3d-odometry": ("open3d_odometry", "Odometry"), "open3d-slam": ("open3d_odometry", "Slam"),
           "opencv-odometry": ("opencv_odometry", "Odometry")}


def frame_of(ours, position):
    """Depth in metres (0: none), colour, and the camera's matrix."""
    ours.do("load", position)
    width, height, fx, fy, cx, cy = ours.raw("camera", numpy.float64)
    shape = (int(height), int(width))
    camera = numpy.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
    return ours.raw("depth", numpy.float32).reshape(shape), ours.raw("color", numpy.uint8).reshape(*shape, 3), camera


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
    parser.add_argument("--method", choices=METHODS, default="open3d-odometry")
    parser.add_argument("--step", type=int, default=1)
    parser.add_argument("--fps", type=float, default=30)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    module, kind = METHODS[arguments.method]
    rival = importlib.import_module(module)
    tracker, lines, times, failed = getattr(rival, kind)(), [], [], 0
    with tempfile.TemporaryDirectory() as folder:
        ours = Ours(arguments.program, arguments.recording, pathlib.Path(folder))
        for position in range(0, ours.frames, arguments.step):
            frame = rival.prepared(*frame_of(ours, position))
            start = time.perf_counter()
            try:
                pose = tracker.track(*frame)
            except RuntimeError:  # theirs throws where it finds no motion
                failed += 1
                continue
            times.append(1e3 * (time.perf_counter() - start))
            lines.append(tum_line(position / arguments.fps, pose))
    arguments.output.write_text("\n".join(lines) + "\n")
    result = {"frames": len(lines), "failed": failed, "p50_ms": statistics.median(times or [0.0]), "version": rival.VERSION}
    print(json.dumps(result) if arguments.json else result)


if __name__ == "__main__":
    main()
