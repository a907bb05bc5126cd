# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What the model tools read: PyTorch's old format, safetensors, names of furniture, words."""
import collections
import io
import json
import os
import pathlib
import pickle
import struct
import sys
import tempfile
import types
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools" / "models"))
try:
    import numpy as np
    import build_default_encoder
    import furniture_names
    import head_fit
    import weight_files
    import wordpiece
except ImportError as missing:  # the tools' packages are set up by tools/setup.sh
    print(f"skipped: {missing}; tools/setup.sh installs what the model tools need")
    sys.exit(77)


class Storage:
    """Stands for a storage while pickling: becomes a persistent id."""

    def __init__(self, kind, key, count, view=None):
        self.pid = ("storage", kind, key, "cpu", count, view)


class Tensor:
    def __init__(self, storage, offset, shape, strides):
        self.arguments = (storage, offset, shape, strides, False, collections.OrderedDict())

    def __reduce__(self):
        return sys.modules["torch._utils"]._rebuild_tensor_v2, self.arguments


class Command:
    """Pickled, it runs a command of the shell where it is read."""

    def __init__(self, line):
        self.line = line

    def __reduce__(self):
        return os.system, (self.line,)


class StatePickler(pickle.Pickler):
    def persistent_id(self, value):
        return value.pid if isinstance(value, Storage) else None


def fake_torch():
    """Modules of the names that PyTorch's pickles refer to."""
    torch, utils = types.ModuleType("torch"), types.ModuleType("torch._utils")

    def _rebuild_tensor_v2():
        """Only its name is written."""

    _rebuild_tensor_v2.__module__ = utils.__name__
    _rebuild_tensor_v2.__qualname__ = "_rebuild_tensor_v2"
    utils._rebuild_tensor_v2 = _rebuild_tensor_v2
    for name in ("FloatStorage", "LongStorage", "ByteTrap"):
        setattr(torch, name, type(name, (), {"__module__": "torch"}))
    return {"torch": torch, "torch._utils": utils}


def torch_file(state, storages) -> bytes:
    file = io.BytesIO()
    for value in (weight_files.TORCH_MAGIC, 1001, {"little_endian": True}):
        pickle.dump(value, file, protocol=2)
    StatePickler(file, protocol=2).dump(state)
    pickle.dump([key for key, _ in storages], file, protocol=2)
    for _, values in storages:
        file.write(struct.pack("<q", values.size) + values.tobytes())
    return file.getvalue()


