#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Makes src/ovimap/inference/testdata/golden_detector: a detector whose boxes are the four quarters
of the picture, and whose scores are how red, green and blue each is on the mean."""

import hashlib
import pathlib

import numpy as np

from onnx_graph import Graph

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "src/ovimap/inference/testdata/golden_detector"
SIZE_PX = 8
YAML = """# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
kind: detector
name: golden detector
license: Apache-2.0
source: tools/models/make_golden_detector.py
input: {{size: {size}, resize: stretch, mean: [0, 0, 0], std: [255, 255, 255]}}
floor: 0.03
slope: 2
offset: -1
names: |
  red;0.05
  green|lime;0.05
  blue;0.05
networks:
  detector: {{file: detector.onnx, inputs: {{image: image}}, outputs: {{boxes: boxes, scores: scores}}}}
sha256:
  detector.onnx: {digest}
"""


def network() -> bytes:
    graph = Graph("golden_detector")
    image = graph.add_input("image", [1, 3, SIZE_PX, SIZE_PX])
    half = SIZE_PX // 2
    means = graph.add("AveragePool", image, kernel_shape=[half, half], strides=[half, half])
    rows = graph.add("Reshape", means, graph.constant([3, 4], np.int64))
    graph.add("Transpose", rows, perm=[1, 0], output="scores")
    corners = [(x, y, x + 0.5, y + 0.5) for y in (0, 0.5) for x in (0, 0.5)]
    graph.add("Identity", graph.constant(corners), output="boxes")
    graph.add_output("boxes", [4, 4])
    graph.add_output("scores", [4, 3])
    return graph.serialised()


def main():
    data = network()
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "detector.onnx").write_bytes(data)
    digest = hashlib.sha256(data).hexdigest()
    (FOLDER / "model.yaml").write_text(YAML.format(size=SIZE_PX, digest=digest))


if __name__ == "__main__":
    main()
