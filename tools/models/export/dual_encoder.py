# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""SigLIP, SigLIP 2 (fixed resolution) and CLIP to a folder of kind dual_encoder."""

import math

import torch
from transformers import AutoImageProcessor, AutoModel, AutoTokenizer, SiglipTokenizer

from .errors import ExportError
from .image_input import encoder_input
from .network import Wrapped, check_same, export_network, pooled, run_onnx
from .tokenizer import PROBES, backend_json, clip_tokenizer, gemma_tokenizer, siglip_tokenizer

IMAGE, TEXT = "image.onnx", "text.onnx"
TEMPLATES = {"siglip": "This is a photo of {}.", "clip": "a photo of a {}."}


def image_features(model, pixels):
    return pooled(model.get_image_features(pixel_values=pixels))


def text_features(model, ids):
    """Without an attention mask: SigLIP's towers were trained to read the padding too, and CLIP's
    looks back only, from the end token, so that it never sees what is behind."""
    return pooled(model.get_text_features(input_ids=ids))


def load_tokenizer(checkpoint: str, kind: str):
    """Padding goes behind the text, as these models were trained, whatever the tokenizer's default
    is (Gemma's is to put it before)."""
    tokenizer = AutoTokenizer.from_pretrained(checkpoint, padding_side="right")
    if kind == "siglip" and not hasattr(tokenizer, "sp_model"):
        if backend_json(tokenizer)["model"]["type"] == "Unigram":
            tokenizer = SiglipTokenizer.from_pretrained(checkpoint, padding_side="right")
    return tokenizer


def tokenizer_files(kind: str, tokenizer, writer, context_length: int) -> dict:
    if kind == "clip":
        return clip_tokenizer(tokenizer, writer, context_length)
    if hasattr(tokenizer, "sp_model"):
        return siglip_tokenizer(tokenizer, writer, context_length)
    return gemma_tokenizer(tokenizer, writer, context_length)


def tokenize(tokenizer, texts, context_length: int):
    """The ids as the model's own pipeline makes them."""
    return tokenizer(
        list(texts),
        padding="max_length",
        truncation=True,
        max_length=context_length,
        return_tensors="pt",
    )["input_ids"]


def export_image_tower(model, writer, side: int) -> None:
    module = Wrapped(model, image_features)
    images = torch.rand(3, 3, side, side, generator=torch.Generator().manual_seed(1)) * 2 - 1
    axes = {"pixel_values": {0: "images"}, "image_embeds": {0: "images"}}
    path = writer.path(IMAGE)
    export_network(module, [images[:2]], path, ["pixel_values"], ["image_embeds"], axes)
    for batch in (images[:1], images):
        (found,) = run_onnx(path, {"pixel_values": batch})
        check_same("image tower", module(batch), found)


def export_text_tower(model, writer, ids) -> None:
    module = Wrapped(model, text_features)
    axes = {"input_ids": {0: "texts"}, "text_embeds": {0: "texts"}}
    path = writer.path(TEXT)
    export_network(module, [ids[:2]], path, ["input_ids"], ["text_embeds"], axes)
    for batch in (ids[:1], ids):
        (found,) = run_onnx(path, {"input_ids": batch})
        check_same("text tower", module(batch), found)


@torch.no_grad()
def export_dual_encoder(checkpoint: str, config, writer) -> dict:
    kind = config.model_type
    model = AutoModel.from_pretrained(checkpoint, dtype=torch.float32, attn_implementation="eager")
    model.eval()
    processor = AutoImageProcessor.from_pretrained(checkpoint, backend="pil")
    tokenizer = load_tokenizer(checkpoint, kind)
    side = config.vision_config.image_size
    context_length = config.text_config.max_position_embeddings

    image = encoder_input(processor, side)
    export_image_tower(model, writer, side)
    tokenizer_keys = tokenizer_files(kind, tokenizer, writer, context_length)
    ids = tokenize(tokenizer, PROBES, context_length)
    export_text_tower(model, writer, ids)
    return {
        "kind": "dual_encoder",
        "input": image,
        "networks": {
            "image": {
                "file": IMAGE,
                "inputs": {"image": "pixel_values"},
                "outputs": {"embedding": "image_embeds"},
            },
            "text": {
                "file": TEXT,
                "inputs": {"ids": "input_ids"},
                "outputs": {"embedding": "text_embeds"},
            },
        },
        "embedding_dim": int(text_features(model, ids[:1]).shape[1]),
        **tokenizer_keys,
        **calibration(model),
        "prompt_template": TEMPLATES[kind],
    }


def calibration(model) -> dict:
    """The scale (the checkpoint stores its logarithm) and, with a sigmoid loss, the bias."""
    keys = {"logit_scale": round(math.exp(model.logit_scale.item()), 6)}
    bias = getattr(model, "logit_bias", None)
    return keys if bias is None else keys | {"logit_bias": round(bias.item(), 6)}


def refuse_naflex(config) -> None:
    if config.model_type == "siglip2":
        raise ExportError(
            "the checkpoint is a NaFlex SigLIP 2, whose input size varies; take a fixed-resolution "
            "one, such as google/siglip2-large-patch16-384"
        )
