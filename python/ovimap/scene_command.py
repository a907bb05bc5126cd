# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The command ovimap-scene: a map as USD, as a MuJoCo model or as a scene graph of spark-dsg (docs/export.md)."""

from __future__ import annotations

import argparse
import os

from ._ovimap import Error
from .command_line import DONE, run_command

ENDINGS = ".usda, .usdc, .usd (USD), .xml (MJCF), .json or .sparkdsg (spark-dsg)"


def main(arguments: list[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    return run_command("ovimap-scene", _parser().parse_args(arguments), extra="scene", packages=("pxr", "spark_dsg"))


def _write(options: argparse.Namespace) -> int:
    from .scene import read_scene

    ending = os.path.splitext(options.out)[1]
    if ending in (".usda", ".usdc", ".usd"):
        from .scene.usd import write_usd as write
    elif ending in (".json", ".sparkdsg"):
        from .scene.spark import write_spark as write
    elif ending == ".xml":
        from .scene.mjcf import write_mjcf as write
    else:
        raise Error(f"cannot write '{options.out}'; the name must end in {ENDINGS}")
    scene = read_scene(options.map)
    left_out = write(scene, options.out) or []
    print(f"{options.out}: {len(scene.objects) - len(left_out)} objects in {len(scene.graph['rooms'])} rooms")
    if left_out:
        print(f"left out, since they are around other things: {', '.join(left_out)}")
    return DONE


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="ovimap-scene", description="Writes a map for simulators and scene graph tools.")
    parser.add_argument("map", metavar="MAP", help="map file")
    parser.add_argument("out", metavar="OUT", help=f"file to write: {ENDINGS}")
    parser.set_defaults(command=_write)
    return parser


if __name__ == "__main__":
    raise SystemExit(main())