class ReadingTest(unittest.TestCase):
    def setUp(self):
        sys.modules.update(fake_torch())
        self.torch = sys.modules["torch"]

    def tearDown(self):
        for name in ("torch", "torch._utils"):
            del sys.modules[name]

    def read(self, data, reader=None):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "weights"
            path.write_bytes(data)
            return (reader or weight_files.read_torch_file)(path)

    def kernel_file(self, **changes):
        tensor = {"offset": 1, "shape": (2, 3), "strides": (1, 2)} | changes
        numbers = np.arange(7, dtype="<f4")
        state = collections.OrderedDict(
            kernel=Tensor(Storage(self.torch.FloatStorage, "7", 7), *tensor.values()),
            steps=Tensor(Storage(self.torch.LongStorage, "9", 1), 0, (), ()),
        )
        return torch_file(state, [("9", np.array([5], "<i8")), ("7", numbers)])

    def test_tensors_are_strided_views_of_their_storages(self):
        tensors = self.read(self.kernel_file())
        # Element (r, c) lies at 1 + r + 2 c: a transposed matrix behind one number.
        np.testing.assert_array_equal(tensors["kernel"], [[1, 3, 5], [2, 4, 6]])
        self.assertTrue(tensors["kernel"].flags["C_CONTIGUOUS"])
        self.assertEqual(tensors["steps"], 5)

    def test_tensors_beyond_their_storage_are_refused(self):
        for changes in ({"offset": 2}, {"strides": (1, 3)}, {"offset": -1}, {"strides": (-1, 2)}):
            with self.subTest(changes), self.assertRaises(weight_files.WeightFileError):
                self.read(self.kernel_file(**changes))

    def test_damaged_files_are_refused(self):
        whole = self.kernel_file()
        for data in (b"", whole[:50], whole[:-3], pickle.dumps(1) + whole, b"PK\x03\x04" + whole):
            with self.subTest(size=len(data)), self.assertRaises(weight_files.WeightFileError):
                self.read(data)

    def test_pickles_that_name_other_code_are_refused(self):
        state = {"trap": Tensor(Storage(self.torch.ByteTrap, "1", 1), 0, (), ())}
        with self.assertRaisesRegex(weight_files.WeightFileError, "torch.ByteTrap"):
            self.read(torch_file(state, [("1", np.zeros(1, "<f4"))]))
        with self.assertRaisesRegex(weight_files.WeightFileError, "print"):
            self.read(pickle.dumps(print, protocol=2))

    def test_no_part_of_a_file_may_name_code(self):
        """Of the five pickles in a file, each is read by the same restricted reader."""
        marker = pathlib.Path(tempfile.gettempdir()) / f"weight_files_{os.getpid()}"
        code = pickle.dumps(Command(f"touch {marker}"), protocol=2)
        whole = self.kernel_file()
        keys = pickle.dumps(["9", "7"], protocol=2)
        self.assertIn(keys, whole)
        for data in (code, whole.replace(keys, code)):
            with self.subTest(size=len(data)), self.assertRaisesRegex(weight_files.WeightFileError, "names (posix|os).system"):
                self.read(data)
        self.assertFalse(marker.exists())

    def test_values_of_other_types_are_damage(self):
        for changes in ({"offset": "1"}, {"shape": (2, "3")}, {"shape": 5}, {"strides": (None, 1)}, {"shape": (-2, -3)},
                        {"shape": (10**12, 10**6), "strides": (0, 0)}):
            with self.subTest(changes), self.assertRaises(weight_files.WeightFileError):
                self.read(self.kernel_file(**changes))

    def test_safetensors_of_other_types_are_damage(self):
        for entry in ({"dtype": "F8", "shape": [1], "data_offsets": [0, 4]}, {"dtype": "F32", "shape": [2], "data_offsets": [0, 4]},
                      {"dtype": "F32", "shape": [1], "data_offsets": [4]}, {"dtype": "F32"}, 7):
            header = json.dumps({"a": entry}).encode()
            with self.subTest(entry), self.assertRaises(weight_files.WeightFileError):
                self.read(struct.pack("<Q", len(header)) + header + b"1234", weight_files.read_safetensors)

    def test_safetensors(self):
        header = json.dumps({
            "__metadata__": {"format": "pt"},
            "a": {"dtype": "F32", "shape": [2, 2], "data_offsets": [0, 16]},
            "b": {"dtype": "I64", "shape": [1], "data_offsets": [16, 24]},
        }).encode()
        numbers = np.array([1, 2, 3, 4], "<f4").tobytes() + np.array([9], "<i8").tobytes()
        data = struct.pack("<Q", len(header)) + header + numbers
        tensors = self.read(data, weight_files.read_safetensors)
        self.assertEqual(sorted(tensors), ["a", "b"])
        np.testing.assert_array_equal(tensors["a"], [[1, 2], [3, 4]])
        np.testing.assert_array_equal(tensors["b"], [9])
        for damaged in (b"", data[:20], data[:-1]):
            with self.subTest(size=len(damaged)), self.assertRaises(weight_files.WeightFileError):
                self.read(damaged, weight_files.read_safetensors)


