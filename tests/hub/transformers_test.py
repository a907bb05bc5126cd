#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""SigLIP, SigLIP 2 and CLIP of transformers with random weights, exported as the hub's are, fetched from a hub on this machine
and held against transformers' own answers through the whole processor. Usage: transformers_test.py PROGRAM

Needs tools/models/requirements-export.txt in the interpreter that $OVIMAP_EXPORT_PYTHON names, or in this one; without them
it ends with exit code 77 and says so."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
NEEDED = ("torch", "transformers", "onnx", "onnxruntime", "sentencepiece", "PIL", "yaml", "scipy")
SKIPPED = 77
# Of any number of an embedding of length 1, against ONNX Runtime's answer to transformers' tensors. That is another release than
# ours, which may round halves and levels of quantised networks otherwise.
TOLERANCE = {"full": 1e-3, "fp16": 5e-3, "quantized": 1e-2}
# And against transformers itself; what quantising loses is the network's own.
TORCH_TOLERANCE = {"full": 1e-3, "fp16": 5e-3}
TEXTS = ("a photo of a wooden chair.", "Red MUG, 24 cm; ça va?", "  two  blanks\tand\na line ", "机 デスク стол", "")


def python_with_torch():
    python = os.environ.get("OVIMAP_EXPORT_PYTHON") or sys.executable
    code = "import importlib.util as u, sys; print(*[n for n in sys.argv[1:] if u.find_spec(n) is None])"
    found = subprocess.run([python, "-c", code, *NEEDED], capture_output=True, text=True)
    missing = found.stdout.split() if found.returncode == 0 else [python]
    if missing:
        print(f"{python} lacks {', '.join(missing)}; pip install -r tools/models/requirements-export.txt and name that Python "
              "in OVIMAP_EXPORT_PYTHON")
        sys.exit(SKIPPED)
    return python


if os.environ.get("OVIMAP_TORCH_FOUND") != "1":
    python = python_with_torch()
    environment = os.environ | {"OVIMAP_TORCH_FOUND": "1", "HF_HUB_OFFLINE": "1", "TRANSFORMERS_VERBOSITY": "error"}
    os.execve(python, [python, "-W", "ignore", *sys.argv], environment)

sys.path[:0] = [str(ROOT / "tools/models"), str(ROOT / "tests/hub")]
import numpy as np  # noqa: E402
import onnx  # noqa: E402
import onnxruntime  # noqa: E402
import torch  # noqa: E402
from onnxruntime.quantization import QuantType, quantize_dynamic  # noqa: E402
from onnxruntime.transformers.float16 import convert_float_to_float16  # noqa: E402
from PIL import Image  # noqa: E402
from transformers import AutoImageProcessor, AutoModel  # noqa: E402

import make_golden_encoders  # noqa: E402
import standin  # noqa: E402
import tiny_models  # noqa: E402
from export.dual_encoder import load_tokenizer  # noqa: E402
from export.network import Wrapped, export_network  # noqa: E402
from golden.textures import textured_image  # noqa: E402

PROGRAM = ""


def image_tower(model, pixels):
    """As optimum exports it: the last states, then what stands for the picture."""
    seen = model.vision_model(pixel_values=pixels)
    if model.config.model_type == "clip":
        return seen.last_hidden_state, model.visual_projection(seen.pooler_output)
    return seen.last_hidden_state, seen.pooler_output


def siglip_text_tower(model, ids):
    read = model.text_model(input_ids=ids)
    return read.last_hidden_state, read.pooler_output


def clip_text_tower(model, ids, mask):
    read = model.text_model(input_ids=ids, attention_mask=mask)
    return read.last_hidden_state, model.text_projection(read.pooler_output)


def export_towers(model, folder, ids, mask):
    clip = model.config.model_type == "clip"
    side = model.config.vision_config.image_size
    pixels = torch.rand(2, 3, side, side, generator=torch.Generator().manual_seed(1)) * 2 - 1
    image, text = ("image_embeds", "text_embeds") if clip else ("pooler_output", "pooler_output")
    axes = {"pixel_values": {0: "batch"}, "last_hidden_state": {0: "batch"}, image: {0: "batch"}}
    export_network(Wrapped(model, image_tower), [pixels], folder / "vision_model.onnx", ["pixel_values"],
                   ["last_hidden_state", image], axes)
    inputs = ["input_ids", "attention_mask"] if clip else ["input_ids"]
    axes = {name: {0: "batch"} for name in [*inputs, "last_hidden_state", text]}
    export_network(Wrapped(model, clip_text_tower if clip else siglip_text_tower), [ids, mask][: len(inputs)],
                   folder / "text_model.onnx", inputs, ["last_hidden_state", text], axes)


def add_variants(folder):
    for tower in ("vision_model", "text_model"):
        whole = folder / f"{tower}.onnx"
        onnx.save(convert_float_to_float16(onnx.load(whole), keep_io_types=True, disable_shape_infer=True),
                  folder / f"{tower}_fp16.onnx")
        quantize_dynamic(whole, folder / f"{tower}_quantized.onnx", weight_type=QuantType.QUInt8)


