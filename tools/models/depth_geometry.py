# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What the entity finder is told of depth when it is trained; the program tells it the same (src/ovimap/inference/sam/depth_view.h)."""

import math

import numpy as np


def geometry(inverse, focal):
    """4 x rows x columns of what the finder is told of depth (depth_view.h): the logarithm of how large a pixel is, in metres, plus 5;
    how far to the right and down the surface slants, as half of its tangent; 1 where depth is known. `focal` in these pixels."""
    known = inverse > 0
    log = -np.log(np.where(known, inverse, 1)).astype(np.float32)

    def slant(axis):
        before, after = (np.roll(log, shift, axis) for shift in (1, -1))
        has_before, has_after = (np.roll(known, shift, axis) & known for shift in (1, -1))
        first, last = [slice(None)] * 2, [slice(None)] * 2
        first[axis], last[axis] = 0, -1
        has_before[tuple(first)] = has_after[tuple(last)] = False
        steps = (log - before) * has_before + (after - log) * has_after
        return np.clip(0.5 * focal * steps / np.maximum(1, has_before.astype(np.int8) + has_after), -2, 2)

    return np.stack([np.where(known, log - math.log(focal) + 5, 0), slant(1), slant(0), known]).astype(np.float32)