class NamesTest(unittest.TestCase):
    def test_names_become_plain_words(self):
        self.assertEqual(furniture_names.meanings("Teapot"), ["teapot"])
        self.assertEqual(furniture_names.meanings("Toilets unit"), ["toilet"])
        self.assertEqual(furniture_names.meanings("Sofa 3 seats"), ["sofa", "couch"])
        self.assertEqual(furniture_names.meanings("Bed 140x190"), ["bed"])
        self.assertEqual(furniture_names.meanings("Rubik's cube"), ["rubik's cube"])
        self.assertEqual(furniture_names.meanings("Plate, glass and cutlery"),
                         ["table setting", "plate"])

    def test_what_says_nothing_is_left_out(self):
        self.assertEqual(furniture_names.meanings("Parking slot 45\u00b0"), [])
        self.assertEqual(furniture_names.meanings("  "), [])

    def test_the_table_has_each_name_once(self):
        names = [row[0] for row in furniture_names.table_rows()]
        self.assertEqual(len(names), len(set(names)))


class HeadTest(unittest.TestCase):
    def test_ridge_minimises_its_weighted_cost(self):
        random = np.random.default_rng(3)
        inputs, targets = random.normal(size=(30, 4)), random.normal(size=(30, 2))
        weights, strength = random.uniform(0.5, 2, 30), 0.2
        mean = weights @ inputs / weights.sum()
        penalty = strength * (weights @ (inputs - mean) ** 2).sum() / 4

        def cost(solution, bias):
            rest = inputs @ solution + bias - targets
            return weights @ (rest**2).sum(1) + penalty * (solution**2).sum()

        solution, bias = head_fit.ridge(inputs, targets, weights, strength)
        least = cost(solution, bias)
        for _ in range(20):
            self.assertGreater(cost(solution + 1e-3 * random.normal(size=solution.shape), bias),
                               least)
            self.assertGreater(cost(solution, bias + 1e-3 * random.normal(size=2)), least)

    def test_anchors_are_what_the_classifier_takes_for_their_class(self):
        random = np.random.default_rng(4)
        features, weights = random.uniform(1, 2, size=(40, 8)), random.normal(size=(5, 8))
        # No class is ahead of the others in the middle.
        classifier = head_fit.Classifier(weights, -weights @ features.mean(0))
        anchors = classifier.anchors(features, np.arange(40) // 4)
        found = head_fit.probabilities(classifier.logits(anchors))
        np.testing.assert_allclose(np.diag(found), head_fit.ANCHOR_PROBABILITY, atol=1e-3)
        self.assertTrue((anchors >= 0).all())

    def test_ranks_take_the_best_accepted_word(self):
        words = np.eye(3)
        embeddings = np.array([[0.9, 0.5, 0.1], [0.1, 0.5, 0.9]])
        np.testing.assert_array_equal(head_fit.ranks(embeddings, words, [[1, 2], [1, 2]]), [2, 1])
        np.testing.assert_array_equal(head_fit.ranks(embeddings, words, [[2], [0]]), [3, 3])

    def test_bytes_with_a_scale_a_row_keep_the_numbers(self):
        matrix = np.random.default_rng(5).normal(size=(6, 50)) * [[10.0**i] for i in range(6)]
        rows, scales = head_fit.quantised(matrix)
        restored = build_default_encoder.dequantised(rows, scales)
        self.assertLess((np.abs(restored - matrix) / np.abs(matrix).max(1, keepdims=True)).max(),
                        0.5 / 127 + 1e-6)


class WordPieceTest(unittest.TestCase):
    def test_longest_pieces_from_the_left(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "vocab.txt"
            path.write_text("[PAD]\n[UNK]\n[CLS]\n[SEP]\nbook\n##case\n##c\n,\nsofa\n##s\ncafe\n")
            pieces = wordpiece.WordPiece(path)
        self.assertEqual(pieces.encode("Bookcase, Caf\u00e9s"), [2, 4, 5, 7, 10, 9, 3])
        self.assertEqual(pieces.encode("bookx sofa"), [2, 1, 8, 3])
        ids, mask = pieces.batch(["sofa", "bookcase,"])
        np.testing.assert_array_equal(ids, [[2, 8, 3, 0, 0], [2, 4, 5, 7, 3]])
        np.testing.assert_array_equal(mask, [[1, 1, 1, 0, 0], [1, 1, 1, 1, 1]])


if __name__ == "__main__":
    unittest.main()
