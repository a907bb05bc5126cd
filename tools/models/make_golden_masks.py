#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the small Mask2Former and SAM folders that prove ovimap's path from an image to masks.

Both are exported with the export tool from checkpoints with random weights. golden_mask2former
holds an image, its entity ids and their scores; golden_sam_hf an image, two prompts, and the mask
logits and predicted IoUs that the checkpoint's own code gives for them.
"""

import argparse
import pathlib
import sys
import tempfile

import numpy as np
import torch
from PIL import Image

from export.checkpoint import Options, export_checkpoint
from golden.textures import textured_image
from golden.tiny_mask_models import QUERIES, tiny_mask2former, tiny_sam

SOURCE = "tools/models/make_golden_masks.py"
# As in entity_mask_source.h.
MIN_SCORE, MASK_PROBABILITY, MIN_MASK_PX = 0.5, 0.5, 40
MIN_MARGIN = 1e-3  # no decision may be so near a threshold that rounding makes it
MIN_ENTITIES = 3
SEEDS = 3000
MASK_IMAGE, SAM_IMAGE = (83, 59), (100, 75)  # width, height
POINT, BOX = (41.0, 30.0), (20.0, 12.0, 70.0, 52.0)  # pixels of SAM_IMAGE


@torch.no_grad()
def query_logits(model, processor, image):
    """Class logits [Q, C + 1], and mask logits at the image's size [Q, H, W]."""
    outputs = model(**processor(Image.fromarray(image), return_tensors="pt"))
    masks = torch.nn.functional.interpolate(
        outputs.masks_queries_logits, size=image.shape[:2], mode="bilinear", align_corners=False
    )
    return outputs.class_queries_logits[0].numpy(), masks[0].double().numpy()


def scores_of(classes, masks) -> np.ndarray:
    """The best class's probability (not "no object") times the mean probability in the mask."""
    weights = np.exp(classes - classes.max(1, keepdims=True))
    best = (weights / weights.sum(1, keepdims=True))[:, :-1].max(1)
    probabilities = 1 / (1 + np.exp(-masks))
    inside = probabilities > MASK_PROBABILITY
    mean = [p[i].mean() if i.any() else 0.0 for p, i in zip(probabilities, inside)]
    return best * np.array(mean)


def paint(masks, scores):
    """Ids and their scores, and how many queries were good enough: the better score wins."""
    ids = np.zeros(masks.shape[1:], np.uint16)
    order = [q for q in np.argsort(scores, kind="stable") if scores[q] >= MIN_SCORE]
    for index, query in enumerate(order):
        ids[masks[query] > 0] = index + 1
    visible = [i + 1 for i in range(len(order)) if (ids == i + 1).sum() >= MIN_MASK_PX]
    result = np.zeros_like(ids)
    for new, old in enumerate(visible):
        result[ids == old] = new + 1
    return result, [scores[order[old - 1]] for old in visible], order


def margin_of(masks, scores, order) -> float:
    """The smallest distance of any decision from its threshold."""
    return min(
        np.abs(scores - MIN_SCORE).min(),
        np.diff(np.sort(scores[order])).min(initial=1),
        min((np.abs(masks[q]).min() for q in order), default=0),
    )


def telling_mask2former(image):
    """The first seed with several entities, some queries dropped, and no narrow decision."""
    for seed in range(SEEDS):
        model, processor = tiny_mask2former(seed)
        classes, masks = query_logits(model, processor, image)
        scores = scores_of(classes, masks)
        ids, visible, order = paint(masks, scores)
        several = MIN_ENTITIES <= len(visible) and len(order) < QUERIES and (ids == 0).any()
        if several and margin_of(masks, scores, order) > MIN_MARGIN:
            return model, processor, ids, visible
    raise SystemExit("no seed gives a telling Mask2Former")


def export_tiny(model, processor, folder: pathlib.Path, name: str) -> None:
    with tempfile.TemporaryDirectory() as checkpoint:
        model.save_pretrained(checkpoint)
        processor.save_pretrained(checkpoint)
        export_checkpoint(checkpoint, folder, Options(name, "Apache-2.0", SOURCE))


def write_mask2former(folder: pathlib.Path) -> None:
    image = textured_image(5, *MASK_IMAGE)
    model, processor, ids, scores = telling_mask2former(image)
    export_tiny(model, processor, folder, "golden Mask2Former")
    Image.fromarray(image).save(folder / "image.png", optimize=True)
    Image.fromarray(ids).save(folder / "ids.png", optimize=True)
    (folder / "scores.txt").write_text("".join(f"{s:.6f}\n" for s in scores))


@torch.no_grad()
def sam_answers(model, processor, image):
    """For a point, and for that point with a box: logits [3, S, S] and IoUs [3]."""
    inputs = processor(Image.fromarray(image), return_tensors="pt")
    scale = max(inputs["pixel_values"].shape[2:]) / max(image.shape)
    prompts = {
        "input_points": torch.tensor([[[POINT]]]) * scale,
        "input_labels": torch.ones(1, 1, 1, dtype=torch.long),
    }
    box = {"input_boxes": torch.tensor([[BOX]]) * scale}
    for prompt in (prompts, prompts | box):
        outputs = model(pixel_values=inputs["pixel_values"], multimask_output=True, **prompt)
        yield outputs.pred_masks[0, 0].numpy(), outputs.iou_scores[0, 0].numpy()


def telling_sam(image):
    """The first seed whose masks are all partly inside, none with a logit near 0."""
    for seed in range(SEEDS):
        model, processor = tiny_sam(seed)
        answers = list(sam_answers(model, processor, image))
        logits = np.stack([masks for masks, _ in answers])
        inside = (logits > 0).mean(axis=(2, 3))
        if inside.min() > 0.05 and inside.max() < 0.95 and np.abs(logits).min() > MIN_MARGIN:
            return model, processor, answers
    raise SystemExit("no seed gives a telling SAM")


def write_sam(folder: pathlib.Path) -> None:
    image = textured_image(6, *SAM_IMAGE)
    model, processor, answers = telling_sam(image)
    export_tiny(model, processor, folder, "golden SAM")
    Image.fromarray(image).save(folder / "image.png", optimize=True)
    for name, (masks, scores) in zip(("point", "point_and_box"), answers):
        lines = [" ".join(f"{v:.6g}" for v in row) for row in masks.reshape(-1, masks.shape[-1])]
        (folder / f"{name}_masks.txt").write_text("\n".join(lines) + "\n")
        (folder / f"{name}_scores.txt").write_text("".join(f"{s:.6f}\n" for s in scores))


def write_all(root: pathlib.Path) -> list:
    folders = [root / "golden_mask2former", root / "golden_sam_hf"]
    for folder, write in zip(folders, (write_mask2former, write_sam)):
        write(folder)
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
