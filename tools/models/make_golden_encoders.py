#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the small image-text encoders that prove ovimap's tokenizers and image scaling.

For each kind a checkpoint of two layers with random weights and a small trained tokenizer is made,
exported with the export tool, and run through the Hugging Face pipeline. The folders hold the
model, an image and its expected embedding, 200 texts with their expected ids, and the expected
embeddings of the first eight texts. Embeddings have length 1.
"""

import argparse
import json
import math
import pathlib
import sys
import tempfile

import numpy as np
import torch
from PIL import Image
from transformers import (
    AutoImageProcessor,
    AutoModel,
    CLIPConfig,
    CLIPImageProcessorPil,
    CLIPModel,
    SiglipConfig,
    SiglipImageProcessorPil,
    SiglipModel,
)

from export.checkpoint import Options, export_checkpoint
from export.dual_encoder import image_features, load_tokenizer, text_features, tokenize
from golden import tiny_tokenizers
from golden.corpus import texts
from golden.minilm import write_minilm
from golden.textures import textured_image
from golden.tiny_models import TOWER, fill, set_scalar

SOURCE = "tools/models/make_golden_encoders.py"
EMBEDDED_TEXTS = 8
IMAGE_PX, PATCH_PX = 32, 8
MAX_COSINE = 0.97  # of different texts' or images' embeddings: else agreement shows nothing
CONTEXT = {"siglip": 64, "siglip2": 64, "clip": 77}


def siglip_checkpoint(kind: str, folder: pathlib.Path):
    tokenizer = getattr(tiny_tokenizers, kind)(folder)
    text = TOWER | {
        "vocab_size": len(tokenizer),
        "max_position_embeddings": CONTEXT[kind],
        "projection_size": TOWER["hidden_size"],
        "bos_token_id": tokenizer.bos_token_id if kind == "siglip2" else None,
        "eos_token_id": tokenizer.eos_token_id,
        "pad_token_id": tokenizer.pad_token_id,
    }
    vision = TOWER | {"image_size": IMAGE_PX, "patch_size": PATCH_PX}
    model = fill(SiglipModel(SiglipConfig(text_config=text, vision_config=vision)))
    set_scalar(model.logit_scale, math.log(10.0))
    set_scalar(model.logit_bias, -5.0)
    size = {"height": IMAGE_PX, "width": IMAGE_PX}
    processor = SiglipImageProcessorPil(size=size)
    return model, tokenizer, processor


def clip_checkpoint(folder: pathlib.Path):
    tokenizer = tiny_tokenizers.clip(folder)
    text = TOWER | {
        "vocab_size": len(tokenizer),
        "max_position_embeddings": CONTEXT["clip"],
        "bos_token_id": tokenizer.bos_token_id,
        "eos_token_id": tokenizer.eos_token_id,
    }
    vision = TOWER | {"image_size": IMAGE_PX, "patch_size": PATCH_PX}
    config = CLIPConfig(text_config=text, vision_config=vision, projection_dim=12)
    model = fill(CLIPModel(config))
    set_scalar(model.logit_scale, math.log(100.0))
    size = {"height": IMAGE_PX, "width": IMAGE_PX}
    processor = CLIPImageProcessorPil(size={"shortest_edge": IMAGE_PX}, crop_size=size)
    return model, tokenizer, processor


def save_checkpoint(kind: str, folder: pathlib.Path) -> None:
    make = clip_checkpoint if kind == "clip" else lambda at: siglip_checkpoint(kind, at)
    for part in make(folder):
        part.save_pretrained(folder)


def unit_rows(rows) -> np.ndarray:
    rows = np.asarray(rows, np.float64)
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def check_telling(name: str, what: str, rows: np.ndarray) -> None:
    """Different inputs must have clearly different embeddings."""
    cosines = rows @ rows.T - 2 * np.eye(len(rows))
    if cosines.max() > MAX_COSINE:
        raise SystemExit(
            f"{name}: two {what} embeddings have cosine {cosines.max():.3f}; scale the weights"
        )


def write_rows(path: pathlib.Path, rows) -> None:
    path.write_text("".join(" ".join(f"{v:.8f}" for v in row) + "\n" for row in rows))


def write_expected(folder: pathlib.Path, ids, text_rows, image, image_rows) -> None:
    """`image_rows`: the embedding of `image`, then those of others, which are only compared."""
    entries = [{"text": t, "ids": list(map(int, row))} for t, row in zip(texts(), ids)]
    lines = ",\n".join(json.dumps(e, separators=(",", ":")) for e in entries)
    (folder / "texts.json").write_text(f"[\n{lines}\n]\n")
    text_rows, image_rows = unit_rows(text_rows), unit_rows(image_rows)
    check_telling(folder.name, "text", text_rows)
    check_telling(folder.name, "image", image_rows)
    write_rows(folder / "expected_text.txt", text_rows)
    write_rows(folder / "expected_image.txt", image_rows[0].reshape(-1, 1))
    Image.fromarray(image).save(folder / "image.png", optimize=True)


@torch.no_grad()
def write_encoder(kind: str, folder: pathlib.Path) -> None:
    with tempfile.TemporaryDirectory() as scratch:
        checkpoint = pathlib.Path(scratch)
        save_checkpoint(kind, checkpoint)
        export_checkpoint(scratch, folder, Options(f"golden {kind}", "Apache-2.0", SOURCE))
        model = AutoModel.from_pretrained(checkpoint, attn_implementation="eager").eval()
        tokenizer = load_tokenizer(scratch, kind.rstrip("2"))
        processor = AutoImageProcessor.from_pretrained(checkpoint, backend="pil")
        ids = tokenize(tokenizer, texts(), CONTEXT[kind])
        text_rows = text_features(model, ids[:EMBEDDED_TEXTS])
        images = [textured_image(seed) for seed in range(4)]
        pixels = processor([Image.fromarray(i) for i in images], return_tensors="pt")
        image_rows = image_features(model, pixels["pixel_values"])
    write_expected(folder, ids, text_rows, images[0], image_rows)


def write_all(root: pathlib.Path) -> list:
    folders = []
    for kind in CONTEXT:
        folders.append(root / f"golden_{kind}")
        write_encoder(kind, folders[-1])
    folders.append(root / "golden_minilm")
    write_expected(folders[-1], *write_minilm(folders[-1], texts(), EMBEDDED_TEXTS, SOURCE))
    return folders


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help="the tests read .../inference/testdata")
    for folder in write_all(parser.parse_args().folder):
        size = sum(f.stat().st_size for f in folder.iterdir())
        print(f"wrote {folder}, {size // 1000} kB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
