# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes ONNX graphs node by node."""

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

# What ONNX Runtime 1.21 loads.
OPSET = 17
IR_VERSION = 8


class Graph:
    """A graph under construction. Tensors are known by their names."""

    def __init__(self, name: str):
        self.name = name
        self.nodes, self.constants, self.inputs, self.outputs = [], [], [], []

    def add_input(self, name, shape, element_type=TensorProto.FLOAT):
        self.inputs.append(helper.make_tensor_value_info(name, element_type, shape))
        return name

    def add_output(self, name, shape):
        self.outputs.append(helper.make_tensor_value_info(name, TensorProto.FLOAT, shape))

    def constant(self, values, dtype=np.float32):
        name = f"c{len(self.constants)}"
        array = np.ascontiguousarray(values, dtype=dtype)
        self.constants.append(numpy_helper.from_array(array, name))
        return name

    def half_constant(self, values):
        """Stored in 16 bits, used in 32."""
        return self.add("Cast", self.constant(values, np.float16), to=TensorProto.FLOAT)

    def add(self, op, *inputs, output=None, outputs=1, **attributes):
        """The name of the node's output, or a list of names when it has several."""
        names = [output] if output else [f"t{len(self.nodes)}_{i}" for i in range(outputs)]
        self.nodes.append(helper.make_node(op, list(inputs), names, **attributes))
        return names[0] if len(names) == 1 else names

    def l2_normalised(self, tensor, output=None):
        """Rows of length 1; a row of zeros stays one."""
        norm = self.add("ReduceL2", tensor, axes=[-1], keepdims=1)
        return self.add("Div", tensor, self.add("Max", norm, self.constant(1e-12)), output=output)

    def serialised(self) -> bytes:
        graph = helper.make_graph(self.nodes, self.name, self.inputs, self.outputs, self.constants)
        model = helper.make_model(
            graph,
            opset_imports=[helper.make_opsetid("", OPSET)],
            ir_version=IR_VERSION,
            producer_name="ovimap",
        )
        onnx.checker.check_model(model, full_check=True)
        return model.SerializeToString(deterministic=True)
