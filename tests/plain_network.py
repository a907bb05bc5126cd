# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What the plain networks of tests are made of, in NumPy as papers write it, and what a graph answers by ONNX's own reference."""

import math

import numpy as np
from onnx import TensorProto, helper
from onnx.reference import ReferenceEvaluator


def gelu(x):
    return x * (1 + np.vectorize(math.erf, otypes=[np.float32])(x / math.sqrt(2))) / 2


def normalized(x, epsilon):
    """Over the last axis."""
    return (x - x.mean(-1, keepdims=True)) / np.sqrt(x.var(-1, keepdims=True) + epsilon)


def attended(scores, values):
    shares = np.exp(scores - scores.max(-1, keepdims=True))
    return shares / shares.sum(-1, keepdims=True) @ values


def answers(graph, given, outputs):
    """Of nodes and constants, for inputs by name."""
    inputs = [helper.make_tensor_value_info(name, TensorProto.FLOAT, value.shape) for name, value in given.items()]
    made = [helper.make_tensor_value_info(name, TensorProto.FLOAT, None) for name in outputs]
    whole = helper.make_graph(graph.nodes, "graph", inputs, made, graph.constants)
    return ReferenceEvaluator(helper.make_model(whole, opset_imports=[helper.make_opsetid("", 17)])).run(None, given)
