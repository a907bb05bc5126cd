# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The `input` part of model.yaml, from a Hugging Face image processor's settings."""

from .errors import ExportError

BILINEAR, BICUBIC = 2, 3  # as Pillow numbers them
FILTERS = {BILINEAR: "bilinear", BICUBIC: "bicubic"}


def scaled(processor, values):
    """`values` of an image scaled to 0..1, for pixels from 0 to 255."""
    factor = 1 / processor.rescale_factor if processor.do_rescale else 1.0
    return [round(float(v) * factor, 6) for v in values]


def filter_name(processor) -> str:
    name = FILTERS.get(int(processor.resample))
    if name is None:
        raise ExportError(
            f"the image processor resizes with filter {int(processor.resample)}; "
            "ovimap knows bilinear (2) and bicubic (3)"
        )
    return name


def side_of(size, name: str) -> int:
    """The side of a square `size`, however the processor writes it."""
    size = dict(size)
    for key in ("shortest_edge", "longest_edge"):
        if size.get(key):
            return int(size[key])
    if size.get("height") and size["height"] == size.get("width"):
        return int(size["height"])
    raise ExportError(f"the image processor's {name} is {size}; ovimap needs a square")


def image_input(processor, resize: str, side: int) -> dict:
    """`resize`: stretch, short_side or long_side, as ovimap calls them."""
    normalise = processor.do_normalize
    return {
        "size": side,
        "resize": resize,
        "filter": filter_name(processor),
        "mean": scaled(processor, processor.image_mean if normalise else (0, 0, 0)),
        "std": scaled(processor, processor.image_std if normalise else (1, 1, 1)),
    }


def encoder_input(processor, network_side: int) -> dict:
    """What SigLIP's and CLIP's processors do: a stretch, or the short side and a centre crop."""
    cropped = bool(getattr(processor, "do_center_crop", False))
    side = side_of(processor.size, "size")
    if cropped and side_of(processor.crop_size, "crop_size") != side:
        raise ExportError(
            f"the image processor scales to {dict(processor.size)} and crops "
            f"{dict(processor.crop_size)}; ovimap needs both alike"
        )
    if side != network_side:
        raise ExportError(
            f"the image processor makes {side} pixels, the network takes {network_side}"
        )
    by_short_side = bool(dict(processor.size).get("shortest_edge"))
    if by_short_side and not cropped:
        raise ExportError("the image processor keeps the aspect ratio without a centre crop")
    return image_input(processor, "short_side" if by_short_side else "stretch", side)
