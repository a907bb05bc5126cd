# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""MobileSAM's image encoder (TinyViT, Wu et al., ECCV 2022) written so that it costs as much as the picture has rows.

The published graph takes squares: below a picture of 4 to 3 a quarter of all work is on nothing. This one takes as many rows as there
are, a multiple of 16. Of a square it says what the published graph says, to rounding; of fewer rows what is above the last windows,
and in those what the network says at the right border of every square, where its windows reach over as well.
"""

import numpy as np
from onnx import numpy_helper
from transformer_graph import Graph

HEAD = 32  # channels of a head
LAYERS = [(2, 7), (6, 14), (2, 7)]  # of windows: blocks, side of a window in places
STEP = 16  # a place of the last layer is so many pixels wide


class Weights:
    """Of the published graph: convolutions in their order, all else by the names of its nodes."""

    def __init__(self, graph):
        self._values = {i.name: numpy_helper.to_array(i) for i in graph.initializer}
        self._values |= {n.output[0]: numpy_helper.to_array(n.attribute[0].t) for n in graph.node if n.op_type == "Constant"}
        self._nodes = {n.name: n for n in graph.node}
        self._convolutions = iter([n for n in graph.node if n.op_type == "Conv"])

    def next_convolution(self):
        """Weight and, if it has one, bias; stride, padding and groups."""
        node = next(self._convolutions)
        attributes = {a.name: list(a.ints) if a.ints else a.i for a in node.attribute}
        return [self._values[name] for name in node.input[1:]], attributes

    def of_node(self, name):
        """The constant that a node takes."""
        return next(self._values[i] for i in self._nodes[name].input if i in self._values)

    def linear(self, layer):
        return self.of_node(f"/{layer}/MatMul"), self.of_node(f"/{layer}/Add")

    def norm(self, layer):
        return self._values[f"{layer}.weight"], self._values[f"{layer}.bias"]

    def channel_norm(self, layer):
        return self.of_node(f"/{layer}/Mul"), self.of_node(f"/{layer}/Add_1")


class Encoder:
    """Of pictures `columns` wide."""

    def __init__(self, weights, columns):
        self.g, self.w, self._columns = Graph(), weights, columns

    def convolution(self, x):
        weights, attributes = self.w.next_convolution()
        return self.g.add("Conv", x, *weights, **attributes)

    def three_convolutions(self, x):
        for _ in range(2):
            x = self.g.gelu(self.convolution(x))
        return self.convolution(x)

    def in_order(self, x):
        """[1, channels, rows, columns] to [1, rows, columns, channels]."""
        return self.g.transpose(x, 0, 2, 3, 1)

    def as_channels(self, x):
        return self.g.transpose(x, 0, 3, 1, 2)

    def attended(self, x, layer):
        """[windows, places, channels]: what the places of each window see of each other."""
        g, (weight, bias) = self.g, self.w.linear(f"{layer}/qkv")
        channels = len(weight)
        heads = channels // HEAD
        parts = zip(np.split(weight.reshape(channels, heads, -1), 3, axis=2), np.split(bias.reshape(heads, -1), 3, axis=1))
        parts = [(w.reshape(channels, -1), b.ravel()) for w, b in parts]
        parts[0] = tuple(part * np.float32(HEAD**-0.5) for part in parts[0])
        q, k, v = (g.reshape(g.linear(x, part), 0, 0, heads, HEAD) for part in parts)
        scores = g.add("MatMul", g.transpose(q, 0, 2, 1, 3), g.transpose(k, 0, 2, 3, 1))
        shares = g.add("Softmax", g.add("Add", scores, self.w.of_node(f"/{layer}/Add")), axis=-1)
        seen = g.transpose(g.add("MatMul", shares, g.transpose(v, 0, 2, 1, 3)), 0, 2, 1, 3)
        return g.linear(g.reshape(seen, 0, 0, channels), self.w.linear(f"{layer}/proj"))

    def in_windows(self, x, layer, side, columns):
        """Attention of [1, rows, columns, channels]; windows may reach over the right and the lower border, where all is 0."""
        g, norm = self.g, self.w.norm(f"{layer.replace('/', '.')}.norm")
        rows, across, channels = g.length(x, 1), -(-columns // side), len(norm[0])
        below = g.add("Mod", g.add("Sub", np.array([side]), g.add("Mod", rows, np.array([side]))), np.array([side]))
        pads = g.add("Concat", np.zeros(5, np.int64), below, np.array([across * side - columns, 0]), axis=0)
        windows = g.reshape(g.add("Pad", x, pads), -1, side, across, side, channels)
        windows = g.reshape(g.transpose(windows, 0, 2, 1, 3, 4), -1, side * side, channels)
        seen = self.attended(g.norm(windows, norm, 1e-5), layer)
        seen = g.transpose(g.reshape(seen, -1, across, side, side, channels), 0, 2, 1, 3, 4)
        ends = g.add("Concat", rows, np.array([columns]), axis=0)
        return g.add("Slice", g.reshape(seen, 1, -1, across * side, channels), np.zeros(2, np.int64), ends, np.array([1, 2]))

    def block(self, x, layer, side, columns):
        g, name = self.g, layer.replace("/", ".")
        x = g.add("Add", x, self.in_windows(x, f"{layer}/attn", side, columns))
        x = self.in_order(self.convolution(self.as_channels(x)))
        wide = g.gelu(g.linear(g.norm(x, self.w.norm(f"{name}.mlp.norm"), 1e-5), self.w.linear(f"{layer}/mlp/fc1")))
        return g.add("Add", x, g.linear(wide, self.w.linear(f"{layer}/mlp/fc2")))

    def run(self, image, result):
        """From [1, 3, rows, columns] to [1, 256, rows / STEP, columns / STEP]."""
        g = self.g
        x = self.convolution(g.gelu(self.convolution(image)))
        for _ in range(2):
            x = g.gelu(g.add("Add", x, self.three_convolutions(x)))
        for number, (blocks, side) in enumerate(LAYERS, start=1):
            x = self.in_order(self.three_convolutions(x))
            for block in range(blocks):
                x = self.block(x, f"layers.{number}/blocks.{block}", side, self._columns // min(4 << number, STEP))
            x = self.as_channels(x)
        for layer in ("neck/neck.1", "neck/neck.3"):
            weight, bias = (part.ravel() for part in self.w.channel_norm(layer))
            x = self.as_channels(g.norm(self.in_order(self.convolution(x)), (weight, bias), 1e-6))
        g.add("Identity", x, result=result)
        return g
