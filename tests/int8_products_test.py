# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A network whose products are of bytes answers nearly what it answered, by ONNX's own reference."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tools" / "models"))
try:
    import int8_products
    import numpy as np
    import onnx
    from onnx import TensorProto, helper, numpy_helper
    from onnx.reference import ReferenceEvaluator
except ImportError as missing:  # the tools' packages are set up by tools/setup.sh
    print(f"skipped: {missing}; tools/setup.sh installs what the model tools need")
    sys.exit(77)

ROWS, WIDE, NARROW = 7, 96, 3
RANDOM = np.random.default_rng(3)


def weights(name, *shape):
    return numpy_helper.from_array(RANDOM.normal(size=shape).astype(np.float32), name)


def network():
    """Two large products of one input, one of their sum, and one that is too small to gain."""
    nodes = [
        helper.make_node("MatMul", ["x", "first"], ["a"]),
        helper.make_node("MatMul", ["x", "second"], ["b"]),
        helper.make_node("Add", ["a", "b"], ["sum"]),
        helper.make_node("MatMul", ["sum", "third"], ["c"]),
        helper.make_node("MatMul", ["c", "small"], ["y"]),
    ]
    constants = [weights("first", WIDE, WIDE), weights("second", WIDE, WIDE), weights("third", WIDE, WIDE), weights("small", WIDE, NARROW)]
    constants[2] = numpy_helper.from_array(numpy_helper.to_array(constants[2]) * (np.arange(WIDE) > 0).astype(np.float32), "third")
    given, made = (helper.make_tensor_value_info(*of) for of in (("x", TensorProto.FLOAT, [ROWS, WIDE]), ("y", TensorProto.FLOAT, [ROWS, NARROW])))
    return helper.make_model(helper.make_graph(nodes, "graph", [given], [made], constants), opset_imports=[helper.make_opsetid("", 17)])


class Int8ProductsTest(unittest.TestCase):
    def test_it_answers_nearly_the_same_in_a_quarter_of_the_weights(self):
        whole = network()
        rounded = onnx.load_from_string(int8_products.in_int8(whole.SerializeToString()))
        x = {"x": RANDOM.normal(size=(ROWS, WIDE)).astype(np.float32)}
        [exact], [near] = (ReferenceEvaluator(of).run(None, x) for of in (whole, rounded))
        off = np.linalg.norm(near - exact) / np.linalg.norm(exact)
        self.assertGreater(off, 0)  # it was rounded
        self.assertLess(off, 0.02)
        bytes_of = [sum(len(constant.raw_data) for constant in of.graph.initializer) for of in (whole, rounded)]
        self.assertLess(bytes_of[1], 0.3 * bytes_of[0])

    def test_what_several_products_take_is_rounded_once_and_small_ones_are_left(self):
        rounded = onnx.load_from_string(int8_products.in_int8(network().SerializeToString()))
        kinds = [node.op_type for node in rounded.graph.node]
        self.assertEqual((kinds.count("DynamicQuantizeLinear"), kinds.count("MatMulInteger"), kinds.count("MatMul")), (2, 3, 1))

    def test_each_column_has_its_own_step(self):
        values, steps = int8_products.quantised(np.array([[1.0, 200.0, 0.0], [-0.5, 50.0, 0.0]], np.float32))
        self.assertEqual(values.tolist(), [[127, 127, 0], [-64, 32, 0]])
        np.testing.assert_allclose(values[0, :2] * steps[:2], [1, 200], rtol=1e-6)


if __name__ == "__main__":
    unittest.main()
