# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The crops that maps of rendered places keep of their objects (training_places.py), as the classifier's features."""

import collections
import io
import json
import pathlib
import sqlite3

import numpy as np
from PIL import Image

from portraits import BACKGROUND, features_of

MARGIN = 0.1  # of the box, as crops.margins has it first


class Crops:
    """Features [crops, 1280], the name of what each shows, and a weight: a name counts by the root of how many objects
    have it, an object by one, however often it was seen."""

    def __init__(self, features, names, objects):
        self.features, self.names = np.concatenate(features), names
        crops_of = collections.Counter(objects)
        objects_of = collections.Counter(name for _, name in set(zip(objects, names)))
        self.weights = np.array([objects_of[n] ** -0.5 / crops_of[o] for n, o in zip(names, objects)])


def instances_of(database):
    """A function from the label of a super-point to its instance, or None."""
    (roots,) = database.execute("SELECT roots FROM label_forest ORDER BY epoch DESC LIMIT 1").fetchone()
    roots = np.frombuffer(roots, np.uint32)
    owner = {label: instance for instance, label in database.execute("SELECT instance, label FROM instance_super_points")}
    return lambda label: owner.get(int(roots[label]) if label < len(roots) else label)


def crop_pair(picture, mask, box):
    """With what surrounds it, and without."""
    left, top, right, bottom = box
    picture = Image.open(io.BytesIO(picture)).convert("RGB")
    own = np.asarray(Image.open(io.BytesIO(mask))) > 0
    alone = Image.fromarray(np.where(own[..., None], np.asarray(picture), np.uint8(BACKGROUND)))
    wide, high = int(MARGIN * (right - left + 1)), int(MARGIN * (bottom - top + 1))
    part = (max(0, left - wide), max(0, top - high), min(picture.width, right + 1 + wide), min(picture.height, bottom + 1 + high))
    return [picture.crop(part), alone.crop(part)]


def load_crops(folder: pathlib.Path, session) -> Crops:
    """Of all maps OUT/NAME.ovimap of a folder, with the names that the scenes' labels.json tell."""
    features, names, objects = [], [], []
    for path in sorted(folder.glob("*.ovimap")):
        labels = json.loads(next(path.with_suffix("").glob("*/labels.json")).read_text())["instances"]
        database = sqlite3.connect(f"file:{path}?mode=ro&immutable=1", uri=True)
        instance_of = instances_of(database)
        pictures = []
        for label, picture, mask, *box in database.execute(
                "SELECT label, crop_jpeg, crop_mask_png, min_x, min_y, max_x, max_y FROM super_point_views WHERE length(crop_jpeg) > 0"):
            name = labels.get(str(instance_of(label)))
            if name is None:
                continue
            pictures += crop_pair(picture, mask, box)
            names += [name] * 2
            objects += [f"{path.stem} {instance_of(label)}"] * 2
        features.append(features_of(pictures, session))
        print(f"features: {len(pictures)} crops of {path.stem}", flush=True)
    if not features:
        raise SystemExit(f"{folder}: no map there; make them with tools/models/training_places.py")
    return Crops(features, names, objects)
