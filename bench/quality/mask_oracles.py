# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Takes one kind of error at a time out of 2D masks, to find which costs a map most.

    python bench/quality/mask_oracles.py SCENE MASKS OUT

SCENE is a rendered recording with true instance images, MASKS a folder that `ovimap masks SCENE -o MASKS` wrote. OUT gets folders
for `ovimap run SCENE --masks OUT/NAME`, of the same frames: `joined` (masks of one true thing are one), `parted` (things that are in
another's mask and have none of their own get theirs), `filled` (what no mask covers gets the true ones), `joined-parted`, and `true`.
"""

import pathlib
import sys

import numpy
from PIL import Image


def owners(masks, truth):
    """The true thing that most of each mask shows, 0 where that is none; by mask id."""
    table = numpy.zeros((masks.max() + 1, truth.max() + 1), int)
    numpy.add.at(table, (masks.ravel(), truth.ravel()), 1)
    most = table.argmax(1)
    most[0] = 0
    return most


def without_errors(masks, truth, name):
    """Ids of masks and, above them, of true things."""
    first_true = masks.max() + 1
    of_mask = owners(masks, truth)
    as_true = numpy.where(truth > 0, first_true + truth, 0)
    if name == "true":
        return as_true
    ids = masks
    if "joined" in name:
        ids = numpy.where(of_mask[masks] > 0, first_true + of_mask[masks], masks)
    if "parted" in name:
        lost = (masks > 0) & (truth > 0) & ~numpy.isin(truth, of_mask)
        ids = numpy.where(lost, as_true, ids)
    if "filled" in name:
        ids = numpy.where(masks == 0, as_true, ids)
    return ids


def numbered(ids):
    """The same masks as 1, 2, ...; 0 stays 0."""
    values, places = numpy.unique(ids, return_inverse=True)
    return (places.reshape(ids.shape) + (values[0] != 0)).astype(numpy.uint16)


def main(scene, masks, out):
    for file in sorted(pathlib.Path(masks).glob("*.png")):
        found = numpy.asarray(Image.open(file)).astype(int)
        truth = numpy.asarray(Image.open(pathlib.Path(scene) / "results" / f"instance{int(file.stem):06d}.png")).astype(int)
        for name in ("joined", "parted", "filled", "joined-parted", "true"):
            folder = pathlib.Path(out) / name
            folder.mkdir(parents=True, exist_ok=True)
            Image.fromarray(numbered(without_errors(found, truth, name))).save(folder / file.name)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
