#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes small promptable models, one of each signature in use, for tests without a download.

All of them segment by colour: the encoder averages the image in cells of 4x4 pixels; the decoder
takes the colour at the prompt's first point and gives, as its three masks, the cells whose colour
is near, nearer and nearest. On images of plain patches their answer is therefore known.

signature  decoder inputs                                                     prompts a run
batched    embedding, points [N,P,2], labels                                  any number
sam        points [1,P,2], mask_input, has_mask_input, orig_im_size besides   one
sam2       two high-resolution features, mask_input, has_mask_input besides   any number
efficient  points [1,N,P,2], labels [1,N,P], orig_im_size (int64) besides     any number
finder     as batched; besides a finder that sees blue things of three by three cells
"""

import argparse
import hashlib
import pathlib

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

INPUT_PX, CELL_PX = 64, 4
SIDE = INPUT_PX // CELL_PX
NEAR = (1.5, 0.6, 0.3)  # colour distance of the three masks (whole, part, subpart)
GAIN = 8.0  # logits per unit of colour distance
SCORES = (0.95, 0.97, 0.90)
FLOAT, INT64 = TensorProto.FLOAT, TensorProto.INT64

MODEL_YAML = """# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Written by tools/models/make_golden_sam.py.
kind: sam
name: golden {signature} network
license: Apache-2.0
source: tools/models/make_golden_sam.py
input: {{size: {size}, resize: {resize}, mean: [128, 128, 128], std: [64, 64, 64]}}
networks:
  encoder: {{file: encoder.onnx, inputs: {{image: image}}, outputs: {{{features}}}}}
  decoder:
    file: decoder.onnx
    inputs: {{{features}, {inputs}}}
    outputs: {{masks: {masks}, scores: {scores}}}
{networks}sha256:
  encoder.onnx: {encoder}
  decoder.onnx: {decoder}
{digests}"""
FINDER = "  finder: {file: finder.onnx, inputs: {embedding: embedding}, outputs: {things: things}}\n"


def node(kind, inputs, output, **attributes):
    return helper.make_node(kind, inputs.split(), [output], **attributes)


def info(name, shape, kind=FLOAT):
    return helper.make_tensor_value_info(name, kind, shape)


def model_bytes(name, nodes, inputs, outputs, constants):
    tensors = [numpy_helper.from_array(np.asarray(v), k) for k, v in constants.items()]
    graph = helper.make_graph(nodes, name, inputs, outputs, tensors)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    onnx.checker.check_model(model)
    return model.SerializeToString(deterministic=True)


def encoder(high_resolution):
    nodes = [node("AveragePool", "image", "embedding", kernel_shape=[4, 4], strides=[4, 4])]
    outputs = [info("embedding", [1, 3, SIDE, SIDE])]
    if high_resolution:
        nodes += [
            node("Identity", "image", "high_res_feats_0"),
            node("AveragePool", "image", "high_res_feats_1", kernel_shape=[2, 2], strides=[2, 2]),
        ]
        outputs += [
            info("high_res_feats_0", [1, 3, INPUT_PX, INPUT_PX]),
            info("high_res_feats_1", [1, 3, INPUT_PX // 2, INPUT_PX // 2]),
        ]
    return model_bytes("encoder", nodes, [info("image", [1, 3, INPUT_PX, INPUT_PX])], outputs, {})


def colour_nodes(cells):
    """`cells` [1,3,S,S] and `points` [N,P,2] to `mask_logits` [N,3,S,S], `mask_scores` [N,3]."""
    return [
        node("Slice", "points zero one axis_1", "first"),  # [N,1,2]
        node("Squeeze", "first axis_1", "corner"),  # [N,2], pixel corners
        node("Div", "corner cell_px", "in_cells"),
        node("Floor", "in_cells", "floor"),
        node("Clip", "floor lowest highest", "cell"),
        node("MatMul", "cell strides", "index_float"),  # [N], y * S + x
        node("Cast", "index_float", "index", to=INT64),
        node("Reshape", f"{cells} flat", "colours"),  # [3, S*S]
        node("Gather", "colours index", "asked", axis=1),  # [3, N]
        node("Unsqueeze", "asked axis_2", "asked_column"),  # [3, N, 1]
        node("Unsqueeze", "colours axis_1", "colours_row"),  # [3, 1, S*S]
        node("Sub", "colours_row asked_column", "difference"),  # [3, N, S*S]
        node("Abs", "difference", "absolute"),
        node("ReduceSum", "absolute zero", "distance", keepdims=0),  # [N, S*S]
        node("Unsqueeze", "distance axis_1", "distance_row"),  # [N, 1, S*S]
        node("Sub", "near distance_row", "margin"),  # [N, 3, S*S]
        node("Mul", "margin gain", "flat_logits"),
        node("Reshape", "flat_logits grid", "mask_logits"),
        node("Mul", "index_float nothing", "zeros"),
        node("Unsqueeze", "zeros axis_1", "zero_column"),
        node("Add", "zero_column score_row", "mask_scores"),
    ]


def constants():
    f, i = np.float32, np.int64
    return {
        "zero": i([0]),
        "one": i([1]),
        "axis_1": i([1]),
        "axis_2": i([2]),
        "flat": i([3, -1]),
        "grid": i([-1, len(NEAR), SIDE, SIDE]),
        "cell_px": f(CELL_PX),
        "lowest": f(0),
        "highest": f(SIDE - 1),
        "strides": f([1, SIDE]),
        "near": f(NEAR).reshape(1, -1, 1),
        "gain": f(GAIN),
        "nothing": f(0),
        "score_row": f(SCORES).reshape(1, -1),
    }


# Inputs of the signatures that carry a mask from before: they must be given, and must be zero.
MASK_INPUTS = [info("mask_input", [1, 1, SIDE, SIDE]), info("has_mask_input", [1])]


def with_mask_input(nodes):
    """Spoils the masks unless mask_input and has_mask_input are zero."""
    return nodes + [
        node("Add", "mask_input has_mask_input", "spoiler"),
        node("Sub", "mask_logits spoiler", "low_res_masks"),
    ]


def batched_decoder():
    nodes = colour_nodes("embedding") + [
        node("Identity", "mask_logits", "masks"),
        node("Identity", "mask_scores", "iou_predictions"),
    ]
    inputs = [
        info("embedding", [1, 3, SIDE, SIDE]),
        info("points", ["n", "p", 2]),
        info("labels", ["n", "p"]),
    ]
    outputs = [info("masks", ["n", 3, SIDE, SIDE]), info("iou_predictions", ["n", 3])]
    return model_bytes("batched", nodes, inputs, outputs, constants())


def sam_decoder():
    nodes = with_mask_input(colour_nodes("embedding")) + [
        node("Identity", "mask_scores", "iou_predictions")
    ]
    inputs = [
        info("embedding", [1, 3, SIDE, SIDE]),
        info("points", [1, "p", 2]),
        info("labels", [1, "p"]),
        *MASK_INPUTS,
        info("orig_im_size", [2]),
    ]
    outputs = [info("low_res_masks", [1, 3, SIDE, SIDE]), info("iou_predictions", [1, 3])]
    return model_bytes("sam", nodes, inputs, outputs, constants())


def sam2_decoder():
    """Colours are the mean of all three features, so each must be the right one."""
    nodes = (
        [
            node("AveragePool", "high_res_feats_0", "cells_0", kernel_shape=[4, 4], strides=[4, 4]),
            node("AveragePool", "high_res_feats_1", "cells_1", kernel_shape=[2, 2], strides=[2, 2]),
            node("Mean", "cells_0 cells_1 embedding", "cells"),
        ]
        + with_mask_input(colour_nodes("cells"))
        + [node("Identity", "mask_scores", "iou_predictions")]
    )
    inputs = [
        info("embedding", [1, 3, SIDE, SIDE]),
        info("high_res_feats_0", [1, 3, INPUT_PX, INPUT_PX]),
        info("high_res_feats_1", [1, 3, INPUT_PX // 2, INPUT_PX // 2]),
        info("points", ["n", "p", 2]),
        info("labels", ["n", "p"]),
        *MASK_INPUTS,
    ]
    outputs = [info("low_res_masks", ["n", 3, SIDE, SIDE]), info("iou_predictions", ["n", 3])]
    return model_bytes("sam2", nodes, inputs, outputs, constants())


def efficient_decoder():
    """Masks come at the asked size, here by choosing cells with a nearest-neighbour resize."""
    nodes = (
        [node("Squeeze", "batched_points zero", "points")]
        + colour_nodes("embedding")
        + [
            node("Shape", "mask_logits", "logit_shape"),
            node("Slice", "logit_shape zero two", "leading"),
            helper.make_node("Concat", ["leading", "orig_im_size"], ["wanted"], axis=0),
            helper.make_node(
                "Resize", ["mask_logits", "", "", "wanted"], ["resized"], mode="nearest"
            ),
            node("Unsqueeze", "resized zero", "output_masks"),
            node("Unsqueeze", "mask_scores zero", "iou_predictions"),
        ]
    )
    inputs = [
        info("embedding", [1, 3, SIDE, SIDE]),
        info("batched_points", [1, "n", "p", 2]),
        info("labels", [1, "n", "p"]),
        info("orig_im_size", [2], INT64),
    ]
    outputs = [info("output_masks", [1, "n", 3, "h", "w"]), info("iou_predictions", [1, "n", 3])]
    return model_bytes("efficient", nodes, inputs, outputs, constants() | {"two": np.int64([2])})


def finder():
    """Of blue less red, smoothed so that the middle of a thing stands out: how deep; boxes reach one and a half cells to all sides."""
    weight, bias = np.zeros((6, 3, 1, 1), np.float32), np.log([1, *[1.5] * 4, 20.0]).astype(np.float32)
    weight[0, :, 0, 0], bias[0] = (-3, 0, 3), -4
    nodes = [node("AveragePool", "embedding", "smooth", kernel_shape=[3, 3], pads=[1] * 4), node("Conv", "smooth weight bias", "things")]
    inputs, outputs = [info("embedding", [1, 3, "rows", "columns"])], [info("things", [1, 6, "rows", "columns"])]
    return model_bytes("finder", nodes, inputs, outputs, {"weight": weight, "bias": bias})


COMMON = "points: points, labels: labels"
WITH_MASK = COMMON + ", mask_input: mask_input, has_mask_input: has_mask_input"
HIGH_FEATURES = "embedding: embedding, high_res_0: high_res_feats_0, high_res_1: high_res_feats_1"
SIGNATURES = {
    "batched": (batched_decoder, "embedding: embedding", COMMON, "masks", "long_side"),
    "sam": (
        sam_decoder,
        "embedding: embedding",
        WITH_MASK + ", image_size: orig_im_size",
        "low_res_masks",
        "long_side",
    ),
    "finder": (batched_decoder, "embedding: embedding", COMMON, "masks", "long_side"),
    "sam2": (sam2_decoder, HIGH_FEATURES, WITH_MASK, "low_res_masks", "stretch"),
    "efficient": (
        efficient_decoder,
        "embedding: embedding",
        "points: batched_points, labels: labels, image_size: orig_im_size",
        "output_masks",
        "stretch",
    ),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help="the tests read testdata/golden_sam")
    folder = parser.parse_args().folder
    for signature, (decoder, features, inputs, masks, resize) in SIGNATURES.items():
        target = folder / signature
        target.mkdir(parents=True, exist_ok=True)
        files = {"encoder": encoder("high_res" in features), "decoder": decoder()}
        files |= {"finder": finder()} if signature == "finder" else {}
        for name, data in files.items():
            (target / f"{name}.onnx").write_bytes(data)
        digests = {name: hashlib.sha256(data).hexdigest() for name, data in files.items()}
        (target / "model.yaml").write_text(
            MODEL_YAML.format(
                signature=signature,
                size=INPUT_PX,
                resize=resize,
                features=features,
                inputs=inputs,
                masks=masks,
                scores="iou_predictions",
                encoder=digests["encoder"],
                decoder=digests["decoder"],
                networks=FINDER if "finder" in files else "",
                digests=f"  finder.onnx: {digests['finder']}\n" if "finder" in files else "",
            )
        )


if __name__ == "__main__":
    main()
