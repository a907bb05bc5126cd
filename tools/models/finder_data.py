# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What the entity finder learns from: rendered frames of the tuned halves of the benchmarks (docs/evaluation.md), of seeds that no
benchmark uses, as MobileSAM's encoder sees them, and where the things in them are."""

import dataclasses
import os
import pathlib
import subprocess
import zlib

import cv2
import numpy as np
import onnxruntime

INPUT_PX, EMBEDDED_PX, CELL_PX = 1024, 16, 8  # the network's input; one place of its embedding; one cell of the finder's maps
MEAN = np.array([123.675, 116.28, 103.53], np.float32)
STD = np.array([58.395, 57.12, 57.375], np.float32)
LEAST_PX = 60  # fewer pixels of a thing teach nothing
STRAY_PERCENT = 0.5  # of a thing's pixels at each side its box leaves out
SHORTEST_CELLS = 0.25  # a box's side is no nearer to a cell's middle than this, so that it has a logarithm

# Kinds of scenes, seeds, and options that make few frames, far apart. Seeds 109 and 110 are kept back, to choose methods by.
DESKS, ROOMS, PLANS = ["writing-desk", "breakfast-table", "book-shelf"], ["living-room", "bedroom", "kitchen"], ["flat"]
WALK = ["--fps", "1", "--seconds"]
SCENES = [
    (DESKS, range(101, 105), [*WALK, "8"]),
    (DESKS, range(107, 109), [*WALK, "5"]),
    (ROOMS, range(101, 105), ["--frames", "10", "--noise"]),
    (ROOMS, range(107, 109), ["--frames", "5", "--noise", "--size", "640x480"]),
    (["courtyard"], range(101, 105), [*WALK, "24"]),
    (["courtyard"], range(107, 109), [*WALK, "12"]),
    (DESKS, range(111, 119), [*WALK, "6"]),
    (ROOMS, range(111, 119), ["--frames", "6", "--noise", "--size", "640x480"]),
    (["courtyard"], range(111, 115), [*WALK, "16"]),
    (PLANS, range(101, 107), [*WALK, "16"]),
]


def rendered(program: pathlib.Path, folder: pathlib.Path):
    """The recordings of SCENES, rendered unless they are there."""
    for kind, seed, options in ((kind, str(seed), options) for kinds, seeds, options in SCENES for kind in kinds for seed in seeds):
        scene = folder / f"{kind}-{seed}"
        if not (scene / "done").exists():
            which = "--plan" if kind in PLANS else "--room"
            subprocess.run([program, "synth", scene, which, kind, "--seed", seed, *options], check=True, stdout=subprocess.DEVNULL)
            (scene / "done").touch()
        yield next(path.parent for path in scene.glob("*/results"))


def relit(rgb, rng):
    """Another light, camera and sharpness."""
    image = rgb.astype(np.float32) / 255
    if rng.random() < 0.15:
        image = np.repeat(image.mean(2, keepdims=True), 3, 2)
    image = np.clip(image * rng.uniform(0.85, 1.15, 3), 0, 1) ** rng.uniform(0.7, 1.4)
    mean = image.mean()
    image = (image - mean) * rng.uniform(0.7, 1.25) + mean + rng.uniform(-0.08, 0.08)
    if rng.random() < 0.25:
        image = cv2.GaussianBlur(image, (0, 0), rng.uniform(0.5, 1.6))
    image = np.clip(image + rng.normal(0, rng.uniform(0, 0.02), image.shape), 0, 1)
    return (image * 255).astype(np.uint8)


def varied(rgb, ids, rng):
    """A part of the image, larger, mirrored, in another light."""
    height, width = ids.shape
    if rng.random() < 0.6:
        share = rng.uniform(0.5, 1)
        w, h = int(width * share), int(height * share)
        x, y = rng.integers(0, width - w + 1), rng.integers(0, height - h + 1)
        rgb = cv2.resize(rgb[y : y + h, x : x + w], (width, height), interpolation=cv2.INTER_LINEAR)
        ids = cv2.resize(ids[y : y + h, x : x + w], (width, height), interpolation=cv2.INTER_NEAREST)
    if rng.random() < 0.5:
        rgb, ids = rgb[:, ::-1].copy(), ids[:, ::-1].copy()
    return relit(rgb, rng), ids


