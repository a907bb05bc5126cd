# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Lenses as camera files have them: {"model": "brown_conrady", "coefficients": [k1, k2, p1, p2, k3]}, also with k4, k5 and k6,
or "kannala_brandt" with k1 to k4. The formulas are OpenCV's (docs/sources.md)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

LEAST = 1e-9  # smaller coefficients bend nothing


def distortion_of(model: str, coefficients: Sequence[float]) -> dict[str, Any]:
    """The key of a camera; empty for a lens that bends nothing. model: "brown_conrady" or "kannala_brandt"."""
    numbers = [float(value) for value in coefficients]
    if model == "brown_conrady" and max(map(abs, numbers), default=0.0) < LEAST:
        return {}
    return {"distortion": {"model": model, "coefficients": numbers}}


def fitted_brown_conrady(rays: npt.NDArray[np.float64], bent: npt.NDArray[np.float64]) -> tuple[list[float], float]:
    """The five coefficients that take straight rays [n, 2] (x/z, y/z) best to where a lens bends them, and the largest error in the same
    unit. The formula is linear in them: least squares."""
    x, y = rays[:, 0], rays[:, 1]
    r2 = x * x + y * y
    columns_x = [x * r2, x * r2**2, 2 * x * y, r2 + 2 * x * x, x * r2**3]
    columns_y = [y * r2, y * r2**2, r2 + 2 * y * y, 2 * x * y, y * r2**3]
    matrix = np.concatenate([np.stack(columns_x, 1), np.stack(columns_y, 1)])
    wanted = (bent - rays).T.reshape(-1)
    coefficients = np.linalg.lstsq(matrix, wanted, rcond=None)[0]
    error = (matrix @ coefficients - wanted).reshape(2, -1)
    return coefficients.tolist(), float(np.hypot(*error).max())