def siglip_tokenizer_json(checkpoint):
    """SigLIP's tokenizer is saved as its SentencePiece model alone; the hub's exports have both."""
    pieces = tiny_models.read_pieces((checkpoint / "spiece.model").read_bytes())
    backend = tiny_models.siglip_tokenizer()[0]
    backend["model"]["vocab"] = [[piece, 0.0] for piece in pieces]
    (checkpoint / "tokenizer.json").write_text(json.dumps(backend))


class Answers:
    """What transformers makes of a picture and of texts, and what ONNX Runtime makes of the same tensors."""

    def __init__(self, kind, checkpoint):
        self.model = AutoModel.from_pretrained(checkpoint, attn_implementation="eager").eval()
        self.tokenizer = load_tokenizer(str(checkpoint), kind.rstrip("2"))
        self.processor = AutoImageProcessor.from_pretrained(checkpoint, backend="pil")
        self.lowers = kind == "siglip2"

    def tokens(self, texts):
        texts = [text.lower() if self.lowers else text for text in texts]
        length = self.model.config.text_config.max_position_embeddings
        return self.tokenizer(list(texts), padding="max_length", truncation=True, max_length=length, return_tensors="pt",
                              return_attention_mask=True)

    def pixels(self, picture):
        return self.processor([Image.fromarray(picture)], return_tensors="pt")["pixel_values"]

    @torch.no_grad()
    def of_transformers(self, picture, text):
        tokens, clip = self.tokens([text]), self.model.config.model_type == "clip"
        mask = {"attention_mask": tokens["attention_mask"]} if clip else {}
        read = self.model.get_text_features(input_ids=tokens["input_ids"], **mask)
        seen = self.model.get_image_features(pixel_values=self.pixels(picture))
        return [unit(getattr(x, "pooler_output", x)) for x in (seen, read)]

    def of_networks(self, folder, ending, picture, text):
        tokens = self.tokens([text])
        seen = run(folder / f"vision_model{ending}.onnx", {"pixel_values": self.pixels(picture)})
        return unit(seen), unit(run(folder / f"text_model{ending}.onnx", tokens))


def run(file, feeds):
    session = onnxruntime.InferenceSession(str(file), providers=["CPUExecutionProvider"])
    wanted = {i.name for i in session.get_inputs()}
    return session.run(None, {name: np.asarray(value) for name, value in feeds.items() if name in wanted})[1]


def unit(row):
    row = np.asarray(row, np.float64).reshape(-1)
    return row / np.linalg.norm(row)


class Parity(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.scratch = pathlib.Path(scratch.name)
        self.hub = standin.Hub()
        self.addCleanup(self.hub.close)

    def publish(self, kind):
        checkpoint = self.scratch / kind
        (checkpoint / "onnx").mkdir(parents=True)
        make_golden_encoders.save_checkpoint(kind, checkpoint)
        if kind == "siglip":
            siglip_tokenizer_json(checkpoint)
        answers = Answers(kind, checkpoint)
        tokens = answers.tokens(TEXTS[:2])
        with torch.no_grad():
            export_towers(answers.model, checkpoint / "onnx", tokens["input_ids"], tokens["attention_mask"])
        add_variants(checkpoint / "onnx")
        files = {str(p.relative_to(checkpoint)): p.read_bytes() for p in checkpoint.rglob("*") if p.is_file()}
        self.hub.repositories[f"tests/{kind}"] = standin.Repository(files)
        (self.scratch / "catalogue.yaml").write_text(
            "models:\n" + tiny_models.catalogue_entry(kind, "dual_encoder", f"tests/{kind}", 1))
        return checkpoint, answers

    def program(self, *arguments):
        command = [PROGRAM, "models", "--model-dir", "models", "--catalogue", "catalogue.yaml", "--json", *arguments]
        done = subprocess.run(command, capture_output=True, text=True, cwd=self.scratch, timeout=300,
                              env=os.environ | {"HF_ENDPOINT": self.hub.address, "HF_TOKEN": "", "no_proxy": "127.0.0.1"})
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def check(self, kind):
        checkpoint, answers = self.publish(kind)
        picture = textured_image(0)
        Image.fromarray(picture).save(self.scratch / "picture.png")
        for variant, ending in (("full", ""), ("fp16", "_fp16"), ("quantized", "_quantized")):
            self.program("fetch", kind, "--variant", variant, "--as", variant)
            found = self.program("try", variant, "picture.png", "--", *TEXTS)
            words = {row["text"]: row["embedding"] for row in found["texts"]}
            for text in TEXTS:
                with self.subTest(kind=kind, variant=variant, text=text):
                    image, read = answers.of_networks(checkpoint / "onnx", ending, picture, text)
                    np.testing.assert_allclose(found["embedding"], image, atol=TOLERANCE[variant])
                    np.testing.assert_allclose(words[text], read, atol=TOLERANCE[variant])
                    if variant not in TORCH_TOLERANCE:
                        continue
                    image, read = answers.of_transformers(picture, text)
                    np.testing.assert_allclose(found["embedding"], image, atol=TORCH_TOLERANCE[variant])
                    np.testing.assert_allclose(words[text], read, atol=TORCH_TOLERANCE[variant])

    def test_siglip(self):
        self.check("siglip")

    def test_siglip2(self):
        self.check("siglip2")

    def test_clip(self):
        self.check("clip")


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
