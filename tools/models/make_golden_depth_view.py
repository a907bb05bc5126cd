#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Makes src/ovimap/inference/testdata/golden_depth_view.txt: a small image of inverse depth with slopes, steps and holes, and what the
finder is told of it when it is trained (depth_geometry.py)."""

import pathlib

import numpy as np
from depth_geometry import geometry

FILE = pathlib.Path(__file__).resolve().parents[2] / "src/ovimap/inference/testdata/golden_depth_view.txt"
ROWS, COLUMNS, FOCAL = 12, 16, 15.0


def inverse_depth():
    random = np.random.default_rng(1)
    across, down = np.meshgrid(np.arange(COLUMNS), np.arange(ROWS))
    inverse = np.exp(-0.03 * across + 0.05 * down) / 2 * (1 + 0.01 * random.normal(size=across.shape))
    inverse[2:7, 5:9] *= 2.5  # something in front
    inverse[random.random(inverse.shape) < 0.15] = 0
    return inverse.astype(np.float32)


def text():
    """Rows, columns and focal length in pixels; inverse depth, 1/m, 0 where there is none; the four maps."""
    inverse = inverse_depth()
    values = np.concatenate([inverse[None], geometry(inverse, FOCAL)]).reshape(-1, COLUMNS)
    return "\n".join([f"{ROWS} {COLUMNS} {FOCAL:g}", *(" ".join(f"{value:.6g}" for value in row) for row in values), ""])


if __name__ == "__main__":
    FILE.write_text(text())
