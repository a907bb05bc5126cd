# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The occupancy grid that `ovimap export MAP room.yaml` writes (docs/export.md), as cells."""

from __future__ import annotations

import pathlib
import subprocess
import tempfile
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from ruamel.yaml import YAML

from .._ovimap import Error, decode_gray_png
from ..command_line import find_program

OCCUPIED, FREE, UNKNOWN = 100, 0, -1  # of nav_msgs/OccupancyGrid
BLACK, WHITE = 0, 250  # what map_server's picture has for them; anything between is unknown


@dataclass
class Grid:
    """cells: int8 [rows, columns], the first row with the smallest y; origin: x and y of its corner in the grid's frame, metres.

    world_from_grid: [3, 3], which turns the grid's z, that points up, into the map's world."""

    cells: npt.NDArray[np.int8]
    cell_m: float
    origin: tuple[float, float]
    floor_m: float
    world_from_grid: npt.NDArray[np.float64]


def grid_of(map_file: pathlib.Path) -> Grid:
    """Raises Error with the program's line where the map has no voxels or no floor."""
    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder, "grid.yaml")
        done = subprocess.run([find_program(), "export", str(map_file), str(target)], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Error(next(iter(done.stderr.strip().splitlines()[::-1]), "the grid could not be exported"))
        return read_grid(target)


def read_grid(path: pathlib.Path) -> Grid:
    described = YAML(typ="safe").load(path)
    picture = decode_gray_png(path.with_name(described["image"]).read_bytes())[::-1]  # its first row has the largest y
    cells = np.full(picture.shape, UNKNOWN, np.int8)
    cells[picture == BLACK] = OCCUPIED
    cells[picture >= WHITE] = FREE
    turn = np.array(described.get("grid_from_world", np.eye(3).ravel()), np.float64).reshape(3, 3)
    x, y, _ = described["origin"]
    return Grid(cells, float(described["resolution"]), (float(x), float(y)), float(described.get("floor_m", 0)), turn.T)
