# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A tiny encoder of the default encoder's kind: BERT with the masked mean folded into the network,
WordPiece, texts padded to the longest of the batch; and any image tower."""

import numpy as np
import torch
from PIL import Image
from transformers import BertConfig, BertModel

from export.folder import FolderWriter
from export.network import Wrapped, check_same, export_network, run_onnx

from . import tiny_tokenizers
from .textures import textured_image
from .tiny_models import TOWER, fill

CONTEXT = 48
IMAGE_PX, EMBEDDING = 32, TOWER["hidden_size"]
INPUTS = ["input_ids", "attention_mask", "token_type_ids"]
PIXELS = {"mean": [127.0, 127.0, 127.0], "std": [128.0, 128.0, 128.0]}


def masked_mean(model, ids, mask, types):
    states = model(input_ids=ids, attention_mask=mask, token_type_ids=types).last_hidden_state
    weights = mask.unsqueeze(2).to(states.dtype)
    return (states * weights).sum(1) / weights.sum(1)


class ImageTower(torch.nn.Module):
    def __init__(self):
        super().__init__()
        self.cells = torch.nn.Conv2d(3, 8, 8, stride=8)
        self.head = torch.nn.Linear(8 * 16, EMBEDDING)

    def forward(self, pixels):
        return self.head(torch.tanh(self.cells(pixels)).flatten(1))


def pixel_values(image) -> np.ndarray:
    """As model.yaml says it: stretched, bilinear with antialiasing, normalised."""
    small = Image.fromarray(image).resize((IMAGE_PX, IMAGE_PX), Image.Resampling.BILINEAR)
    scaled = (np.asarray(small, np.float32) - PIXELS["mean"][0]) / PIXELS["std"][0]
    return scaled.transpose(2, 0, 1)


def encode(tokenizer, texts, padding):
    encoded = tokenizer(
        list(texts), padding=padding, truncation=True, max_length=CONTEXT, return_tensors="pt"
    )
    return [encoded[name] for name in INPUTS]


def description(tokenizer, source: str) -> dict:
    text_inputs = {"ids": INPUTS[0], "mask": INPUTS[1], "types": INPUTS[2]}
    return {
        "kind": "dual_encoder",
        "name": "golden minilm",
        "license": "Apache-2.0",
        "source": source,
        "input": {"size": IMAGE_PX, "resize": "stretch", "filter": "bilinear", **PIXELS},
        "networks": {
            "image": {
                "file": "image.onnx",
                "inputs": {"image": "pixel_values"},
                "outputs": {"embedding": "image_embeds"},
            },
            "text": {
                "file": "text.onnx",
                "inputs": text_inputs,
                "outputs": {"embedding": "text_embeds"},
            },
        },
        "embedding_dim": EMBEDDING,
        "tokenizer": "wordpiece",
        "tokenizer_vocab": "vocab.txt",
        "context_length": CONTEXT,
        "pad_to_context": False,
        "pad_id": tokenizer.pad_token_id,
        "bos_id": tokenizer.cls_token_id,
        "eos_id": tokenizer.sep_token_id,
        "lowercase": True,
        "text_rule": "bert",
    }


@torch.no_grad()
def write_minilm(folder, texts, embedded_texts: int, source: str):
    """Writes the model. Gives the ids of `texts` (each as long as it is, special tokens included),
    the embeddings of the first ones, an image, and embeddings of that and of other images."""
    writer = FolderWriter(folder)
    tokenizer = tiny_tokenizers.minilm(writer.partial)
    config = BertConfig(
        **TOWER,
        vocab_size=len(tokenizer),
        max_position_embeddings=CONTEXT,
        attn_implementation="eager",
    )
    bert = fill(BertModel(config, add_pooling_layer=False), attention_gain=2.0)
    text = Wrapped(bert, masked_mean).eval()
    image_tower = fill(ImageTower())
    arguments = encode(tokenizer, texts[:embedded_texts], True)
    axes = {name: {0: "texts", 1: "length"} for name in INPUTS} | {"text_embeds": {0: "texts"}}
    path = writer.path("text.onnx")
    export_network(text, arguments, path, INPUTS, ["text_embeds"], axes)
    for count in (1, embedded_texts):
        feeds = encode(tokenizer, texts[:count], True)
        check_same("text tower", text(*feeds), run_onnx(path, dict(zip(INPUTS, feeds)))[0])
    images = [textured_image(seed) for seed in range(4)]
    pixels = torch.from_numpy(np.stack([pixel_values(i) for i in images]).astype(np.float32))
    axes = {"pixel_values": {0: "images"}, "image_embeds": {0: "images"}}
    path = writer.path("image.onnx")
    export_network(image_tower, [pixels[:2]], path, ["pixel_values"], ["image_embeds"], axes)
    check_same("image tower", image_tower(pixels), run_onnx(path, {"pixel_values": pixels})[0])
    writer.finish(description(tokenizer, source))
    ids = [tokenizer(t, truncation=True, max_length=CONTEXT)["input_ids"] for t in texts]
    return ids, text(*arguments), images[0], image_tower(pixels)
