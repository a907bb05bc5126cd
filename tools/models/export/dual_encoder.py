# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""SigLIP, SigLIP 2 (fixed resolution) and CLIP to a folder of kind dual_encoder."""

import math

import torch
from transformers import AutoImageProcessor, AutoModel, AutoTokenizer

from .errors import ExportError
from .image_input import encoder_input
from .network import Wrapped, check_same, export_network, pooled, run_onnx
from .tokenizer import PROBES, clip_tokenizer, gemma_tokenizer, siglip_tokenizer

IMAGE, TEXT = "image.onnx", "text.onnx"
TEMPLATES = {"siglip": "This is a photo of {}.", "clip": "a photo of a {}."}


def image_features(model, pixels):
    return pooled(model.get_image_features(pixel_values=pixels))


def text_features(model, ids, mask=None):
    return pooled(model.get_text_features(input_ids=ids, attention_mask=mask))


def tokenizer_files(kind: str, tokenizer, writer, context_length: int) -> dict:
    if kind == "clip":
        return clip_tokenizer(tokenizer, writer, context_length)
    if hasattr(tokenizer, "sp_model"):
        return siglip_tokenizer(tokenizer, writer, context_length)
    return gemma_tokenizer(tokenizer, writer, context_length)


def tokenize(tokenizer, texts, context_length: int):
    """The ids and the mask as the model's own pipeline makes them; no mask where it makes none."""
    encoded = tokenizer(
        list(texts),
        padding="max_length",
        truncation=True,
        max_length=context_length,
        return_tensors="pt",
    )
    return encoded["input_ids"], encoded.get("attention_mask")


def export_image_tower(model, writer, side: int) -> None:
    module = Wrapped(model, image_features)
    images = torch.rand(3, 3, side, side, generator=torch.Generator().manual_seed(1)) * 2 - 1
    axes = {"pixel_values": {0: "images"}, "image_embeds": {0: "images"}}
    path = writer.path(IMAGE)
    export_network(module, [images[:2]], path, ["pixel_values"], ["image_embeds"], axes)
    for batch in (images[:1], images):
        (found,) = run_onnx(path, {"pixel_values": batch})
        check_same("image tower", module(batch), found)


def export_text_tower(model, writer, ids, mask) -> dict:
    """`mask` is None where the network is not to see one. The roles of the inputs."""
    feeds = {"input_ids": ids} | ({} if mask is None else {"attention_mask": mask})
    axes = {name: {0: "texts"} for name in [*feeds, "text_embeds"]}
    module = Wrapped(model, text_features)
    path = writer.path(TEXT)
    example = [tensor[:2] for tensor in feeds.values()]
    export_network(module, example, path, list(feeds), ["text_embeds"], axes)
    roles = {"input_ids": "ids", "attention_mask": "mask"}
    return {roles[name]: name for name in feeds}


def check_text_tower(model, writer, ids, mask, wanted) -> None:
    expected = text_features(model, ids, mask)  # as the checkpoint's own pipeline calls it
    for count in (1, len(ids)):
        feeds = {"input_ids": ids[:count], "attention_mask": mask}
        feeds = {name: feeds[name][:count] for name in wanted}
        (found,) = run_onnx(writer.path(TEXT), feeds)
        check_same("text tower", expected[:count], found)


@torch.no_grad()
def export_dual_encoder(checkpoint: str, config, writer) -> dict:
    kind = config.model_type
    model = AutoModel.from_pretrained(checkpoint, dtype=torch.float32, attn_implementation="eager")
    model.eval()
    processor = AutoImageProcessor.from_pretrained(checkpoint, backend="pil")
    tokenizer = AutoTokenizer.from_pretrained(checkpoint)
    side = config.vision_config.image_size
    context_length = config.text_config.max_position_embeddings

    image = encoder_input(processor, side)
    export_image_tower(model, writer, side)
    tokenizer_keys = tokenizer_files(kind, tokenizer, writer, context_length)
    ids, mask = tokenize(tokenizer, PROBES, context_length)
    # CLIP's text tower looks back only, from the end token: it never sees the padding behind that.
    inputs = export_text_tower(model, writer, ids, None if kind == "clip" else mask)
    check_text_tower(model, writer, ids, mask, list(inputs.values()))
    return {
        "kind": "dual_encoder",
        "input": image,
        "networks": {
            "image": {
                "file": IMAGE,
                "inputs": {"image": "pixel_values"},
                "outputs": {"embedding": "image_embeds"},
            },
            "text": {"file": TEXT, "inputs": inputs, "outputs": {"embedding": "text_embeds"}},
        },
        "embedding_dim": int(text_features(model, ids[:1], None).shape[1]),
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
