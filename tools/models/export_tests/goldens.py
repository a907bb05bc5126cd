# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The committed golden folders are what their generators make, and what their model.yaml says."""

import pathlib
import tempfile
import unittest

import numpy as np
import onnx
import yaml
from PIL import Image

import make_golden_encoders
import make_golden_masks
from export.folder import sha256_of
from export.network import cosine, run_onnx

TESTDATA = pathlib.Path(__file__).resolve().parents[3] / "src/ovimap/inference/testdata"
ENCODERS = ("golden_siglip", "golden_siglip2", "golden_clip", "golden_minilm")
MASKS = ("golden_mask2former", "golden_sam_hf")
SAME_BYTES = ("texts.json", "spiece.model", "vocab.json", "merges.txt", "vocab.txt")
TOLERANCE = 2e-3  # of logits up to about 30


def description(folder: pathlib.Path) -> dict:
    return yaml.safe_load((folder / "model.yaml").read_text(encoding="utf-8"))


def random_feeds(path: pathlib.Path, count: int) -> dict:
    """Numbers for every input of a network; open axes get `count` entries."""
    rng = np.random.default_rng(3)
    feeds = {}
    for tensor in onnx.load(str(path)).graph.input:
        shape = [axis.dim_value or count for axis in tensor.type.tensor_type.shape.dim]
        whole = tensor.type.tensor_type.elem_type == onnx.TensorProto.INT64
        feeds[tensor.name] = (
            rng.integers(1, 2, shape) if whole else rng.normal(size=shape).astype(np.float32)
        )
    return feeds


class CommittedFolders(unittest.TestCase):
    def test_files_have_the_digests_of_model_yaml(self):
        for name in ENCODERS + MASKS:
            digests = description(TESTDATA / name)["sha256"]
            for file, digest in digests.items():
                self.assertEqual(sha256_of(TESTDATA / name / file), digest, f"{name}/{file}")

    def test_batches_are_open(self):
        for name in ENCODERS + ("golden_mask2former",):
            for network in description(TESTDATA / name)["networks"].values():
                path = TESTDATA / name / network["file"]
                for count in (1, 3):
                    for output in run_onnx(path, random_feeds(path, count)):
                        self.assertEqual(len(output), count, f"{name}/{path.name}")


class MadeAnew(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.root = pathlib.Path(scratch.name)
        make_golden_encoders.write_all(cls.root)
        make_golden_masks.write_all(cls.root)

    def pairs(self, names, pattern):
        for name in names:
            for committed in sorted((TESTDATA / name).glob(pattern)):
                yield committed, self.root / name / committed.name

    def test_same_files(self):
        for name in ENCODERS + MASKS:
            files = [sorted(f.name for f in (at / name).iterdir()) for at in (TESTDATA, self.root)]
            self.assertEqual(*files, name)

    def test_same_keys(self):
        for committed, anew in self.pairs(ENCODERS + MASKS, "model.yaml"):
            keys = [description(file.parent) for file in (committed, anew)]
            digests = [k.pop("sha256") for k in keys]
            self.assertEqual(*keys, committed)
            self.assertEqual(*map(sorted, digests), committed)

    def test_same_tokenizers_and_ids(self):
        for pattern in SAME_BYTES:
            for committed, anew in self.pairs(ENCODERS, pattern):
                self.assertEqual(committed.read_bytes(), anew.read_bytes(), committed)

    def test_same_embeddings(self):
        for name in ENCODERS:
            text = [np.loadtxt(at / name / "expected_text.txt") for at in (TESTDATA, self.root)]
            image = [np.loadtxt(at / name / "expected_image.txt") for at in (TESTDATA, self.root)]
            self.assertGreater(cosine(*text), 0.99999, name)
            self.assertGreater(cosine(*[row[None] for row in image]), 0.99999, name)

    def test_same_masks(self):
        for committed, anew in self.pairs(MASKS, "*s.txt"):
            np.testing.assert_allclose(np.loadtxt(anew), np.loadtxt(committed), atol=TOLERANCE)
        for committed, anew in self.pairs(MASKS + ENCODERS, "*.png"):
            same = np.array_equal(*(np.asarray(Image.open(f)) for f in (committed, anew)))
            self.assertTrue(same, committed)

    def test_same_networks(self):
        for committed, anew in self.pairs(ENCODERS + MASKS, "*.onnx"):
            feeds = random_feeds(committed, 1)
            for a, b in zip(run_onnx(committed, feeds), run_onnx(anew, feeds)):
                self.assertGreater(cosine(a, b), 0.9999, committed)
