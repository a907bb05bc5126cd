#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The surface that Open3D's VoxelBlockGrid makes of a recording, at our voxel size, truncation and range.

Usage: open3d_surface.py FUSION_STEPS RECORDING OUT [--weights 1 3 10]
Needs open3d and numpy. Writes OUT/weight-W.ply for each weight below which a voxel shows no surface; Open3D's own default is 3.
`ovimap eval OUT/weight-W.ply --gt RECORDING` scores it.
"""
import argparse
import pathlib
import tempfile

import open3d
import open3d.core as core

from open3d_fusion import Theirs
from ours import Ours


def fuse(program, recording):
    with tempfile.TemporaryDirectory() as folder:
        ours, theirs = Ours(program, recording, pathlib.Path(folder)), Theirs()
        for position in range(ours.frames):
            ours.do("load", position)
            theirs.load(ours)
            theirs.fuse()
    return theirs.grid


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--weights", type=float, nargs="+", default=[3.0])
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    grid = fuse(arguments.program, arguments.recording)
    for weight in arguments.weights:
        mesh = grid.extract_triangle_mesh(weight_threshold=weight).to(core.Device("CPU:0"))
        open3d.t.io.write_triangle_mesh(str(arguments.out / f"weight-{weight:g}.ply"), mesh)


if __name__ == "__main__":
    main()
