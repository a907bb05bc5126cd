#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What a dense layer of features would add to the embeddings of objects (FUS3DMaps 2026), tried outside the program.

    python3 bench/quality/dense_features.py build/release/bin/ovimap .models/default-encoder WORK ROOM/room [ROOM2/room ...]

ROOM: rendered, with truth. A dense layer keeps in each voxel the mean of what whole frames say at its pixels; an object's share
of it is the mean over its surface. With true masks that is the mean over its pixels in all frames, which this makes without
voxels: each frame is shown to the encoder in windows of its height and of half of it, and what the network holds before it
pools is taken cell by cell (`cells`: embedded, then averaged) or averaged over the object first (`pooled`). `crops` does the same as
`pooled` with the crops that the map keeps, four of an object, and needs no windows: what pooling within the outline does by itself. The object's own
embedding, of crops, is mixed with it, put into a copy of the map, and the map is asked for all classes of the room. What is in
WORK already, maps and looks by the rooms' names, is taken from there.

Needs tools/models/requirements-train.txt, PyYAML and xxhash."""
import io
import json
import pathlib
import shutil
import sqlite3
import struct
import subprocess
import sys

import numpy as np
import onnx
import onnxruntime
import xxhash
import yaml
from PIL import Image

STUFF = {"floor", "wall", "ceiling"}
LEAST_SHARE = 0.25  # of a cell that an object must fill
MOST_FRAMES = 60
SHARES = (0.0, 0.25, 0.5)
KINDS = ("cells", "pooled", "views", "crops")
PICTURE_ALONE = ["--set", "query.evidence.size_weight=0", "--set", "query.evidence.competition=0", "--set", "query.evidence.thing_weight=0"]
EVIDENCE = {"picture": PICTURE_ALONE, "all": []}


class Dense:
    """The encoder in two halves: to the features of cells, and from features to embeddings."""

    def __init__(self, folder, work):
        self.input = yaml.safe_load((folder / "model.yaml").read_text())["input"]
        graph = onnx.load(folder / "image.onnx").graph
        [pool] = [node for node in graph.node if node.op_type == "GlobalAveragePool"]
        [flat] = [node for node in graph.node if node.op_type == "Flatten" and node.input[0] == pool.output[0]]
        self.head = self._part(folder, work / "head.onnx", "pixel_values", pool.input[0])
        self.tail = self._part(folder, work / "tail.onnx", flat.output[0], "image_embeds")

    @staticmethod
    def _part(folder, file, begin, end):
        onnx.utils.extract_model(str(folder / "image.onnx"), str(file), [begin], [end], check_model=False)
        return onnxruntime.InferenceSession(str(file), providers=["CPUExecutionProvider"])

    def cells(self, windows):
        """[N, rows, columns, channels] of images."""
        size = self.input["size"]
        pixels = np.stack([np.asarray(window.resize((size, size), Image.Resampling.BICUBIC), np.float32) for window in windows])
        pixels = (pixels - self.input["mean"]) / self.input["std"]
        return run(self.head, pixels.transpose(0, 3, 1, 2).astype(np.float32)).transpose(0, 2, 3, 1)

    def embeddings(self, features):
        return run(self.tail, np.ascontiguousarray(features, np.float32))


def run(session, values):
    return session.run(None, {session.get_inputs()[0].name: values})[0]


def windows_of(width, height):
    """Squares of the image's height, and of half of it, that overlap by half."""
    for side in (height, height // 2):
        columns = max(2, -(-(width - side) * 2 // side) + 1)
        rows = -(-(height - side) * 2 // side) + 1
        for y in np.linspace(0, height - side, rows).astype(int):
            for x in np.linspace(0, width - side, columns).astype(int):
                yield x, y, side


def shares_in(ids, cells):
    """[objects, cells * cells] of each cell that is the object's, and the objects."""
    edges = np.linspace(0, len(ids), cells + 1).astype(int)
    counts = []
    numbers = np.unique(ids[ids > 0])
    for number in numbers:
        whole = np.pad((ids == number).cumsum(0).cumsum(1), ((1, 0), (1, 0)))[np.ix_(edges, edges)]
        counts.append((whole[1:, 1:] - whole[:-1, 1:] - whole[1:, :-1] + whole[:-1, :-1]).ravel())
    areas = np.outer(np.diff(edges), np.diff(edges)).ravel()
    return numbers, np.array(counts).reshape(len(numbers), -1) / areas


class Sums:
    """Of an object, over all frames."""

    def __init__(self):
        self.cells = self.features = self.views = 0
        self.weight = 0


def room_frames(room):
    """(picture, ids of its pixels, number) of a rendered room."""
    frames = sorted(room.glob("results/frame*.jpg"))
    for frame in frames[:: max(1, -(-len(frames) // MOST_FRAMES))]:
        ids = np.asarray(Image.open(frame.with_name(frame.stem.replace("frame", "instance") + ".png")))
        yield Image.open(frame).convert("RGB"), ids, int(frame.stem[5:])


def frame_looks(frames, dense, views):
    """{kind: {object: embedding of length 1}}; `views`: {(object, frame): pixels}, which views of the objects were chosen."""
    sums = {}
    for image, ids, frame in frames:
        here = {}
        places = list(windows_of(*image.size))
        features = dense.cells([image.crop((x, y, x + side, y + side)) for x, y, side in places])
        for (x, y, side), field in zip(places, features):
            numbers, shares = shares_in(ids[y:y + side, x:x + side], len(field))
            field = field.reshape(-1, field.shape[-1])
            used = np.flatnonzero((shares >= LEAST_SHARE).any(0)) if len(numbers) else []
            if not len(used):
                continue
            looks = dense.embeddings(field[used])
            for number, share in zip(numbers, shares[:, used]):
                weights = np.where(share >= LEAST_SHARE, share, 0)
                if weights.any():
                    mine = sums.setdefault(int(number), Sums())
                    mine.features = mine.features + weights @ field[used]
                    mine.weight += weights.sum()
                    here[int(number)] = here.get(int(number), 0) + weights @ looks
        for number, cells in here.items():
            sums[number].cells = sums[number].cells + cells
            sums[number].views = sums[number].views + views.get((number, frame), 0) * unit(cells)
    return {
        "cells": {number: unit(mine.cells) for number, mine in sums.items()},
        "pooled": {number: dense.embeddings((mine.features / mine.weight)[None])[0] for number, mine in sums.items()},
        "views": {number: unit(mine.views) for number, mine in sums.items() if np.any(mine.views)},
    }


def views_of(map_file):
    with sqlite3.connect(map_file) as database:
        rows = database.execute("SELECT instance, frame, visible_px FROM super_point_views JOIN instance_super_points USING (label)").fetchall()
    return {(number, frame): visible_px for number, frame, visible_px in rows}


def crop_looks(map_file, dense):
    """{object: of the cells of its kept crops that it fills}, each of length 1."""
    sums = {}
    with sqlite3.connect(map_file) as database:
        rows = database.execute("SELECT instance, visible_px, crop_jpeg, crop_mask_png FROM super_point_views JOIN instance_super_points USING (label) "
                                "WHERE length(crop_jpeg) > 0").fetchall()
    for number, visible_px, image, mask in rows:
        field = dense.cells([Image.open(io.BytesIO(image)).convert("RGB")])[0]
        stretched = Image.open(io.BytesIO(mask)).resize((dense.input["size"],) * 2, Image.Resampling.NEAREST)
        numbers, shares = shares_in(np.asarray(stretched, int), len(field))
        if not len(numbers):
            continue
        weights = np.maximum(shares[0], 1e-9)
        mine = sums.setdefault(number, Sums())
        mine.features = mine.features + visible_px * (weights @ field.reshape(len(weights), -1)) / weights.sum()
        mine.weight += visible_px
    return {number: dense.embeddings((mine.features / mine.weight)[None])[0] for number, mine in sums.items()}


def unit(vector):
    return vector / np.linalg.norm(vector)


def mixed_map(map_file, copy, looks, share):
    shutil.copyfile(map_file, copy)
    with sqlite3.connect(copy) as database:
        for number, blob in database.execute("SELECT instance, embedding FROM embeddings").fetchall():
            own = np.frombuffer(blob, np.float32)
            if number in looks:
                both = unit((1 - share) * unit(own) + share * unit(looks[number])).astype(np.float32)
                database.execute("UPDATE embeddings SET embedding = ? WHERE instance = ?", (both.tobytes(), number))
        rows = database.execute("SELECT instance, embedding FROM embeddings").fetchall()
        total = sum(xxhash.xxh64_intdigest(struct.pack("<cqcq", b"i", number, b"b", len(blob)) + blob) for number, blob in rows) % 2**64
        database.execute("UPDATE checks SET hash = ? WHERE name = 'embeddings'", (total - 2**64 if total >= 2**63 else total,))


def ranks(program, map_file, room, options):
    """Reciprocal ranks of the room's classes."""
    names = json.loads((room / "labels.json").read_text())["instances"]
    classes = sorted(set(names.values()) - STUFF)
    command = [program, "query", map_file, *classes, "--json", "--top", "1000", "--set", "query.grammar=false", *options]
    answers = json.loads(subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout)
    found = []
    for name, answer in zip(classes, answers["results"]):
        right = [rank for rank, one in enumerate(answer["instances"], 1) if names.get(str(one["id"])) == name]
        found.append(1 / min(right) if right else 0)
    return found


def stored_looks(map_file, room, dense):
    """{kind: {object: embedding}}, from the files beside the map where they are there."""
    files = {kind: map_file.with_suffix(f".{kind}.npz") for kind in KINDS}
    looks = {}
    if not all(files[kind].exists() for kind in KINDS[:-1]):
        looks = frame_looks(room_frames(room), dense, views_of(map_file))
    if not files["crops"].exists():
        looks["crops"] = crop_looks(map_file, dense)
    for kind, of_objects in looks.items():
        np.savez(files[kind], numbers=np.array(list(of_objects)), looks=np.array(list(of_objects.values()), np.float32))
    stored = {kind: np.load(file) for kind, file in files.items()}
    return {kind: dict(zip(of_kind["numbers"].tolist(), of_kind["looks"])) for kind, of_kind in stored.items()}


def measure(program, work, model, dense, room):
    """{(kind, share, evidence): MRR} of a room."""
    map_file = work / f"{room.parent.name}.ovimap"
    if not map_file.exists():
        made = work / "made.ovimap"
        subprocess.run([str(program), "embed", "gt", str(room), "--encoder", str(model), "-o", str(made)], check=True, stdout=subprocess.DEVNULL)
        made.rename(map_file)
    looks = stored_looks(map_file, room, dense)
    found = {}
    for share in SHARES:
        for kind in KINDS if share else KINDS[:1]:
            mixed_map(map_file, work / "mixed.ovimap", looks[kind], share)
            for evidence, options in EVIDENCE.items():
                found[kind, share, evidence] = float(np.mean(ranks(program, work / "mixed.ovimap", room, options)))
    return found


def table(results):
    """Means over the rooms, and how many gain over share 0 by all evidence."""
    yield "| dense | its share | MRR, picture alone | MRR, all evidence | rooms that gain | that lose |\n| --- | --- | --- | --- | --- | --- |"
    for kind, share, evidence in results[0]:
        if evidence == "all":
            picture, everything = (np.mean([one[kind, share, evidence] for one in results]) for evidence in EVIDENCE)
            gains = np.array([one[kind, share, "all"] - one[KINDS[0], 0.0, "all"] for one in results])
            yield f"| {kind if share else 'none'} | {share:g} | {picture:.3f} | {everything:.3f} | {(gains > 0).sum()} | {(gains < 0).sum()} |"


def main():
    program, model, work, *rooms = map(pathlib.Path, sys.argv[1:])
    work.mkdir(parents=True, exist_ok=True)
    dense = Dense(model, work)
    results = []
    for room in rooms:
        results.append(measure(program, work, model, dense, room))
        print(room.parent.name, " ".join(f"{kind}/{share:g}/{evidence} {value:.3f}" for (kind, share, evidence), value in results[-1].items()), flush=True)
    print("\n".join(table(results)))


if __name__ == "__main__":
    main()
