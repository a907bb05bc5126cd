#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the small query-based model that tests kind `entity`, an image, and the ids it must give.

The network has Mask2Former's signature and fixed random weights. The expected ids and scores come
from NumPy alone: convolution, softmax, sigmoid, bilinear scaling and painting are written out here.
"""

import argparse
import hashlib
import pathlib
import struct
import zlib

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

INPUT_PX = 64  # side of the square input
CELL_PX = 4  # input pixels per mask pixel
QUERIES, CLASSES = 8, 3  # and one more class for "no object"
IMAGE_HW = (40, 64)  # the long side fills the input, so nothing is resampled on the way in
MEAN, STD = (120.0, 115.0, 100.0), (58.0, 57.0, 56.0)
MIN_SCORE, MIN_MASK_PX = 0.5, 40
MIN_MARGIN = 1e-4  # no pixel may lie so near a threshold that rounding decides

MODEL_YAML = """# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Written by tools/models/make_golden_entity.py.
kind: entity
name: golden entity network
license: Apache-2.0
source: tools/models/make_golden_entity.py
input: {{size: {size}, resize: long_side, mean: {mean}, std: {std}}}
networks:
  network:
    file: network.onnx
    inputs: {{image: pixel_values}}
    outputs: {{classes: class_queries_logits, masks: masks_queries_logits}}
sha256:
  network.onnx: {digest}
