#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the folders of the detectors from packages of the JavaScript registry.

- objectron: the SSD with MobileNetV2 (Liu et al. 2016, Sandler et al. 2018) that MediaPipe's
  Objectron starts from, trained on Open Images: 23 names.
- nanodet: NanoDet-g (RangiLyu 2021), trained on COCO: 80 names.

Both become ONNX networks of one form: `image` [1, 3, S, S], scaled as model.yaml says, gives [boxes, 4] (left, top, right, bottom as shares of the image's sides) and `scores` [boxes, names] from
0 to 1. docs/default-encoder.md says what they are good for.
"""

import argparse
import hashlib
import pathlib
import re
import sys

import numpy as np

import tfjs_graph
import tflite_file
from onnx_graph import Graph

HERE = pathlib.Path(__file__).parent
SOURCES = {
    "objectron_solution_packed_assets.data": "470986ca5df183f41698da6de74b027d838fe289d77b5ab094497d350bee664e",
    "nanodet.json": "4495eb0ec74bd33ee40a79aa06ebc1ccd7e28be1bf7355d93ffb570b8d77f45d",
    "nanodet.bin": "5d0e4f8c4eded666287330be03017d494787d35f523fd77ca23f59db984a4ad9",
}


def sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def source(package: pathlib.Path, name: str) -> bytes:
    data = (package / name).read_bytes()
    if sha256(data) != SOURCES[name]:
        sys.exit(f"build_detectors: {name} has SHA-256 {sha256(data)}, expected {SOURCES[name]}; "
                 "fetch the package again")
    return data


# --------------------------------------------------------------------------------------- objectron

SSD_FILE = "objectron_solution_packed_assets.data"
SSD_BYTES = slice(184, 9987912)  # of the packed file; a list of names comes before
SSD_SIZE_PX = 300
SSD_STRIDES = (16, 32, 64, 128, 256, 512)
SSD_SCALES = (0.2, 0.95)
SSD_RATIOS = (1.0, 2.0, 0.5, 3.0, 0.3333)
SSD_VARIANCES = (0.1, 0.1, 0.2, 0.2)  # of centre and size


def ssd_anchors() -> np.ndarray:
    """[1917, 4] centre x, y, width, height as shares of the image, as MediaPipe generates them."""
    low, high = SSD_SCALES
    count = len(SSD_STRIDES)
    scales = [low + (high - low) * i / (count - 1) for i in range(count)] + [1.0]
    anchors = []
    for layer, stride in enumerate(SSD_STRIDES):
        scale, between = scales[layer], np.sqrt(scales[layer] * scales[layer + 1])
        shapes = [(scale, ratio) for ratio in SSD_RATIOS] + [(between, 1.0)]
        if layer == 0:
            shapes = [(0.1, 1.0), (scale, 2.0), (scale, 0.5)]
        side = -(-SSD_SIZE_PX // stride)
        for row in range(side):
            for column in range(side):
                for size, ratio in shapes:
                    anchors.append(((column + 0.5) / side, (row + 0.5) / side,
                                    size * np.sqrt(ratio), size / np.sqrt(ratio)))
    return np.array(anchors)


def corners(graph, centres, sizes):
    half = graph.add("Mul", sizes, graph.constant(0.5))
    graph.add("Concat", graph.add("Sub", centres, half), graph.add("Add", centres, half), axis=1,
              output="boxes")


def objectron_network(package) -> bytes:
    graph = Graph("objectron")
    image = graph.add_input("image", [1, 3, SSD_SIZE_PX, SSD_SIZE_PX])
    network = tflite_file.TfliteNetwork(source(package, SSD_FILE)[SSD_BYTES])
    codes, logits = tflite_file.add_network(graph, network, image)
    flat = [graph.add("Squeeze", tensor, graph.constant([0], np.int64)) for tensor in (codes, logits)]
    # The first name is none.
    named = graph.add("Slice", flat[1], *(graph.constant([i], np.int64) for i in (1, 24, 1)))
    graph.add("Sigmoid", named, output="scores")
    anchors = ssd_anchors()
    graph.add_output("boxes", [len(anchors), 4])
    graph.add_output("scores", [len(anchors), 23])
    scaled = graph.add("Mul", flat[0], graph.constant([SSD_VARIANCES]))
    y, x, h, w = graph.add("Split", scaled, outputs=4, axis=1)
    place = graph.add("Concat", x, y, axis=1)
    growth = graph.add("Exp", graph.add("Concat", w, h, axis=1))
    shapes = graph.constant(anchors[:, 2:])
    corners(graph, graph.add("Add", graph.add("Mul", place, shapes), graph.constant(anchors[:, :2])),
            graph.add("Mul", growth, shapes))
    return graph.serialised()


# ----------------------------------------------------------------------------------------- nanodet

NANODET_SIZE_PX = 416
NANODET_STRIDES = (8, 16, 32)
NANODET_STEPS = 11  # a distance is a distribution over 0 ... 10 strides
NANODET_NAMES = 80


def nanodet_centres() -> np.ndarray:
    """[boxes, 3] x and y of each box's origin, and the stride, all as shares of the image."""
    rows = []
    for stride in NANODET_STRIDES:
        side = NANODET_SIZE_PX // stride
        y, x = np.mgrid[:side, :side]
        rows.append(np.stack([x.ravel() + 0.5, y.ravel() + 0.5, np.ones(side * side)], 1) / side)
    return np.concatenate(rows)


def nanodet_network(package) -> bytes:
    graph = Graph("nanodet")
    image = graph.add_input("image", [1, 3, NANODET_SIZE_PX, NANODET_SIZE_PX])
    # It was trained on blue, green and red.
    swapped = graph.add("Gather", image, graph.constant([2, 1, 0], np.int64), axis=1)
    outputs = tfjs_graph.add_network(graph, source(package, "nanodet.json"),
                                     source(package, "nanodet.bin"), swapped)
    names = ["Identity", "Identity_1", "Identity_2"]  # from the finest stride on
    scores = graph.add("Concat", *(outputs[name] for name in names), axis=1)
    steps = graph.add("Concat", *(outputs[f"Identity_{i + 3}"] for i in range(3)), axis=1)
    centres = nanodet_centres()
    count = len(centres)
    graph.add("Reshape", scores, graph.constant([count, NANODET_NAMES], np.int64), output="scores")
    graph.add_output("boxes", [count, 4])
    graph.add_output("scores", [count, NANODET_NAMES])
    steps = graph.add("Reshape", steps, graph.constant([count, 4, NANODET_STEPS], np.int64))
    share = graph.add("Softmax", steps, axis=-1)
    distance = graph.add("MatMul", share, graph.constant(np.arange(NANODET_STEPS)))
    sides = graph.constant(centres[:, 2:] * [[-1, -1, 1, 1]])
    graph.add("Add", graph.add("Mul", distance, sides), graph.constant(np.tile(centres[:, :2], 2)),
              output="boxes")
    return graph.serialised()


DETECTORS = {"objectron": objectron_network, "nanodet": nanodet_network}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("detector", choices=sorted(DETECTORS))
    parser.add_argument("package", type=pathlib.Path, help="folder with the package's files")
    parser.add_argument("model", type=pathlib.Path, help="model folder to write")
    args = parser.parse_args()

    try:
        network = DETECTORS[args.detector](args.package)
    except (tfjs_graph.TfjsError, tflite_file.TfliteError) as error:
        sys.exit(f"build_detectors: {args.package}: {error}")
    yaml = (HERE / f"{args.detector}.yaml").read_text()
    (expected,) = re.findall(r"^  detector\.onnx: ([0-9a-f]{64})$", yaml, re.MULTILINE)
    if sha256(network) != expected:
        sys.exit(f"build_detectors: {args.detector} came out with SHA-256 {sha256(network)}, expected "
                 f"{expected}; install the versions of tools/requirements.txt")
    args.model.mkdir(parents=True, exist_ok=True)
    (args.model / "detector.onnx").write_bytes(network)
    (args.model / "model.yaml").write_text(yaml)


if __name__ == "__main__":
    main()
