#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a small model of kind writing, for tests without a download.

Its ink is anything dark on white. Its letters are colours: what is red, green and blue reads R, G and B, white between
two of them parts letters, and grey is a blank. On pictures of plain patches its answer is therefore known.
"""

import argparse
import hashlib
import pathlib

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

LINE_PX, STEP_PX = 16, 8
GAIN = 8.0  # of the logistic function that makes a brightness (-1 to 1) a probability of ink
# Classes by colour, planes blue, green, red from -1 to 1: none (white), R, G, B, blank (grey).
COLORS = np.array([[1, 1, 1], [-1, -1, 0.6], [-1, 0.6, -1], [0.6, -1, -1], [-0.3, -0.3, -0.3]], np.float32)
SHARPNESS = 6.0

MODEL_YAML = """# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Written by tools/models/make_golden_writing.py.
kind: writing
name: golden writing
license: Apache-2.0
source: tools/models/make_golden_writing.py
pixel_level: 0.5
area_level: 0.5
growth: 0
longest_side_px: 128
largest_scale: 1
line_height_px: {height}
least_confidence: 0.5
networks:
  detector: {{file: detector.onnx, inputs: {{image: x}}, outputs: {{probability: ink}}}}
  speller: {{file: speller.onnx, inputs: {{line: x}}, outputs: {{characters: classes}}}}
sha256:
  detector.onnx: {detector}
  speller.onnx: {speller}
"""


def info(name, shape):
    return helper.make_tensor_value_info(name, TensorProto.FLOAT, shape)


def model(name, nodes, inputs, outputs, constants):
    values = [numpy_helper.from_array(value, key) for key, value in constants.items()]
    graph = helper.make_graph(nodes, name, inputs, outputs, values)
    made = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)], ir_version=8)
    onnx.checker.check_model(made)
    return made


def detector():
    mean = np.full((1, 3, 1, 1), -GAIN / 3, np.float32)
    nodes = [helper.make_node("Conv", ["x", "mean"], ["dark"]), helper.make_node("Sigmoid", ["dark"], ["ink"])]
    return model("detector", nodes, [info("x", [1, 3, None, None])], [info("ink", [1, 1, None, None])], {"mean": mean})


def speller():
    """The class whose colour is nearest: -|x - c|^2 = 2 c.x - |c|^2 - |x|^2, of which the last is the same for all."""
    weights = (2 * SHARPNESS * COLORS)[:, :, None, None]
    offsets = -SHARPNESS * (COLORS**2).sum(1)
    nodes = [
        helper.make_node("AveragePool", ["x"], ["steps"], kernel_shape=[LINE_PX, STEP_PX], strides=[LINE_PX, STEP_PX]),
        helper.make_node("Conv", ["steps", "weights", "offsets"], ["scores"]),
        helper.make_node("Squeeze", ["scores", "height"], ["rows"]),
        helper.make_node("Transpose", ["rows"], ["columns"], perm=[0, 2, 1]),
        helper.make_node("Softmax", ["columns"], ["classes"], axis=2),
    ]
    constants = {"weights": weights, "offsets": offsets, "height": np.array([2], np.int64)}
    made = model("speller", nodes, [info("x", [1, 3, LINE_PX, None])], [info("classes", [1, None, len(COLORS)])], constants)
    helper.set_model_props(made, {"character": "R\nG\nB\n"})
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    digests = {}
    for name, network in (("detector", detector()), ("speller", speller())):
        data = network.SerializeToString(deterministic=True)
        (folder / f"{name}.onnx").write_bytes(data)
        digests[name] = hashlib.sha256(data).hexdigest()
    (folder / "model.yaml").write_text(MODEL_YAML.format(height=LINE_PX, **digests))


if __name__ == "__main__":
    main()