"""


def weights(rng):
    kernel = rng.normal(0, 0.22, (QUERIES, 3, CELL_PX, CELL_PX)).astype(np.float32)
    bias = rng.normal(0, 0.6, QUERIES).astype(np.float32)
    class_kernel = rng.normal(0, 15.0, (3, QUERIES * (CLASSES + 1))).astype(np.float32)
    return kernel, bias, class_kernel


def network(kernel, bias, class_kernel):
    def constant(name, values):
        return numpy_helper.from_array(values, name)

    nodes = [
        helper.make_node(
            "Conv",
            ["pixel_values", "kernel", "bias"],
            ["masks_queries_logits"],
            kernel_shape=[CELL_PX] * 2,
            strides=[CELL_PX] * 2,
        ),
        helper.make_node("ReduceMean", ["pixel_values"], ["mean"], axes=[2, 3], keepdims=0),
        helper.make_node("MatMul", ["mean", "class_kernel"], ["flat_classes"]),
        helper.make_node("Reshape", ["flat_classes", "class_shape"], ["class_queries_logits"]),
    ]
    side = INPUT_PX // CELL_PX

    def tensor(name, shape):
        return helper.make_tensor_value_info(name, TensorProto.FLOAT, shape)

    graph = helper.make_graph(
        nodes,
        "golden_entity",
        [tensor("pixel_values", [1, 3, INPUT_PX, INPUT_PX])],
        [
            tensor("class_queries_logits", [1, QUERIES, CLASSES + 1]),
            tensor("masks_queries_logits", [1, QUERIES, side, side]),
        ],
        [
            constant("kernel", kernel),
            constant("bias", bias),
            constant("class_kernel", class_kernel),
            constant("class_shape", np.array([1, QUERIES, CLASSES + 1], np.int64)),
        ],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    onnx.checker.check_model(model)
    return model.SerializeToString(deterministic=True)


def run(image, kernel, bias, class_kernel):
    """The network in NumPy: class logits [Q, C + 1] and mask logits [Q, side, side]."""
    x = np.zeros((3, INPUT_PX, INPUT_PX))
    height, width = image.shape[:2]
    x[:, :height, :width] = ((image - np.array(MEAN)) / np.array(STD)).transpose(2, 0, 1)
    side = INPUT_PX // CELL_PX
    cells = x.reshape(3, side, CELL_PX, side, CELL_PX)
    masks = np.einsum("cyaxb,qcab->qyx", cells, kernel.astype(float)) + bias[:, None, None]
    classes = x.mean(axis=(1, 2)) @ class_kernel.astype(float)
    return classes.reshape(QUERIES, CLASSES + 1), masks


def scale_up(mask, height, width):
    """Bilinear between cell centres, clamped at the edge of the cells that the image fills."""
    rows, columns = -(-height // CELL_PX), -(-width // CELL_PX)

    def axis(pixels, cells):
        at = np.clip((np.arange(pixels) + 0.5) / CELL_PX - 0.5, 0, cells - 1)
        low = np.floor(at).astype(int)
        return low, np.minimum(low + 1, cells - 1), at - low

    y0, y1, fy = axis(height, rows)
    x0, x1, fx = axis(width, columns)
    fy, fx = fy[:, None], fx[None, :]
    return (1 - fy) * ((1 - fx) * mask[np.ix_(y0, x0)] + fx * mask[np.ix_(y0, x1)]) + fy * (
        (1 - fx) * mask[np.ix_(y1, x0)] + fx * mask[np.ix_(y1, x1)]
    )


def expected_entities(image, parameters):
    """Ids, their scores, and the smallest distance of any decision from its threshold."""
    classes, masks = run(image, *parameters)
    probabilities = np.exp(classes) / np.exp(classes).sum(1, keepdims=True)
    best = probabilities[:, :-1].max(1)
    height, width = image.shape[:2]
    logits = [scale_up(m, height, width) for m in masks]
    scores = np.array(
        [
            b * (1 / (1 + np.exp(-g[g > 0]))).mean() if (g > 0).any() else 0.0
            for b, g in zip(best, logits)
        ]
    )
    margin = min(
        np.abs(scores - MIN_SCORE).min(),
        min(np.abs(g).min() for g in logits),
        np.diff(np.sort(scores)).min(),
    )
    ids = np.zeros((height, width), np.uint16)
    kept = []
    for query in np.argsort(scores):
        if scores[query] >= MIN_SCORE:
            kept.append(query)
            ids[logits[query] > 0] = len(kept)
    visible = [i + 1 for i in range(len(kept)) if (ids == i + 1).sum() >= MIN_MASK_PX]
    result = np.zeros_like(ids)
    for new, old in enumerate(visible):
        result[ids == old] = new + 1
    return result, [scores[kept[i - 1]] for i in visible], margin, len(kept)


def png(pixels):
    """A PNG of 8-bit colour [h, w, 3] or 16-bit grey [h, w]."""
    height, width = pixels.shape[:2]
    colour = pixels.ndim == 3
    rows = pixels.astype(">u2" if not colour else np.uint8).reshape(height, -1)
    raw = b"".join(b"\0" + row.tobytes() for row in rows)

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(
        ">IIBBBBB", width, height, 8 if colour else 16, 2 if colour else 0, 0, 0, 0
    )
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(raw, 9))
        + chunk(b"IEND", b"")
    )


def telling_case():
    """The first seed that drops queries and decides nothing near a threshold."""
    for seed in range(1000):
        rng = np.random.default_rng(seed)
        parameters = weights(rng)
        coarse = rng.integers(0, 256, (5, 8, 3))
        image = np.kron(coarse, np.ones((8, 8, 1))).astype(np.uint8)
        ids, scores, margin, kept = expected_entities(image, parameters)
        if 3 <= len(scores) < kept < QUERIES and margin > MIN_MARGIN and (ids == 0).sum() > 100:
            return image, parameters, ids, scores
    raise SystemExit("no seed gives a telling case")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help="the tests read testdata/golden_entity")
    folder = parser.parse_args().folder
    image, parameters, ids, scores = telling_case()
    data = network(*parameters)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "network.onnx").write_bytes(data)
    (folder / "model.yaml").write_text(
        MODEL_YAML.format(
            size=INPUT_PX, mean=list(MEAN), std=list(STD), digest=hashlib.sha256(data).hexdigest()
        )
    )
    (folder / "image.png").write_bytes(png(image))
    (folder / "ids.png").write_bytes(png(ids))
    (folder / "scores.txt").write_text("".join(f"{s:.6f}\n" for s in scores))


if __name__ == "__main__":
    main()
