# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Reads networks in TensorFlow Lite's format (a FlatBuffer) and writes them as ONNX nodes.

Only what a float network of convolutions needs: an unknown operator is an error, never a guess.
The positions of fields are those of TensorFlow Lite's schema, version 3.
"""

import struct
from dataclasses import dataclass

import numpy as np


class TfliteError(Exception):
    """The file is damaged, or holds what is not supported."""


class _Table:
    """A table of a FlatBuffer: fields by their number in the schema."""

    def __init__(self, data: bytes, position: int):
        self.data, self.position = data, position
        self.vtable = position - struct.unpack_from("<i", data, position)[0]
        (self.vtable_size,) = struct.unpack_from("<H", data, self.vtable)

    def _place(self, field):
        entry = 4 + 2 * field
        if entry >= self.vtable_size:
            return None
        (offset,) = struct.unpack_from("<H", self.data, self.vtable + entry)
        return self.position + offset if offset else None

    def scalar(self, field, layout="<i", default=0):
        place = self._place(field)
        return default if place is None else struct.unpack_from(layout, self.data, place)[0]

    def _target(self, field):
        place = self._place(field)
        return None if place is None else place + struct.unpack_from("<I", self.data, place)[0]

    def table(self, field):
        target = self._target(field)
        return None if target is None else _Table(self.data, target)

    def array(self, field, dtype):
        target = self._target(field)
        if target is None:
            return np.empty(0, dtype)
        (count,) = struct.unpack_from("<I", self.data, target)
        return np.frombuffer(self.data, dtype, count, target + 4)

    def tables(self, field):
        places = self.array(field, "<u4")
        first = (self._target(field) or 0) + 4
        return [_Table(self.data, first + 4 * i + int(at)) for i, at in enumerate(places)]


# Of the schema's enumerations, what is used.
TYPES = {0: np.float32, 1: np.float16, 2: np.int32}
ADD, CONCATENATION, CONV_2D, DEPTHWISE_CONV_2D, DEQUANTIZE, RESHAPE = 0, 2, 3, 4, 6, 22
SAME, VALID = 0, 1
NO_ACTIVATION, RELU6 = 0, 3


@dataclass
class Tensor:
    shape: list
    values: np.ndarray | None  # None: not a constant


@dataclass
class Operator:
    code: int
    inputs: list
    outputs: list
    options: _Table


class TfliteNetwork:
    """The one subgraph of a file."""

    def __init__(self, data: bytes):
        try:
            if data[4:8] != b"TFL3":
                raise TfliteError("no TensorFlow Lite file")
            model = _Table(data, struct.unpack_from("<I", data)[0])
            (subgraph,) = model.tables(2)
            buffers = [buffer.array(0, np.uint8) for buffer in model.tables(4)]
            # Codes beyond 127 are in a field of their own, the fourth.
            codes = [max(c.scalar(0, "<b"), c.scalar(3)) for c in model.tables(1)]
            self.tensors = [self._tensor(table, buffers) for table in subgraph.tables(0)]
            self.inputs = [int(i) for i in subgraph.array(1, "<i4")]
            self.outputs = [int(i) for i in subgraph.array(2, "<i4")]
            self.operators = [
                Operator(codes[o.scalar(0, "<I")], [int(i) for i in o.array(1, "<i4")],
                         [int(i) for i in o.array(2, "<i4")], o.table(4))
                for o in subgraph.tables(3)
            ]
        except (struct.error, ValueError, IndexError, KeyError) as error:
            raise TfliteError(f"a damaged or unknown TensorFlow Lite file ({error})") from error

    @staticmethod
    def _tensor(table, buffers):
        shape = [int(side) for side in table.array(0, "<i4")]
        raw = buffers[table.scalar(2, "<I")]
        kind = table.scalar(1, "<b")
        return Tensor(shape, raw.view(TYPES[kind]).reshape(shape) if raw.size else None)


class _Writer:
    """What convolutions read and write becomes ONNX's [N, C, H, W]; the rest keeps its layout."""

    def __init__(self, graph, network):
        self.graph, self.network, self.names = graph, network, {}
        self.plain = set()  # tensors that keep TensorFlow's layout
        self.values = {}  # constants, after DEQUANTIZE

    def constant(self, index):
        values = self.values.get(index)
        return self.network.tensors[index].values if values is None else values

    def activated(self, name, operator, field):
        kind = operator.options.scalar(field, "<b")
        if kind == NO_ACTIVATION:
            return name
        if kind != RELU6:
            raise TfliteError(f"activation {kind} is not supported")
        return self.graph.add("Clip", name, self.graph.constant(0), self.graph.constant(6))

    def convolution(self, operator, depthwise):
        source, kernel, bias = operator.inputs
        if source in self.plain:
            raise TfliteError("a convolution of what was reshaped is not supported")
        weights = self.constant(kernel)  # [out, h, w, in], depthwise [1, h, w, out]
        weights = weights.transpose(3, 0, 1, 2) if depthwise else weights.transpose(0, 3, 1, 2)
        options = operator.options
        strides = [options.scalar(2), options.scalar(1)]
        size = self.network.tensors[source].shape[1:3]
        pads = same_pads(size, weights.shape[2:], strides) if options.scalar(0, "<b") == SAME else [0] * 4
        result = self.graph.add(
            "Conv", self.names[source], self.graph.constant(weights),
            self.graph.constant(self.constant(bias)), strides=strides, pads=pads,
            kernel_shape=list(weights.shape[2:]), group=weights.shape[0] if depthwise else 1)
        return self.activated(result, operator, 4 if depthwise else 3)

    def reshape(self, operator):
        source, target = operator.inputs[0], operator.outputs[0]
        name = self.names[source]
        if source not in self.plain:
            name = self.graph.add("Transpose", name, perm=[0, 2, 3, 1])
        self.plain.add(target)
        shape = self.network.tensors[target].shape
        return self.graph.add("Reshape", name, self.graph.constant(shape, np.int64))

    def concatenation(self, operator):
        if not self.plain.issuperset(operator.inputs):
            raise TfliteError("images put side by side are not supported")
        self.plain.add(operator.outputs[0])
        return self.graph.add("Concat", *(self.names[i] for i in operator.inputs),
                              axis=operator.options.scalar(0))

    def write(self, operator):
        code, target = operator.code, operator.outputs[0]
        if code == DEQUANTIZE:
            self.values[target] = self.constant(operator.inputs[0]).astype(np.float32)
        elif code in (CONV_2D, DEPTHWISE_CONV_2D):
            self.names[target] = self.convolution(operator, code == DEPTHWISE_CONV_2D)
        elif code == ADD:
            if not self.plain.isdisjoint(operator.inputs):
                raise TfliteError("a sum of what was reshaped is not supported")
            a, b = (self.names[i] for i in operator.inputs)
            self.names[target] = self.activated(self.graph.add("Add", a, b), operator, 0)
        elif code == RESHAPE:
            self.names[target] = self.reshape(operator)
        elif code == CONCATENATION:
            self.names[target] = self.concatenation(operator)
        else:
            raise TfliteError(f"operator {code} is not supported")


def same_pads(size, kernel, strides):
    """ONNX's pads (top, left, bottom, right) for TensorFlow's "SAME": what is odd goes to the end."""
    pads = []
    for side, width, stride in zip(size, kernel, strides):
        pads.append(max((-(-side // stride) - 1) * stride + width - side, 0))
    return [pad // 2 for pad in pads] + [pad - pad // 2 for pad in pads]


def add_network(graph, network, image):
    """Names of the network's outputs; `image` [1, 3, H, W] is its one input."""
    writer = _Writer(graph, network)
    (source,) = network.inputs
    writer.names[source] = image
    for operator in network.operators:
        writer.write(operator)
    return [writer.names[index] for index in network.outputs]
