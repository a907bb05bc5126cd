#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Finds what a detector's scores are worth: the numbers of its model.yaml, from rendered rooms.

    pip install -r tools/models/requirements-train.txt
    for room in office kitchen living-room bedroom bathroom; do
      build/release/bin/ovimap synth rooms/$room --room $room --seed 101 --noise --frames 40; done
    python3 tools/models/calibrate_detectors.py .models/nanodet rooms/*/room

Every third frame is shown to the detector. An object gets for each name the best score of a box that overlaps with its own by half or more;
of each name those objects that are something else give the background, and those that it names, beside them, slope and offset by logistic
regression, every name and both sides weighing the same. Prints these and the correlation of the log ratios that frames give one object.
"""

import argparse
import collections
import json
import pathlib
import re
import sys

import numpy as np
import onnxruntime
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import search_evidence  # noqa: E402  (what words mean)

LEAST_PX = 500  # of an object in a frame
LEAST_OVERLAP = 0.5
FRAME_STEP = 3
LEAST_EXAMPLES = 5  # of a name that takes part in the regression


class Detector:
    def __init__(self, folder: pathlib.Path):
        text = (folder / "model.yaml").read_text()
        self.names = re.findall(r"^  ([^;\n]+);[\d.]+$", text, re.MULTILINE)
        self.floor = float(re.search(r"^floor: (\S+)$", text, re.MULTILINE)[1])
        size, mean, std = re.search(r"size: (\d+).*mean: \[(.*?)\], std: \[(.*?)\]", text).groups()
        self.size = int(size)
        self.mean, self.std = (np.array(part.split(","), np.float32).reshape(3, 1, 1) for part in (mean, std))
        self.network = onnxruntime.InferenceSession(folder / "detector.onnx")

    def find(self, image):
        small = image.resize((self.size, self.size), Image.Resampling.BILINEAR)
        pixels = (np.asarray(small, np.float32).transpose(2, 0, 1) - self.mean) / self.std
        boxes, scores = self.network.run(["boxes", "scores"], {"image": pixels[None]})
        return np.clip(boxes, 0, 1), scores


def best_scores(boxes, scores, box):
    """[names] of boxes that overlap with `box`."""
    sides = np.clip(np.minimum(boxes[:, 2:], box[2:]) - np.maximum(boxes[:, :2], box[:2]), 0, None)
    shared = sides.prod(1)
    area = np.clip(boxes[:, 2:] - boxes[:, :2], 0, None).prod(1) + np.prod(box[2:] - box[:2])
    return (scores * (shared >= LEAST_OVERLAP * (area - shared))[:, None]).max(0)


def sightings(detector, room):
    """(object's id, its name, scores [names]) of the objects in each frame."""
    names = json.loads((room / "labels.json").read_text())["instances"]
    for frame in sorted((room / "results").glob("frame*.jpg"))[::FRAME_STEP]:
        ids = np.asarray(Image.open(frame.with_name(frame.name.replace("frame", "instance")).with_suffix(".png")))
        boxes, scores = detector.find(Image.open(frame).convert("RGB"))
        for instance in np.unique(ids):
            rows, columns = np.nonzero(ids == instance)
            if str(instance) in names and len(rows) >= LEAST_PX:
                box = np.array([columns.min(), rows.min(), columns.max() + 1, rows.max() + 1], float)
                box /= np.array(ids.shape[::-1] * 2)
                yield f"{room}#{instance}", names[str(instance)], best_scores(boxes, scores, box)


class Meaning:
    """Whether a word is a kind of what a detector calls by its words."""

    def __init__(self):
        self.concepts = search_evidence.concepts()

    def senses(self, word):
        sense = self.concepts.household.get(word)
        return self.concepts.kinds_of(word) if sense is None else [sense]

    def kinds(self, words):
        return [kind for word in words.split("|") for kind in self.senses(word)]

    def is_one(self, word, words):
        return any(kind in self.concepts.above[sense] for sense in self.senses(word) for kind in self.kinds(words))

    def may_be(self, word, words):
        return any(sense in self.concepts.above[kind] for sense in self.senses(word) for kind in self.kinds(words))


def logistic(inputs, answers, weights):
    """Offset and slope."""
    inputs = np.stack([np.ones_like(inputs), inputs], 1)
    solution = np.zeros(2)
    for _ in range(100):
        chance = 1 / (1 + np.exp(-inputs @ solution))
        curvature = (inputs * (weights * chance * (1 - chance))[:, None]).T @ inputs
        solution += np.linalg.solve(curvature, inputs.T @ (weights * (answers - chance)))
    return solution


def correlation(ratios, owners):
    """Share of the ratios' variance that is between objects, not within."""
    groups = collections.defaultdict(list)
    for ratio, owner in zip(ratios, owners):
        groups[owner].append(ratio)
    groups = [np.array(group) for group in groups.values() if len(group) > 2]
    return 1 - np.mean([group.var(ddof=1) for group in groups]) / np.concatenate(groups).var()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", type=pathlib.Path)
    parser.add_argument("rooms", type=pathlib.Path, nargs="+")
    args = parser.parse_args()
    detector, meaning = Detector(args.model), Meaning()
    seen = [sighting for room in args.rooms for sighting in sightings(detector, room)]
    owners = np.array([owner for owner, _, _ in seen])
    scores = np.stack([row for _, _, row in seen]).astype(float)
    right = np.array([[meaning.is_one(name, words) for words in detector.names] for _, name, _ in seen])
    wrong = ~right & ~np.array([[meaning.may_be(name, words) for words in detector.names] for _, name, _ in seen])
    background = np.array([scores[wrong[:, k], k].mean() for k in range(len(detector.names))])
    ratios = np.log((scores + detector.floor) / (background + detector.floor))
    inputs, answers, weights = [], [], []
    for k in range(len(detector.names)):
        if right[:, k].sum() < LEAST_EXAMPLES:
            continue
        for side, answer in ((right[:, k], 1.0), (wrong[:, k], 0.0)):
            inputs.append(ratios[side, k])
            answers.append(np.full(side.sum(), answer))
            weights.append(np.full(side.sum(), 1 / side.sum()))
    offset, slope = logistic(*(np.concatenate(part) for part in (inputs, answers, weights)))
    rows, columns = np.nonzero(right)
    print(f"{len(seen)} sightings; offset: {offset:.2f} slope: {slope:.2f}, correlation within an object "
          f"{correlation(slope * ratios[rows, columns], [f'{owners[r]} {c}' for r, c in zip(rows, columns)]):.2f}")
    for words, mean in zip(detector.names, background):
        print(f"  {words};{mean:.3f}")


if __name__ == "__main__":
    main()