class Encoder:
    def __init__(self, file):
        self._session = onnxruntime.InferenceSession(file, providers=["CPUExecutionProvider"])

    def __call__(self, rgb):
        """channels x rows x columns of what the image fills, and the network's pixels for one of the image."""
        scale = INPUT_PX / max(rgb.shape[:2])
        height, width = round(rgb.shape[0] * scale), round(rgb.shape[1] * scale)
        tensor = np.zeros((1, 3, INPUT_PX, INPUT_PX), np.float32)
        resized = cv2.resize(rgb, (width, height), interpolation=cv2.INTER_LINEAR)
        tensor[0, :, :height, :width] = ((resized.astype(np.float32) - MEAN) / STD).transpose(2, 0, 1)
        whole = self._session.run(None, {"input": tensor})[0][0]
        return whole[:, : -(-height // EMBEDDED_PX), : -(-width // EMBEDDED_PX)], scale


def things_in(ids):
    """A row for each thing: id, box (x0, y0, x1, y1), pixels; and of each pixel how deep in its thing it lies, from 0 at the border to 1."""
    rows, depth = [], np.zeros(ids.shape, np.float32)
    for number in np.unique(ids[ids > 0]):
        ys, xs = np.nonzero(ids == number)
        if len(xs) < LEAST_PX:
            continue
        ends = STRAY_PERCENT, 100 - STRAY_PERCENT
        (x0, x1), (y0, y1) = np.percentile(xs, ends), np.percentile(ys, ends)
        part = np.s_[ys.min() : ys.max() + 1, xs.min() : xs.max() + 1]
        inside = cv2.distanceTransform(np.pad((ids[part] == number).astype(np.uint8), 1), cv2.DIST_L2, 3)[1:-1, 1:-1]
        np.maximum(depth[part], inside / inside.max(), out=depth[part])
        rows.append((number, x0, y0, x1, y1, len(xs)))
    return np.array(rows, np.float32).reshape(-1, 6), depth


def targets(ids, things, depth, scale, rows, columns):
    """What the finder shall say of rows x columns cells (FinderMaps of entity_finder.h, as values instead of logits), and how much a
    cell counts: all cells of a thing together the root of their number, so that small things are heard."""
    height, width = ids.shape
    x, y = (np.arange(columns) + 0.5) * CELL_PX / scale - 0.5, (np.arange(rows) + 0.5) * CELL_PX / scale - 0.5
    column, row = np.rint(x).astype(int), np.rint(y).astype(int)
    shown = (row < height)[:, None] & (column < width)[None]
    column, row = column.clip(0, width - 1), row.clip(0, height - 1)
    reach = max(1, round(CELL_PX / scale / 2))  # the deepest pixel near the middle: small things keep their peak
    deepest = cv2.dilate(depth, np.ones((reach, reach), np.uint8))
    number, wanted, weight = ids[row][:, column], np.zeros((6, rows, columns), np.float32), np.zeros((rows, columns), np.float32)
    wanted[0] = deepest[row][:, column] * shown
    weight[shown] = 0.02  # of no thing
    for thing, x0, y0, x1, y1, pixels in things:
        cells = (number == thing) & shown
        if not cells.any():
            continue
        weight[cells] = 1 / np.sqrt(cells.sum())
        v, u = np.nonzero(cells)
        for side, distance in enumerate((x[u] - x0, y[v] - y0, x1 - x[u], y1 - y[v]), 1):
            wanted[side][cells] = np.log(np.maximum(distance * scale / CELL_PX, SHORTEST_CELLS))
        wanted[5][cells] = min(1, pixels / ((x1 - x0 + 1) * (y1 - y0 + 1)))
    return wanted, weight


@dataclasses.dataclass
class Sample:
    embedding: np.ndarray  # float16
    targets: np.ndarray
    weight: np.ndarray


def embedded(scene: pathlib.Path, encoder: Encoder, cache: pathlib.Path):
    """A Sample for each frame of the recording, kept in the folder `cache`."""
    for frame in sorted(scene.glob("results/frame*.jpg")):
        name = f"{scene.parent.name}-{frame.stem}"
        file = cache / f"{name}.npz"
        if not file.exists():
            rgb = cv2.cvtColor(cv2.imread(str(frame)), cv2.COLOR_BGR2RGB)
            ids = cv2.imread(str(frame.with_name(frame.stem.replace("frame", "instance") + ".png")), cv2.IMREAD_UNCHANGED)
            rgb, ids = varied(rgb, ids, np.random.default_rng(zlib.crc32(name.encode())))
            embedding, scale = encoder(rgb)
            wanted, weight = targets(ids, *things_in(ids), scale, *(2 * size for size in embedding.shape[1:]))
            np.savez(file.with_suffix(".part.npz"), embedding=embedding.astype(np.float16), targets=wanted.astype(np.float16), weight=weight)
            os.replace(file.with_suffix(".part.npz"), file)
        with np.load(file) as kept:
            yield Sample(kept["embedding"], kept["targets"], kept["weight"])
