# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The converters of detectors, on small networks in the formats of TensorFlow Lite and TensorFlow.js."""
import base64
import json
import pathlib
import struct
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools" / "models"))
try:
    import numpy as np
    import onnx.reference
    import build_detectors
    import tfjs_graph
    import tflite_file
    from onnx_graph import Graph
except ImportError as missing:  # the tools' packages are set up by tools/setup.sh
    print(f"skipped: {missing}; tools/setup.sh installs what the model tools need")
    sys.exit(77)


def run(graph, **inputs):
    return onnx.reference.ReferenceEvaluator(onnx.load_from_string(graph.serialised())).run(None, inputs)


def convolved(image, kernel, stride, pads):
    """Plain: image [H, W, in], kernel [h, w, in, out]."""
    image = np.pad(image, ((pads[0], pads[2]), (pads[1], pads[3]), (0, 0)))
    height, width = kernel.shape[:2]
    rows = (image.shape[0] - height) // stride + 1
    columns = (image.shape[1] - width) // stride + 1
    result = np.zeros((rows, columns, kernel.shape[3]))
    for y in range(rows):
        for x in range(columns):
            window = image[y * stride:y * stride + height, x * stride:x * stride + width]
            result[y, x] = np.einsum("hwi,hwio->o", window, kernel)
    return result


