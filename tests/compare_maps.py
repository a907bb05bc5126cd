#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Holds two maps of one recording, made on different processors, against each other: all tables but those in which rounding shows are
the same, and a distance differs by one of its 32767 steps at most, a weight by one of its 1024ths. Usage: compare_maps.py TITLE MAP MAP"""
import sys

import numpy as np

from map_reader import Map, read_tile

ROUNDED = {"blocks", "super_point_looks", "super_point_views"}  # distances, weights and centres
PER_MACHINE = {"timings", "source", "version", "content_hash"}


def voxels(map_file):
    """By tile and block: distances in steps, weights in steps, and everything else."""
    return {(tile, place): (distance.astype(np.int16), 1024 * weight.view(np.float32),
                            (palette.tobytes(), doubts.tobytes(), *(part.tobytes() for part in (*colors, *slots, *supports))))
            for tile, present, _, data in map_file.rows("blocks")
            for place, palette, distance, weight, colors, slots, supports, doubts in read_tile(present, data, map_file.pragma("user_version"))}


def steps(ours, theirs, part):
    return np.concatenate([np.abs(ours[key][part].astype(float) - theirs[key][part]) for key in ours])


def main(title, *paths):
    here, there = map(Map, paths)
    checks = [{name: rest for name, *rest in one.database.execute("SELECT name, rows, hash FROM checks WHERE name != 'meta'")} for one in (here, there)]
    odd = {name for name in checks[0].keys() | checks[1].keys() if checks[0].get(name) != checks[1].get(name)}
    odd |= {f"meta.{key}" for key in here.meta.keys() | there.meta.keys() if here.meta.get(key) != there.meta.get(key) and key not in PER_MACHINE}
    assert odd <= ROUNDED, f"{title}: differing in {', '.join(sorted(odd))}"
    ours, theirs = voxels(here), voxels(there)
    assert ours.keys() == theirs.keys(), f"{title}: other blocks"
    apart = np.maximum(steps(ours, theirs, 0), steps(ours, theirs, 1))
    others = sum(ours[key][2] != theirs[key][2] for key in ours)
    assert apart.max() <= 1 and others == 0, f"{title}: distances and weights differ by {apart.max()} steps, {others} blocks in more than these"
    print(f"{title}: {len(checks[0])} tables, {len(here.objects())} objects; {np.count_nonzero(apart)} of {len(apart)} voxels differ, by one step")


if __name__ == "__main__":
    main(*sys.argv[1:])
