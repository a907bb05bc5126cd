# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Reads networks in TensorFlow.js' graph format and writes them as ONNX nodes.

Only what networks of convolutions need that came from ONNX in the first place: an unknown operator
is an error, never a guess. Every tensor keeps TensorFlow's layout, transposed around each
convolution; ONNX Runtime takes out what cancels.
"""

import base64
import json

import numpy as np

TO_ONNX, TO_TENSORFLOW = [0, 3, 1, 2], [0, 2, 3, 1]


class TfjsError(Exception):
    """The file is damaged, or holds what is not supported."""


def read_constants(manifest, data: bytes) -> dict:
    """Name -> array; 16-bit floats become 32-bit ones."""
    constants, position = {}, 0
    for entry in manifest:
        quantization = entry.get("quantization")
        dtype = np.dtype(quantization["dtype"] if quantization else entry["dtype"])
        count = int(np.prod(entry["shape"], dtype=np.int64))
        if position + count * dtype.itemsize > len(data):
            raise TfjsError(f"the weights are cut short: {entry['name']} is missing")
        values = np.frombuffer(data, dtype, count, position).reshape(entry["shape"])
        constants[entry["name"]] = values.astype(entry["dtype"])
        position += count * dtype.itemsize
    if position != len(data):
        raise TfjsError(f"{len(data) - position} bytes of weights belong to nothing")
    return constants


class _Writer:
    def __init__(self, graph, constants):
        self.graph, self.constants, self.names = graph, constants, {}

    def value(self, name):
        """A constant; shapes that TensorFlow computes of constants alone are computed here."""
        if name not in self.constants:
            raise TfjsError(f"{name} is no constant")
        return self.constants[name]

    def tensor(self, name):
        return self.names[name] if name in self.names else self.graph.constant(self.value(name))

    def windowed(self, node, source, *weights, **attributes):
        """An operator of ONNX on windows of an image, in TensorFlow's layout outside."""
        if base64.b64decode(node["attr"]["padding"]["s"]) != b"VALID":
            raise TfjsError(f"{node['name']} pads by itself, which is not supported")
        image = self.graph.add("Transpose", source, perm=TO_ONNX)
        result = self.graph.add(node["op"].removesuffix("2D"), image, *weights,
                                strides=integers(node, "strides")[1:3], **attributes)
        return self.graph.add("Transpose", result, perm=TO_TENSORFLOW)

    def convolution(self, node, source, kernel):
        weights = self.value(kernel).transpose(3, 2, 0, 1)
        return self.windowed(node, self.tensor(source), self.graph.constant(weights),
                             kernel_shape=list(weights.shape[2:]))

    def padded(self, source, pads, filling):
        ends = np.concatenate([self.value(pads)[:, 0], self.value(pads)[:, 1]])
        return self.graph.add("Pad", self.tensor(source), self.graph.constant(ends, np.int64),
                              self.graph.constant(filling))

    def resized(self, node, source, size):
        attributes = node["attr"]
        if not attributes["half_pixel_centers"]["b"] or attributes["align_corners"]["b"]:
            raise TfjsError(f"{node['name']} resizes in an unknown way")
        rows, columns = (int(side) for side in self.value(size))
        image = self.graph.add("Transpose", self.tensor(source), perm=TO_ONNX)
        shape = self.graph.add("Concat", self.graph.add("Shape", image, start=0, end=2),
                               self.graph.constant([rows, columns], np.int64), axis=0)
        result = self.graph.add("Resize", image, "", "", shape, mode="linear",
                                coordinate_transformation_mode="half_pixel")
        return self.graph.add("Transpose", result, perm=TO_TENSORFLOW)

    def write(self, node):
        op, name, inputs = node["op"], node["name"], node.get("input", [])
        if op == "Conv2D":
            self.names[name] = self.convolution(node, *inputs)
        elif op == "MaxPool":
            self.names[name] = self.windowed(node, self.tensor(inputs[0]),
                                             kernel_shape=integers(node, "ksize")[1:3])
        elif op in ("Pad", "PadV2"):
            self.names[name] = self.padded(*inputs[:2], self.value(inputs[2]) if op == "PadV2" else 0)
        elif op == "Transpose":
            self.names[name] = self.graph.add("Transpose", self.tensor(inputs[0]),
                                              perm=[int(i) for i in self.value(inputs[1])])
        elif op == "ResizeBilinear":
            self.names[name] = self.resized(node, *inputs)
        elif op == "LeakyRelu":
            self.names[name] = self.graph.add("LeakyRelu", self.tensor(inputs[0]),
                                              alpha=node["attr"]["alpha"]["f"])
        elif op == "ConcatV2":
            self.names[name] = self.graph.add("Concat", *(self.tensor(i) for i in inputs[:-1]),
                                              axis=int(self.value(inputs[-1])))
        elif op == "SplitV":
            parts = self.value(inputs[1])
            outputs = self.graph.add("Split", self.tensor(inputs[0]), self.graph.constant(parts, np.int64),
                                     outputs=len(parts), axis=int(self.value(inputs[2])))
            self.names.update({name if i == 0 else f"{name}:{i}": o for i, o in enumerate(outputs)})
        elif op == "Reshape":
            self.names[name] = self.graph.add("Reshape", self.tensor(inputs[0]),
                                              self.graph.constant(self.value(inputs[1]), np.int64))
        elif op == "SparseToDense" and self.value(inputs[0]).size == 0:
            self.constants[name] = np.full(self.value(inputs[1]), self.value(inputs[3]))
        elif op in ("Add", "AddV2") and all(i in self.constants for i in inputs):
            self.constants[name] = self.constants[inputs[0]] + self.constants[inputs[1]]
        elif op in ("Add", "AddV2", "Sigmoid"):
            self.names[name] = self.graph.add(op.removesuffix("V2"), *(self.tensor(i) for i in inputs))
        elif op == "Identity":
            self.names[name] = self.tensor(inputs[0])
        else:
            raise TfjsError(f"operator {op} is not supported")


def integers(node, attribute):
    return [int(i) for i in node["attr"][attribute]["list"]["i"]]


def add_network(graph, description: str, data: bytes, image) -> dict:
    """The network's outputs by their names there; `image` is its one input, in its layout."""
    model = json.loads(description)
    (group,) = model["weightsManifest"]
    writer = _Writer(graph, read_constants(group["weights"], data))
    outputs = {}
    for node in model["modelTopology"]["node"]:
        if node["op"] == "Placeholder":
            writer.names[node["name"]] = image
        elif node["op"] != "Const":
            writer.write(node)
        if node["op"] == "Identity":
            outputs[node["name"]] = writer.names[node["name"]]
    return outputs
