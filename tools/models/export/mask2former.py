# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Mask2Former to a folder of kind entity."""

import torch
from transformers import AutoImageProcessor, Mask2FormerForUniversalSegmentation

from .errors import ExportError
from .image_input import image_input
from .network import Wrapped, check_same, export_network, run_onnx

NETWORK = "network.onnx"
OUTPUTS = {"classes": "class_queries_logits", "masks": "masks_queries_logits"}
STRIDE = 32  # of the coarsest features: the input's side is a multiple of it
CAMERA_ASPECT = 4 / 3  # of the images for which a rule by both edges becomes one side
CHECKED_IMAGES = 3


def query_logits(model, pixels):
    outputs = model(pixel_values=pixels)
    return outputs.class_queries_logits, outputs.masks_queries_logits


def square_input(processor, input_px) -> tuple:
    """Resize rule and side. A processor that scales by its short and long edge gives images of any
    shape; ovimap's network has one square input, whose long side a 4:3 image fills at that
    scale."""
    size = dict(processor.size)
    if size.get("height"):
        rule, side = "stretch", max(size["height"], size["width"])
        side += -side % STRIDE
    elif size.get("shortest_edge") and size.get("longest_edge"):
        rule, side = "long_side", min(size["shortest_edge"] * CAMERA_ASPECT, size["longest_edge"])
        side = int(side) // STRIDE * STRIDE
    else:
        raise ExportError(
            f"the image processor's size is {size}; ovimap cannot make a square of it"
        )
    side = input_px or side
    if side % STRIDE or side < STRIDE:
        raise ExportError(f"--input-px is {side}; Mask2Former takes multiples of {STRIDE}")
    return rule, side


@torch.no_grad()
def export_mask2former(checkpoint: str, _config, writer, input_px=None) -> dict:
    model = Mask2FormerForUniversalSegmentation.from_pretrained(checkpoint, dtype=torch.float32)
    module = Wrapped(model, query_logits).eval()
    processor = AutoImageProcessor.from_pretrained(checkpoint, backend="pil")
    rule, side = square_input(processor, input_px)

    generator = torch.Generator().manual_seed(1)
    images = torch.rand(CHECKED_IMAGES, 3, side, side, generator=generator) * 4 - 2
    names = ["pixel_values", *OUTPUTS.values()]
    axes = {name: {0: "images"} for name in names}
    path = writer.path(NETWORK)
    export_network(module, [images[:2]], path, names[:1], names[1:], axes)
    for batch in (images[:1], images):
        expected, found = module(batch), run_onnx(path, {"pixel_values": batch})
        for name, a, b in zip(OUTPUTS, expected, found):
            check_same(f"Mask2Former's {name}", a, b)
    return {
        "kind": "entity",
        "input": image_input(processor, rule, side),
        "networks": {
            "network": {
                "file": NETWORK,
                "inputs": {"image": "pixel_values"},
                "outputs": OUTPUTS,
            }
        },
    }
