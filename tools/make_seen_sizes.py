#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes src/ovimap/semantics/data/seen_sizes.txt: how large things are in maps, where, and how their surface is spread.

Usage: tools/make_seen_sizes.py PROGRAMS WORK

PROGRAMS is the folder of `ovimap` and `ovimap_object_measures`; WORK is that of tools/models/train_pair_judge.py, whose
rooms are of the tuned halves: each is measured once with its true objects and as MobileSAM's masks of every and every second
frame make them. Of objects of a name that are nearly alike (docs/query.md) one stands for all.
"""
import collections
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
OUT = ROOT / "src/ovimap/semantics/data/seen_sizes.txt"
MASKS = ("sam-1", "sam-2")
LEAST_SEEN = 3  # of a name
THINNEST_M, LOWEST_TOP_M = 0.02, 0.1
DEVIATIONS = (0.35, 0.45, 0.5, 0.25, 0.3, 0.12, 0.12)  # those of words/thing_sizes.cpp
HEAD = """# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Things as maps of rendered rooms show them: word;height;length;depth;bottom;top share;covered share;count, in metres, the
# bottom above the floor. Written by tools/make_seen_sizes.py; do not edit.
"""


def measures(programs, map_file, scene):
    done = subprocess.run([programs / "ovimap_object_measures", map_file, scene], check=True, stdout=subprocess.PIPE, text=True)
    for line in done.stdout.splitlines():
        word, *numbers = line.split(";")
        yield word, tuple(map(float, numbers))


def all_measures(programs, work):
    for room in sorted((work / "scenes").iterdir()):
        scene = next(room.glob("*/results")).parent
        with tempfile.TemporaryDirectory() as folder:
            truth = pathlib.Path(folder) / "truth.ovimap"
            subprocess.run([programs / "ovimap", "embed", "gt", scene, "--set", "crops.scales=1", "-o", truth], check=True)
            yield from measures(programs, truth, scene)
        for masks in MASKS:
            map_file = work / "maps" / f"{room.name}-{masks}.ovimap"
            if map_file.exists():
                yield from measures(programs, map_file, scene)


def in_deviations(size):
    height, length, depth, bottom, top_share, covered_share = size
    sides = [math.log(max(side, THINNEST_M)) for side in (height, length, depth)]
    numbers = (*sides, bottom, math.log(max(bottom + height, LOWEST_TOP_M)), top_share, covered_share)
    return [number / deviation for number, deviation in zip(numbers, DEVIATIONS)]


def stand_ins(sizes):
    """Sizes and for how many each stands: time and again the one that has most others within a deviation."""
    left = [(in_deviations(size), size) for size in sizes]
    while left:
        near = max(([other for other in left if math.dist(other[0], at) <= 1] for at, _ in left), key=len)
        middle = min(near, key=lambda one: sum(math.dist(one[0], other[0]) for other in near))
        yield middle[1], len(near)
        left = [other for other in left if not any(other is taken for taken in near)]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    programs, work = map(pathlib.Path, sys.argv[1:])
    sizes = collections.defaultdict(list)
    for word, size in all_measures(programs, work):
        sizes[word].append(size)
    lines = [f"{word};{';'.join(f'{number:.3g}' for number in size)};{count}" for word in sorted(sizes) if len(sizes[word]) >= LEAST_SEEN
             for size, count in stand_ins(sizes[word])]
    OUT.write_text(HEAD + "\n".join(lines) + "\n")
    print(f"{len(lines)} sizes")


if __name__ == "__main__":
    main()
