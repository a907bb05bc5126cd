#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""How much more often looks of one kind of thing are so alike than looks of different kinds.

    build/release/bin/ovimap embed gt ROOM/room -o ROOM.ovimap           # of several rendered rooms
    python3 tools/models/calibrate_teaching.py ROOM.ovimap ROOM/room ROOM2.ovimap ROOM2/room ...

Every object of one room is an example for those of the others. How much smaller their angle is than the other room's objects'
with each other in the mean is measured in standard deviations, as src/ovimap/semantics/words/taught_things.cpp does. Prints for each half
deviation how often that is so for things of one name and of different ones, the logarithm of the ratio, and the line there.
Floor, walls and ceiling are left out: nobody teaches them.
"""
import json
import pathlib
import sqlite3
import sys

import numpy as np

LINE, LEAST_RATIO = (2.0, -1.5), -1.0
STUFF = {"floor", "wall", "ceiling"}
STEP = 0.5


def read(map_file, room):
    names = json.loads((pathlib.Path(room) / "labels.json").read_text())["instances"]
    with sqlite3.connect(f"file:{map_file}?mode=ro", uri=True) as database:
        rows = database.execute("SELECT instance, embedding FROM embeddings ORDER BY instance").fetchall()
    rows = [(names[str(number)], np.frombuffer(look, np.float32)) for number, look in rows]
    return np.array([name for name, _ in rows]), np.stack([look for _, look in rows])


def angles(looks, others):
    return np.arccos(np.clip(looks @ others.T, -1, 1))


def likeness(examples, objects):
    """Deviations above strangers, and whether the names agree, of all pairs."""
    own = angles(objects[1], objects[1])[~np.eye(len(objects[0]), dtype=bool)]
    alike = (own.mean() - angles(examples[1], objects[1])) / own.std()
    things = ~np.isin(examples[0], list(STUFF))
    return alike[things].ravel(), (examples[0][:, None] == objects[0][None])[things].ravel()


def main():
    rooms = [read(*pair) for pair in zip(sys.argv[1::2], sys.argv[2::2])]
    pairs = [likeness(a, b) for i, a in enumerate(rooms) for j, b in enumerate(rooms) if i != j]
    alike, same = (np.concatenate(column) for column in zip(*pairs))
    print(f"{same.sum()} pairs of one name, {(~same).sum()} of two")
    for low in np.arange(-1.5, 4.5, STEP):
        here = (alike >= low) & (alike < low + STEP)
        counts = (here & same).sum(), (here & ~same).sum()
        ratio = np.log((counts[0] + 0.5) / same.sum() * (~same).sum() / (counts[1] + 0.5))
        told = max(np.polyval(LINE, low + STEP / 2), LEAST_RATIO)
        print(f"{low:5.1f} {counts[0]:6} {counts[1]:7}   log ratio {ratio:5.2f}, taken for {told:5.2f}")


if __name__ == "__main__":
    main()
