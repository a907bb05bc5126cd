# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The command ovimap-scene: a map as USD, as a MuJoCo model or as a scene graph of spark-dsg (docs/export.md)."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

from ._ovimap import Error
from .command_line import DONE, run_command

if TYPE_CHECKING:
    from .scene import Scene

MOST_PARTS = 256
ENDINGS = ".usda, .usdc, .usd (USD), .xml (MJCF), .json or .sparkdsg (spark-dsg)"


def main(arguments: list[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    return run_command("ovimap-scene", _parser().parse_args(arguments), extra="scene", packages=("pxr", "spark_dsg", "vhacdx"))


def _write(options: argparse.Namespace) -> int:
    write = _writer(options.out)
    from .scene import read_scene

    scene = read_scene(options.map)
    left_out = write(scene, options.out, options.parts)
    print(f"{options.out}: {len(scene.objects) - len(left_out)} objects, rooms: {', '.join(room['name'] for room in scene.graph['rooms']) or 'none'}")
    if left_out:
        print(f"left out, since they are around other things: {', '.join(left_out)}")
    return DONE


def _writer(out: str) -> Callable[[Scene, str, int], Collection[str]]:
    """What writes such a file; it returns the objects that it left out."""
    ending = os.path.splitext(out)[1]
    if ending in (".usda", ".usdc", ".usd"):
        from .scene.usd import write_usd

        return write_usd
    if ending in (".json", ".sparkdsg"):
        from .scene.spark import write_spark

        return write_spark
    if ending == ".xml":
        from .scene.mjcf import write_mjcf

        return write_mjcf
    raise Error(f"cannot write '{out}'; the name must end in {ENDINGS}")


def _count(text: str) -> int:
    value = int(text)
    if not 1 <= value <= MOST_PARTS:
        raise argparse.ArgumentTypeError(f"{text} is not from 1 to {MOST_PARTS} parts")
    return value


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="ovimap-scene", description="Writes a map for simulators and scene graph tools.")
    parser.add_argument("map", metavar="MAP", help="map file")
    parser.add_argument("out", metavar="OUT", help=f"file to write: {ENDINGS}")
    parser.add_argument("--parts", type=_count, default=0, metavar="N",
                        help="cut each object into so many convex parts at most, instead of taking its convex hull (MJCF; USD: simulators choose how many)")  # fmt: skip
    parser.set_defaults(command=_write)
    return parser


if __name__ == "__main__":
    raise SystemExit(main())
