# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The pictures that `ovimap synth OUT --catalog` draws, as the classifier's features."""

import csv
import pathlib

import numpy as np
from PIL import Image

import efficientnet_lite
import furniture_names

BATCH = 12
BACKGROUND = 128  # grey that stands for a removed background, as in ovimap's crops
PADDINGS = (0.0, 0.1, 0.2)
PIXEL_MEAN, PIXEL_STD = 127, 128


class Model:
    """One furniture model: what its name means, the class rooms know it by (or none)."""

    def __init__(self, row):
        self.id, self.name, self.room_class = row["model"], row["name"], row["room_class"]
        self.creator, self.license = row["creator"], row["license"]
        self.meanings = furniture_names.meanings(row["name"])


def object_crop(folder: pathlib.Path, row, masked: bool, padding: float) -> Image.Image:
    """The object's box with a margin, as ovimap cuts it out of a frame."""
    picture = np.asarray(Image.open(folder / row["file"]).convert("RGB"))
    mask = np.asarray(Image.open(folder / row["mask"])) > 0
    rows, columns = np.nonzero(mask.any(1))[0], np.nonzero(mask.any(0))[0]
    top, bottom, left, right = rows[0], rows[-1] + 1, columns[0], columns[-1] + 1
    pad_y, pad_x = int(padding * (bottom - top)), int(padding * (right - left))
    part = np.s_[max(0, top - pad_y) : bottom + pad_y, max(0, left - pad_x) : right + pad_x]
    if masked:
        picture = np.where(mask[..., None], picture, np.uint8(BACKGROUND))
    return Image.fromarray(picture[part])


def network_input(images) -> np.ndarray:
    size = (efficientnet_lite.SIZE_PX,) * 2
    pixels = [np.asarray(i.resize(size, Image.Resampling.BICUBIC), np.float32) for i in images]
    return ((np.stack(pixels) - PIXEL_MEAN) / PIXEL_STD).transpose(0, 3, 1, 2)


def features_of(images, session) -> np.ndarray:
    found = []
    for begin in range(0, len(images), BATCH):
        pixels = network_input(images[begin : begin + BATCH])
        found.append(session.run(None, {"pixel_values": pixels})[0])
    return np.concatenate(found)


def load_portraits(folder: pathlib.Path, views: int, make_session):
    """Models, features [pictures, 1280], and the model each row shows. Of each model `views`
    pictures spread over its rooms are taken, in turn plain and without background, with paddings
    drawn at random. Features are kept in folder/features.npz."""
    with open(folder / "crops.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    by_model = {}
    for row in rows:
        by_model.setdefault(row["model"], []).append(row)
    known = {m: r for m, r in by_model.items() if furniture_names.meanings(r[0]["name"])}
    models = [Model(rows[0]) for rows in known.values()]
    cache = folder / "features.npz"
    if cache.exists():
        with np.load(cache) as kept:
            if int(kept["views"]) == views and len(kept["models"]) == len(models):
                return models, kept["features"], kept["shown"]
    features, shown = compute_features(folder, known, views, make_session())
    np.savez(cache, features=features, shown=shown, views=views, models=list(known))
    return models, features, shown


def compute_features(folder, known, views, session):
    random = np.random.default_rng(0)
    features, shown = [], []
    for index, rows in enumerate(known.values()):
        picked = np.unique(np.linspace(0, len(rows) - 1, views).round().astype(int))
        crops = [
            object_crop(folder, rows[view], bool(turn % 2), random.choice(PADDINGS))
            for turn, view in enumerate(picked)
        ]
        features.append(features_of(crops, session))
        shown += [index] * len(crops)
        if index % 50 == 0:
            print(f"features: {index} of {len(known)} models", flush=True)
    return np.concatenate(features), np.array(shown)
