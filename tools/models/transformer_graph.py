# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes down the parts that transformers are made of, for a graph that is to be edited (onnx_graph.py writes whole ones)."""

import numpy as np
from onnx import helper, numpy_helper


class Graph:
    """Nodes and constants, named by number."""

    def __init__(self):
        self.nodes, self.constants = [], []

    def constant(self, value):
        name = f"few.c{len(self.constants)}"
        self.constants.append(numpy_helper.from_array(np.ascontiguousarray(value), name))
        return name

    def add(self, operation, *inputs, result="", **attributes):
        names = [self.constant(value) if isinstance(value, (np.ndarray, np.generic)) else value for value in inputs]
        result = result or f"few.t{len(self.nodes)}"
        self.nodes.append(helper.make_node(operation, names, [result], **attributes))
        return result

    def length(self, x, axis):
        """[1]: how many there are along an axis."""
        return self.add("Gather", self.add("Shape", x), np.array([axis]))

    def reshape(self, x, *shape, result=""):
        return self.add("Reshape", x, np.array(shape, np.int64), result=result)

    def transpose(self, x, *order):
        return self.add("Transpose", x, perm=order)

    def linear(self, x, weights, relu=False):
        weight, bias = weights
        made = self.add("Add", self.add("MatMul", x, weight), bias)
        return self.add("Relu", made) if relu else made

    def norm(self, x, weights, epsilon, result=""):
        return self.add("LayerNormalization", x, *weights, result=result, axis=-1, epsilon=epsilon)

    def gelu(self, x):
        """As runtimes know it to be one."""
        half = self.add("Add", self.add("Erf", self.add("Div", x, np.float32(np.sqrt(2)))), np.float32(1))
        return self.add("Mul", self.add("Mul", x, half), np.float32(0.5))
