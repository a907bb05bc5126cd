#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Renders the places that train_head.py learns from beside the catalogue's pictures, and maps them with true instances:
OUT/NAME (the scene) and OUT/NAME.ovimap, which keeps the crops that a map shows an encoder. What is there already stays.
Rooms hold models of training_furniture.json, desks what is made by rule for the tuned half of the benchmarks: nothing that
is in a place which is held out.

    python3 tools/models/training_places.py build/release/bin/ovimap places        # a quarter of an hour on two cores
"""

import argparse
import pathlib
import subprocess

FURNITURE = pathlib.Path(__file__).with_name("training_furniture.json")
ROOMS, ROOM_SEEDS = ("office", "kitchen", "living-room", "bedroom", "bathroom"), (201, 202, 203, 204, 205, 206)
DESKS, DESK_SEEDS = ("writing-desk", "breakfast-table", "book-shelf"), (301, 302, 303, 304, 305)
OF_ROOMS = ("--noise", "--frames", "30", "--models", str(FURNITURE))
OF_DESKS = ("--fps", "1")
CROPS = ("--set", "crops.scales=2", "--set", "crops.kept_views=8")


def render(program, out, kind, seed, options):
    name = out / f"{kind}-{seed}"
    if not name.is_dir():
        subprocess.run([program, "synth", name, "--room", kind, "--seed", str(seed), *options], check=True)
    places_map = name.with_suffix(".ovimap")
    if not places_map.exists():
        scene = next(path.parent for path in name.glob("*/traj.txt"))
        subprocess.run([program, "embed", "gt", scene, *CROPS, "-o", places_map], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="ovimap")
    parser.add_argument("out", type=pathlib.Path)
    args = parser.parse_args()
    for kinds, seeds, options in ((ROOMS, ROOM_SEEDS, OF_ROOMS), (DESKS, DESK_SEEDS, OF_DESKS)):
        for kind in kinds:
            for seed in seeds:
                render(args.program, args.out, kind, seed, options)


if __name__ == "__main__":
    main()
