# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Checkpoints in the shapes that hubs hold them, and those that cannot be exported."""

import contextlib
import io
import json
import pathlib
import tempfile
import types
import unittest

import numpy as np
import sentencepiece
import torch
import yaml
from transformers import BertConfig, Siglip2Config

import export_model
import make_golden_encoders
from export import network, tokenizer
from export.errors import ExportError
from export.image_input import encoder_input
from export.mask2former import square_input
from golden.tiny_mask_models import tiny_sam


class InScratch(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.checkpoint = pathlib.Path(scratch.name) / "checkpoint"
        self.checkpoint.mkdir()
        self.model = pathlib.Path(scratch.name) / "model"

    def export(self, *options) -> str:
        """What the tool prints; fails the test when it does not succeed."""
        status, text = self.run_tool(*options)
        self.assertEqual(status, 0, text)
        return text

    def refusal(self, *options) -> str:
        """The one line with which the tool refuses; it must leave no folder behind."""
        before = sorted(self.model.parent.iterdir())
        status, text = self.run_tool(*options)
        self.assertEqual(status, 1)
        self.assertEqual(sorted(self.model.parent.iterdir()), before)
        self.assertEqual(text.count("\n"), 1, text)
        return text

    def run_tool(self, *options):
        text = io.StringIO()
        with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
            status = export_model.main([str(self.checkpoint), str(self.model), *options])
        lines = [line for line in text.getvalue().splitlines(True) if "export_model" in line]
        return status, "".join(lines) if status else text.getvalue()

    def description(self) -> dict:
        return yaml.safe_load((self.model / "model.yaml").read_text(encoding="utf-8"))

    def edit(self, name: str, **keys) -> None:
        path = self.checkpoint / name
        path.write_text(json.dumps(json.loads(path.read_text()) | keys))


class Checkpoints(InScratch):
    def test_clip_with_vocabulary_and_merges_only(self):
        make_golden_encoders.save_checkpoint("clip", self.checkpoint)
        backend = json.loads((self.checkpoint / "tokenizer.json").read_text())["model"]
        (self.checkpoint / "tokenizer.json").unlink()
        (self.checkpoint / "vocab.json").write_text(json.dumps(backend["vocab"]))
        pairs = [" ".join(pair) for pair in backend["merges"]]
        (self.checkpoint / "merges.txt").write_text("\n".join(["#version: 0.2", *pairs, ""]))
        self.export()
        self.assertEqual(json.loads((self.model / "vocab.json").read_text()), backend["vocab"])
        self.assertEqual((self.model / "merges.txt").read_text().split("\n")[1:-1], pairs)

    def test_siglip2_with_gemmas_own_tokenizer(self):
        """As Google's checkpoints name it: no lower-casing, padding before the text by default."""
        make_golden_encoders.save_checkpoint("siglip2", self.checkpoint)
        settings = json.loads((self.checkpoint / "tokenizer_config.json").read_text())
        settings.pop("padding_side", None)
        settings |= {"tokenizer_class": "GemmaTokenizer"}
        (self.checkpoint / "tokenizer_config.json").write_text(json.dumps(settings))
        self.export("--name", "two", "--license", "apache-2.0")
        keys = self.description()
        self.assertEqual((keys["name"], keys["license"]), ("two", "apache-2.0"))
        self.assertIs(keys["lowercase"], True)
        self.assertEqual((keys["pad_id"], keys["eos_id"], keys.get("bos_id")), (0, 1, None))
        pieces = sentencepiece.SentencePieceProcessor(model_file=str(self.model / "spiece.model"))
        self.assertEqual(pieces.piece_to_id("<eos>"), 1)

    def test_license_and_name_come_from_the_card(self):
        model, processor = tiny_sam(0)
        for part in (model, processor):
            part.save_pretrained(self.checkpoint)
        (self.checkpoint / "README.md").write_text("---\nlicense: apache-2.0\n---\n# A model\n")
        self.export()
        keys = self.description()
        self.assertEqual((keys["license"], keys["name"]), ("apache-2.0", "checkpoint"))
        self.assertEqual(keys["kind"], "sam")


class Refusals(InScratch):
    def test_what_is_no_checkpoint(self):
        self.assertIn("config.json", self.refusal())

    def test_another_kind(self):
        BertConfig().save_pretrained(self.checkpoint)
        message = self.refusal()
        self.assertIn("'bert'", message)
        self.assertIn("accepted are siglip", message)

    def test_naflex(self):
        Siglip2Config().save_pretrained(self.checkpoint)
        self.assertIn("fixed-resolution", self.refusal())

    def test_a_folder_in_use(self):
        self.model.mkdir()
        (self.model / "notes.txt").write_text("mine")
        self.assertIn("exists already", self.refusal())
        self.assertEqual((self.model / "notes.txt").read_text(), "mine")

    def test_missing_weights(self):
        make_golden_encoders.save_checkpoint("siglip", self.checkpoint)
        (self.checkpoint / "model.safetensors").unlink()
        self.assertIn("model.safetensors", self.refusal())

    def test_input_size_of_a_network_that_has_one(self):
        tiny_sam(0)[0].save_pretrained(self.checkpoint)
        self.assertIn("--input-px is for mask2former", self.refusal("--input-px", "512"))

    def test_a_processor_that_does_not_fit_the_network(self):
        make_golden_encoders.save_checkpoint("siglip", self.checkpoint)
        self.edit("preprocessor_config.json", size={"height": 48, "width": 48})
        self.assertIn("makes 48 pixels, the network takes 32", self.refusal())


def processor(**keys):
    defaults = {"do_rescale": True, "rescale_factor": 1 / 255, "do_normalize": True, "resample": 2}
    colours = {"image_mean": [0.5, 0.4, 0.3], "image_std": [0.2, 0.2, 0.2]}
    return types.SimpleNamespace(**defaults | colours | keys)


class ImageInputs(unittest.TestCase):
    def test_mask2formers_sizes(self):
        both_edges = processor(size={"shortest_edge": 800, "longest_edge": 1333})
        self.assertEqual(square_input(both_edges, None), ("long_side", 1056))
        self.assertEqual(square_input(both_edges, 640), ("long_side", 640))
        fixed = processor(size={"height": 384, "width": 384})
        self.assertEqual(square_input(fixed, None), ("stretch", 384))
        with self.assertRaisesRegex(ExportError, "multiples of 32"):
            square_input(fixed, 100)

    def test_pixels_from_0_to_255(self):
        keys = encoder_input(processor(size={"height": 64, "width": 64}), 64)
        self.assertEqual(keys["mean"], [127.5, 102.0, 76.5])
        self.assertEqual(keys["std"], [51.0, 51.0, 51.0])
        self.assertEqual((keys["resize"], keys["filter"]), ("stretch", "bilinear"))

    def test_a_crop_of_another_size_is_refused(self):
        odd = processor(size={"shortest_edge": 72}, crop_size={"height": 64, "width": 64})
        odd.do_center_crop = True
        with self.assertRaisesRegex(ExportError, "needs both alike"):
            encoder_input(odd, 64)

    def test_other_filters_are_refused(self):
        with self.assertRaisesRegex(ExportError, "filter 1"):
            encoder_input(processor(size={"height": 64, "width": 64}, resample=1), 64)


class Networks(InScratch):
    def exported(self, max_bytes: int) -> pathlib.Path:
        layer = torch.nn.Linear(64, 64)
        torch.nn.init.normal_(layer.weight)
        path = self.checkpoint / f"{max_bytes}.onnx"
        limit, network.MAX_FILE_BYTES = network.MAX_FILE_BYTES, max_bytes
        try:
            axes = {"x": {0: "n"}, "y": {0: "n"}}
            network.export_network(layer, [torch.ones(2, 64)], path, ["x"], ["y"], axes)
        finally:
            network.MAX_FILE_BYTES = limit
        x = torch.rand(5, 64)
        network.check_same("layer", layer(x), network.run_onnx(path, {"x": x})[0])
        return path

    def test_weights_beyond_two_gigabytes_go_to_a_second_file(self):
        self.assertFalse(self.exported(10**9).with_suffix(".onnx.data").exists())
        large = self.exported(1000)
        self.assertGreater(large.with_suffix(".onnx.data").stat().st_size, 64 * 64 * 4 - 1)
        self.assertLess(large.stat().st_size, 2000)

    def test_another_answer_is_no_success(self):
        a = np.random.default_rng(0).normal(size=(4, 8)).astype(np.float32)
        network.check_same("same", a, a * 1.5)
        with self.assertRaisesRegex(ExportError, "cosine"):
            network.check_same("other", a, a + 0.1)
        with self.assertRaisesRegex(ExportError, "shape"):
            network.check_same("shape", a, a[:2])

    def test_a_tokenizer_json_that_merges_otherwise_is_found_out(self):
        make_golden_encoders.save_checkpoint("siglip2", self.checkpoint)
        path = self.checkpoint / "tokenizer.json"
        backend = json.loads(path.read_text())
        backend["model"]["merges"] = backend["model"]["merges"][::-1]
        path.write_text(json.dumps(backend))
        self.assertIn("is not one that ovimap can read", self.refusal())

    def test_probes_meet_every_kind_of_piece(self):
        self.assertGreater(len({ord(c) for text in tokenizer.PROBES for c in text}), 30)
