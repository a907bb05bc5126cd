# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""SAM to a folder of kind sam: an image encoder, and a decoder for any number of prompts."""

import torch
from transformers import AutoImageProcessor, SamModel

from .errors import ExportError
from .image_input import image_input, side_of
from .network import Wrapped, check_same, export_network, run_onnx

ENCODER, DECODER = "encoder.onnx", "decoder.onnx"
PADDING, BACKGROUND, FOREGROUND, BOX_MIN, BOX_MAX = -1, 0, 1, 2, 3


def image_embedding(model, pixels):
    return model.vision_encoder(pixels)[0]


def prompt_embedding(encoder, points, labels):
    """As the original SAM embeds points and box corners alike, by their labels; the checkpoint's
    own code takes boxes as an input of their own, which ovimap's prompts have not."""
    side = encoder.input_image_size
    embedded = encoder.shared_embedding(points + 0.5, (side, side))
    label = labels.unsqueeze(-1)
    embedded = torch.where(label == PADDING, torch.zeros_like(embedded), embedded)
    weights = {PADDING: encoder.not_a_point_embed.weight}
    kinds = (BACKGROUND, FOREGROUND, BOX_MIN, BOX_MAX)
    weights |= {kind: encoder.point_embed[kind].weight for kind in kinds}
    for kind, weight in weights.items():
        embedded = embedded + (label == kind).to(embedded.dtype) * weight
    return embedded


def decode(model, embedding, points, labels):
    """Masks [1, prompts, 3, S, S] as logits and their predicted IoUs [1, prompts, 3]."""
    encoder = model.prompt_encoder
    height, width = encoder.image_embedding_size
    dense = encoder.no_mask_embed.weight.reshape(1, -1, 1, 1).expand(1, -1, height, width)
    masks, scores = model.mask_decoder(
        image_embeddings=embedding,
        image_positional_embeddings=model.get_image_wide_positional_embeddings(),
        sparse_prompt_embeddings=prompt_embedding(encoder, points, labels),
        dense_prompt_embeddings=dense,
        multimask_output=True,
    )[:2]
    return masks, scores


def export_encoder(model, writer, images) -> None:
    module = Wrapped(model, image_embedding)
    path = writer.path(ENCODER)
    axes = {name: {0: "images"} for name in ("pixel_values", "image_embeddings")}
    export_network(module, [images], path, ["pixel_values"], ["image_embeddings"], axes)
    for batch in (images[:1], images):
        (found,) = run_onnx(path, {"pixel_values": batch})
        check_same("SAM's encoder", module(batch), found)


def export_decoder(model, writer, embedding, side: int) -> None:
    inputs = ["image_embeddings", "input_points", "input_labels"]
    outputs = ["pred_masks", "iou_scores"]
    prompts = {1: "prompts", 2: "points"}
    axes = {"input_points": prompts, "input_labels": prompts}
    axes |= {name: {1: "prompts"} for name in outputs}
    points = torch.rand(1, 3, 2, 2, generator=torch.Generator().manual_seed(2)) * side
    labels = torch.tensor([[[FOREGROUND, PADDING]] * 3], dtype=torch.float32)
    path = writer.path(DECODER)
    export_network(
        Wrapped(model, decode), [embedding, points, labels], path, inputs, outputs, axes
    )
    for feeds, expected in prompts_and_answers(model, embedding, points, side):
        found = run_onnx(path, dict(zip(inputs, (embedding, *feeds))))
        for name, a, b in zip(outputs, expected, found):
            check_same(f"SAM's {name}", a[0], b[0])


def prompts_and_answers(model, embedding, points, side: int):
    """Prompts as ovimap gives them, with the answers of the checkpoint's own code."""

    def labels(*values):
        return torch.tensor([[values] * points.shape[1]], dtype=torch.float32)

    def answer(**prompt):
        outputs = model(image_embeddings=embedding, multimask_output=True, **prompt)
        return outputs.pred_masks, outputs.iou_scores

    first = points[:, :, :1]
    nothing = torch.zeros_like(first)
    yield (
        (torch.cat([first, nothing], 2), labels(FOREGROUND, PADDING)),
        answer(input_points=first, input_labels=labels(FOREGROUND).long()),
    )
    yield (
        (torch.cat([points, nothing], 2), labels(FOREGROUND, BACKGROUND, PADDING)),
        answer(input_points=points, input_labels=labels(FOREGROUND, BACKGROUND).long()),
    )
    corners = torch.cat([first * 0.5, first * 0.5 + side * 0.4], 2)
    boxes = corners.flatten(2)
    yield (corners, labels(BOX_MIN, BOX_MAX)), answer(input_boxes=boxes)
    yield (
        (torch.cat([first, corners], 2), labels(FOREGROUND, BOX_MIN, BOX_MAX)),
        answer(input_points=first, input_labels=labels(FOREGROUND).long(), input_boxes=boxes),
    )


@torch.no_grad()
def export_sam(checkpoint: str, config, writer) -> dict:
    model = SamModel.from_pretrained(
        checkpoint, dtype=torch.float32, attn_implementation="eager"
    ).eval()
    processor = AutoImageProcessor.from_pretrained(checkpoint, backend="pil")
    side = config.vision_config.image_size
    if side_of(processor.size, "size") != side:
        raise ExportError(
            f"the image processor makes {dict(processor.size)}, the network takes {side} pixels"
        )
    images = torch.rand(2, 3, side, side, generator=torch.Generator().manual_seed(1)) * 4 - 2
    export_encoder(model, writer, images)
    export_decoder(model, writer, image_embedding(model, images[:1]), side)
    return {
        "kind": "sam",
        "input": image_input(processor, "long_side", side),
        "networks": {
            "encoder": {
                "file": ENCODER,
                "inputs": {"image": "pixel_values"},
                "outputs": {"embedding": "image_embeddings"},
            },
            "decoder": {
                "file": DECODER,
                "inputs": {
                    "embedding": "image_embeddings",
                    "points": "input_points",
                    "labels": "input_labels",
                },
                "outputs": {"masks": "pred_masks", "scores": "iou_scores"},
            },
        },
    }