class TfjsTest(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(1)
        self.kernel = random.normal(size=(3, 3, 2, 4)).astype(np.float16)
        self.manifest = [
            {"name": "k", "shape": [3, 3, 2, 4], "dtype": "float32",
             "quantization": {"dtype": "float16", "original_dtype": "float32"}},
            {"name": "axis", "shape": [], "dtype": "int32"},
        ]
        self.data = self.kernel.tobytes() + np.int32(3).tobytes()
        valid = base64.b64encode(b"VALID").decode()
        self.nodes = [
            {"name": "x", "op": "Placeholder"},
            {"name": "c", "op": "Conv2D", "input": ["x", "k"],
             "attr": {"padding": {"s": valid}, "strides": {"list": {"i": ["1", "2", "2", "1"]}}}},
            {"name": "r", "op": "LeakyRelu", "input": ["c"], "attr": {"alpha": {"f": 0.1}}},
            {"name": "two", "op": "ConcatV2", "input": ["r", "r", "axis"]},
            {"name": "Identity", "op": "Identity", "input": ["two"]},
        ]

    def convert(self):
        text = json.dumps({"modelTopology": {"node": self.nodes},
                           "weightsManifest": [{"weights": self.manifest}]})
        graph = Graph("test")
        image = graph.add_input("image", [1, 7, 7, 2])
        outputs = tfjs_graph.add_network(graph, text, self.data, image)
        graph.add("Identity", outputs["Identity"], output="out")
        graph.add_output("out", [1, 3, 3, 8])
        return graph

    def test_computes_what_tensorflow_would(self):
        image = np.random.default_rng(2).normal(size=(1, 7, 7, 2)).astype(np.float32)
        expected = convolved(image[0], self.kernel.astype(np.float64), 2, (0, 0, 0, 0))
        expected = np.where(expected > 0, expected, 0.1 * expected)
        (out,) = run(self.convert(), image=image)
        np.testing.assert_allclose(out[0], np.concatenate([expected] * 2, 2), atol=1e-4)

    def test_refuses_what_it_does_not_know(self):
        self.nodes[2]["op"] = "Elu"
        with self.assertRaisesRegex(tfjs_graph.TfjsError, "operator Elu"):
            self.convert()

    def test_refuses_weights_of_another_size(self):
        self.data = self.data[:-1]
        with self.assertRaisesRegex(tfjs_graph.TfjsError, "cut short: axis"):
            self.convert()
        self.data += b"12345"
        with self.assertRaisesRegex(tfjs_graph.TfjsError, "belong to nothing"):
            self.convert()


class FlatBuffer:
    """Writes tables from the end of the file to its start, as FlatBuffers are read."""

    def __init__(self):
        self.data = b""

    def __len__(self):
        return len(self.data)

    def put(self, data, align=4):
        """Puts it in front; returns its place from the end."""
        self.data = data + b"\0" * (-(len(data) + len(self.data)) % align) + self.data
        return len(self.data)

    def vector(self, values, dtype="<i4"):
        values = np.asarray(values, dtype)
        return self.put(struct.pack("<I", values.size) + values.tobytes())

    def offsets(self, places):
        start = len(self.data) + 4 * len(places)
        return self.put(struct.pack("<I", len(places)) + b"".join(
            struct.pack("<I", start - 4 * i - place) for i, place in enumerate(places)))

    def table(self, fields):
        """`fields`: number -> ("offset", place) or (layout, value)."""
        size = 4 + 4 * len(fields)
        entries = [0] * (max(fields, default=-1) + 1)
        body, start = b"", len(self.data) + size
        for i, (number, (layout, value)) in enumerate(fields.items()):
            entries[number] = 4 + 4 * i
            here = start - 4 - 4 * i
            raw = struct.pack("<I", here - value) if layout == "offset" else struct.pack(layout, value)
            body += raw + b"\0" * (4 - len(raw))
        place = self.put(struct.pack("<i", 0) + body)
        vtable = struct.pack("<HH", 4 + 2 * len(entries), size) + struct.pack(f"<{len(entries)}H", *entries)
        distance = self.put(vtable) - place
        at = len(self.data) - place
        self.data = self.data[:at] + struct.pack("<i", distance) + self.data[at + 4:]
        return place


def small_network(padding=tflite_file.SAME, code=tflite_file.DEPTHWISE_CONV_2D):
    """A convolution of 5x5x2 with stride 2 and ReLU6, its answer as rows; kernel and bias."""
    random = np.random.default_rng(3)
    depthwise = code == tflite_file.DEPTHWISE_CONV_2D
    kernel = random.normal(size=(1, 3, 3, 2) if depthwise else (2, 3, 3, 2)).astype(np.float16)
    bias = random.normal(size=2).astype(np.float32)
    file = FlatBuffer()
    buffers = [file.table({0: ("offset", file.vector(np.frombuffer(data.tobytes(), np.uint8), "<u1"))})
               for data in (kernel, bias)]
    buffers = file.offsets([file.table({})] + buffers)
    side = 3 if padding == tflite_file.SAME else 2

    def tensor(shape, kind, buffer=0):
        return file.table({0: ("offset", file.vector(shape)), 1: ("<b", kind), 2: ("<I", buffer)})

    tensors = file.offsets([tensor([1, 5, 5, 2], 0), tensor(kernel.shape, 1, 1), tensor([2], 0, 2),
                            tensor(kernel.shape, 0), tensor([1, side, side, 2], 0),
                            tensor([1, side * side, 2], 0)])
    options = file.table({0: ("<b", padding), 1: ("<i", 2), 2: ("<i", 2),
                          (4 if depthwise else 3): ("<b", tflite_file.RELU6)})

    def operator(index, inputs, outputs, extra=None):
        fields = {0: ("<I", index), 1: ("offset", file.vector(inputs)), 2: ("offset", file.vector(outputs))}
        return file.table(fields | ({4: ("offset", extra)} if extra else {}))

    operators = file.offsets([operator(0, [1], [3]), operator(1, [0, 3, 2], [4], options),
                              operator(2, [4], [5])])
    subgraph = file.table({0: ("offset", tensors), 1: ("offset", file.vector([0])),
                           2: ("offset", file.vector([5])), 3: ("offset", operators)})
    codes = file.offsets([file.table({0: ("<b", number)})
                          for number in (tflite_file.DEQUANTIZE, code, tflite_file.RESHAPE)])
    model = file.table({1: ("offset", codes), 2: ("offset", file.offsets([subgraph])), 4: ("offset", buffers)})
    root = file.put(b"TFL3")
    return struct.pack("<I", 4 + root - model) + file.data, kernel, bias


class TfliteTest(unittest.TestCase):
    def check(self, padding, code):
        data, kernel, bias = small_network(padding, code)
        graph = Graph("test")
        image = graph.add_input("image", [1, 2, 5, 5])
        (rows,) = tflite_file.add_network(graph, tflite_file.TfliteNetwork(data), image)
        side = 3 if padding == tflite_file.SAME else 2
        graph.add("Identity", rows, output="out")
        graph.add_output("out", [1, side * side, 2])
        picture = np.random.default_rng(4).normal(size=(5, 5, 2)).astype(np.float32)
        if code == tflite_file.DEPTHWISE_CONV_2D:
            full = np.zeros((3, 3, 2, 2))
            for channel in range(2):
                full[:, :, channel, channel] = kernel[0, :, :, channel]
        else:
            full = kernel.transpose(1, 2, 3, 0).astype(np.float64)
        pads = (1, 1, 1, 1) if padding == tflite_file.SAME else (0, 0, 0, 0)
        expected = np.clip(convolved(picture, full, 2, pads) + bias, 0, 6).reshape(1, -1, 2)
        (out,) = run(graph, image=picture.transpose(2, 0, 1)[None])
        np.testing.assert_allclose(out, expected, atol=1e-4)

    def test_computes_what_tensorflow_would(self):
        for padding in (tflite_file.SAME, tflite_file.VALID):
            for code in (tflite_file.CONV_2D, tflite_file.DEPTHWISE_CONV_2D):
                with self.subTest(padding=padding, code=code):
                    self.check(padding, code)

    def test_what_is_odd_is_padded_at_the_end(self):
        self.assertEqual(tflite_file.same_pads([6, 5], [3, 3], [2, 2]), [0, 1, 1, 1])

    def test_refuses_damage_and_unknown_operators(self):
        data = small_network()[0]
        for broken in (b"", data[:40], b"\0" * 64, data[:4] + b"TFL9" + data[8:]):
            with self.assertRaises(tflite_file.TfliteError):
                tflite_file.TfliteNetwork(broken)
        graph = Graph("test")
        network = tflite_file.TfliteNetwork(data)
        network.operators[1].code = 99
        with self.assertRaisesRegex(tflite_file.TfliteError, "operator 99"):
            tflite_file.add_network(graph, network, graph.add_input("image", [1, 2, 5, 5]))


class AnchorTest(unittest.TestCase):
    def test_ssd_has_one_for_each_box_that_the_network_scores(self):
        anchors = build_detectors.ssd_anchors()
        self.assertEqual(anchors.shape, (1917, 4))
        np.testing.assert_allclose(anchors[0], [0.5 / 19, 0.5 / 19, 0.1, 0.1])
        np.testing.assert_allclose(anchors[-1], [0.5, 0.5, np.sqrt(0.95), np.sqrt(0.95)])

    def test_nanodet_has_one_for_each_cell(self):
        centres = build_detectors.nanodet_centres()
        self.assertEqual(len(centres), 52 * 52 + 26 * 26 + 13 * 13)
        np.testing.assert_allclose(centres[1], [1.5 / 52, 0.5 / 52, 1 / 52])
        np.testing.assert_allclose(centres[-1], [12.5 / 13, 12.5 / 13, 1 / 13])


if __name__ == "__main__":
    unittest.main()
