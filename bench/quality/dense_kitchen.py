#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""dense_features.py on photographs: the phrases and words of 7-Scenes "red kitchen" (tools/data/kitchen_*.csv).

    ovimap run KITCHEN --masks sam -o kitchen.ovimap
    python3 bench/quality/dense_kitchen.py build/release/bin/ovimap .models/default-encoder WORK KITCHEN kitchen.ovimap

There are no true masks: the pixels of an object are those at which the map's own mesh shows it, in every fifth frame."""
import pathlib
import subprocess
import sys

import numpy as np
import yaml
from PIL import Image

import dense_features

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import search_benchmarks  # noqa: E402

STEP = 5  # frames
COARSE = 2  # ids are drawn in images so many times smaller, each vertex as 3 x 3 pixels: no gaps beyond 0.9 m
SHARES = (0.0, 0.25, 0.5)
VERTEX = [("at", "<f4", 3), ("normal", "<f4", 3), ("color", "u1", 3), ("label", "<u4")]


def read_vertices(ply):
    data = ply.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    [count] = [int(line.split()[2]) for line in head.decode().splitlines() if line.startswith("element vertex")]
    return np.frombuffer(body, VERTEX, count)


def rotation(vector):
    """Of a rotation vector (Rodrigues)."""
    angle = np.linalg.norm(vector)
    x, y, z = np.array(vector) / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def shown_ids(vertices, color_from_world, camera):
    """Ids of the nearest vertices at the pixels of the colour image."""
    x, y, z = color_from_world[:3, :3] @ vertices["at"].T + color_from_world[:3, 3:]
    seen = np.flatnonzero(z > 0.1)
    seen = seen[np.argsort(-z[seen])]  # the nearest is drawn last
    ids = np.zeros((camera["height"] // COARSE + 2, camera["width"] // COARSE + 2), np.int64)
    column, row = (np.round((camera[f"f{axis}"] * at[seen] / z[seen] + camera[f"c{axis}"]) / COARSE).astype(int) for axis, at in (("x", x), ("y", y)))
    inside = (column >= 0) & (column < ids.shape[1] - 2) & (row >= 0) & (row < ids.shape[0] - 2)
    squares = [(row[inside] + y) * ids.shape[1] + column[inside] + x for y in range(3) for x in range(3)]
    ids.ravel()[np.stack(squares, 1).ravel()] = np.repeat(vertices["label"][seen[inside]], 9)  # of equal places the last stays
    return np.kron(ids[1:-1, 1:-1], np.ones((COARSE, COARSE), np.int64))


def kitchen_frames(kitchen, vertices):
    calibration = yaml.safe_load((kitchen / "calibration.yaml").read_text())
    color_from_depth = np.eye(4)
    color_from_depth[:3, :3] = rotation(calibration["color_from_depth"]["rotation_vector"])
    color_from_depth[:3, 3] = calibration["color_from_depth"]["translation"]
    for number, pose in enumerate(sorted(kitchen.glob("*.pose.txt"))):
        if number % STEP == 0:
            color_from_world = color_from_depth @ np.linalg.inv(np.loadtxt(pose))
            image = Image.open(pose.with_name(pose.name.replace("pose.txt", "color.jpg"))).convert("RGB")
            yield image, shown_ids(vertices, color_from_world, calibration["color_camera"]), number


def main():
    program, model, work, kitchen, map_file = map(pathlib.Path, sys.argv[1:])
    work.mkdir(parents=True, exist_ok=True)
    subprocess.run([program, "export", map_file, work / "kitchen.ply", "--what", "instances"], check=True, stdout=subprocess.DEVNULL)
    dense = dense_features.Dense(model, work)
    looks = dense_features.frame_looks(kitchen_frames(kitchen, read_vertices(work / "kitchen.ply")), dense, dense_features.views_of(map_file))
    print("| dense | its share | MRR | first | among five | absent, found | present, not found |\n| --- | --- | --- | --- | --- | --- | --- |")
    for share in SHARES:
        for kind in ("cells", "pooled", "views") if share else ("cells",):
            dense_features.mixed_map(map_file, work / "mixed.ovimap", looks[kind], share)
            ranks = [rank for _, rank, _, _ in search_benchmarks.kitchen_ranks(program, work / "mixed.ovimap")]
            wrong = {kind: len(words) / 50 for kind, words in search_benchmarks.verdict_rates(program, work / "mixed.ovimap").items()}
            print(f"| {kind if share else 'none'} | {share:g} | {sum(1 / rank for rank in ranks if rank) / len(ranks):.3f} "
                  f"| {search_benchmarks.recall(ranks, 1):.2f} | {search_benchmarks.recall(ranks, 5):.2f} | {wrong['absent']:.0%} | {wrong['present']:.0%} |", flush=True)


if __name__ == "__main__":
    main()
