#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""How quickly, and how completely, the index finds the nearest of a million objects.

    bench/index_speed.py MAP... [--objects 1000000] [--folder DIR] [--json OUT]

MAPs are real ones with embeddings of the default encoder. A million real objects are not at hand, so they are made of
the maps' own: an object is one real embedding blurred towards a second (a crop shows neighbours too) and towards a word,
plus noise, so that neighbours are about as alike as in real maps; the figures printed show how alike. Questions
are words that had no part in it, encoded as texts. Recall counts how many of the exact ten nearest, by plain float32, are
among the ten that the index names."""
from __future__ import annotations

import argparse
import json
import os
import pathlib
import platform
import shutil
import tempfile
import time
from collections.abc import Iterator

import faiss
import numpy as np
import ovimap
import pyarrow as pa
from ovimap.index import ObjectIndex
from ovimap.index.objects import encoder_of, object_schema
from ovimap.index.store import Store
from ovimap.map_facts import Encoder

WORDS = pathlib.Path(__file__).parents[1] / "src/ovimap/semantics/data"
TABLE_ROWS = 50_000  # a thousand rooms of fifty objects each: what counts is how many objects there are
QUERIES = 200


def words_of(name: str) -> list[str]:
    lines = (line.strip() for line in (WORDS / f"{name}.txt").read_text(encoding="utf-8").splitlines())
    return [line.lstrip("0123456789 ") for line in lines if line and not line.startswith("#")]


class Objects:
    """Makes objects, the same ones whenever it is asked."""

    def __init__(self, real: np.ndarray, words: np.ndarray, count: int) -> None:
        self.real, self.words, self.count = real, words, count

    def blocks(self, rows: int = TABLE_ROWS) -> Iterator[np.ndarray]:
        for first in range(0, self.count, rows):
            yield self.block(first, min(rows, self.count - first))

    def block(self, first: int, rows: int) -> np.ndarray:
        random = np.random.default_rng(first)
        pick = lambda pool: pool[random.integers(0, len(pool), rows)]
        blur, name = (random.beta(1, 4, (rows, 1)).astype(np.float32) * most for most in (1.0, 0.8))
        made = pick(self.real) * (1 - blur) + pick(self.real) * blur + pick(self.words) * name
        made += random.standard_normal(made.shape, np.float32) * (0.2 / np.sqrt(made.shape[1]))
        return made / np.linalg.norm(made, axis=1, keepdims=True)


def tables(objects: Objects, encoder: Encoder) -> Iterator[pa.Table]:
    schema = object_schema(encoder)
    for number, made in enumerate(objects.blocks(TABLE_ROWS)):
        rows = len(made)
        vectors = pa.FixedSizeListArray.from_arrays(pa.array(made.reshape(-1)), made.shape[1])
        corner = pa.FixedSizeListArray.from_arrays(pa.array(np.zeros(3 * rows, np.float32)), 3)
        text = lambda value: pa.repeat(value, rows)
        yield pa.table([text(f"/rooms/{number}"), text(f"{number}"), text(""), pa.array(np.arange(rows, dtype=np.uint32)), text(""),
                        corner, corner, corner, pa.array(np.ones(rows, np.int64)), pa.array(np.ones(rows, np.int64)),
                        text(encoder.name), text(encoder.digest), vectors], schema=schema)


def exact_nearest(objects: Objects, queries: np.ndarray) -> np.ndarray:
    """The ten nearest of each query by plain float32: [queries, 10] places in the order in which objects are made."""
    cosines, places, done = np.zeros((len(queries), 0), np.float32), np.zeros((len(queries), 0), np.int64), 0
    for made in objects.blocks():
        cosines = np.concatenate([cosines, queries @ made.T], axis=1)
        places = np.concatenate([places, np.broadcast_to(np.arange(done, done + len(made)), (len(queries), len(made)))], axis=1)
        best = np.argpartition(-cosines, 9, axis=1)[:, :10]
        cosines, places, done = np.take_along_axis(cosines, best, 1), np.take_along_axis(places, best, 1), done + len(made)
    return places


def percentiles(values: np.ndarray | list[float]) -> dict[str, float]:
    return {name: float(np.percentile(values, at)) for name, at in (("p5", 5), ("p50", 50), ("p95", 95))}


def alikeness(embeddings: np.ndarray, texts: np.ndarray) -> dict[str, dict[str, float]]:
    """How near each embedding is to its nearest neighbour, and to the text nearest to it."""
    return {"nearest neighbour": percentiles(np.sort(embeddings @ embeddings.T, axis=1)[:, -2]),
            "nearest word": percentiles((embeddings @ texts.T).max(axis=1))}


def measure(folder: pathlib.Path, objects: Objects, queries: np.ndarray, encoder: Encoder) -> dict[str, object]:
    begun = time.perf_counter()
    Store(folder).put_tables(tables(objects, encoder), encoder)
    build_s = time.perf_counter() - begun
    nearest, begun = exact_nearest(objects, queries), time.perf_counter()
    index = ObjectIndex(folder)
    index.nearest(queries[0])
    open_s = time.perf_counter() - begun
    taken_ms, found = [], []
    for passes in range(2):  # the first one reads the lists from disk
        for query, exact in zip(queries, nearest):
            begun = time.perf_counter()
            hits = index.nearest(query, 10)
            taken_ms.append(1e3 * (time.perf_counter() - begun))
            found.append(len({int(hit.map.rpartition("/")[2]) * TABLE_ROWS + hit.object for hit in hits} & set(exact.tolist())) / 10)
    sizes = {kind: sum(file.stat().st_size for file in folder.glob(kind)) / 1e6 for kind in ("codes-*", "rows-*", "maps/*")}
    return {"objects": len(index), "build_s": build_s, "open_s": open_s, "codes_mb": sizes["codes-*"], "rows_mb": sizes["rows-*"],
            "tables_mb": sizes["maps/*"], "query_ms": percentiles(taken_ms[len(queries):]),
            "first_pass_ms": percentiles(taken_ms[: len(queries)]), "recall_at_10": float(np.mean(found)), "worst_recall": min(found)}


def machine() -> str:
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.machine())
    return f"{model}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("maps", nargs="+", metavar="MAP")
    parser.add_argument("--objects", type=int, default=1_000_000)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--folder", help="where the index goes; default: a temporary folder")
    parser.add_argument("--json", help="file for the figures")
    options = parser.parse_args()
    faiss.omp_set_num_threads(options.threads)
    embeddings = np.concatenate([ovimap.Map.open(path).embeddings for path in options.maps])
    real, network = embeddings[np.any(embeddings != 0, axis=1)], ovimap.make_encoder("default")
    asked = sorted(set(words_of("scannet200")))[:QUERIES]
    others = sorted(set(words_of("vocabulary")) - set(asked))
    queries, words = network.encode_texts(asked), network.encode_texts(others)
    objects = Objects(real, words, options.objects)
    folder = pathlib.Path(options.folder or tempfile.mkdtemp(prefix="ovimap-index-"))
    shutil.rmtree(folder, ignore_errors=True)
    try:
        figures = {"machine": machine(), "commit": ovimap.commit(), "threads": options.threads, "real_objects": len(real),
                   "alike": {"real": alikeness(real, queries), "made": alikeness(objects.block(0, len(real)), queries)}}
        figures |= measure(folder, objects, queries, encoder_of(options.maps[0]))
    finally:
        if not options.folder:
            shutil.rmtree(folder, ignore_errors=True)
    text = json.dumps(figures, indent=1)
    print(text)
    if options.json:
        pathlib.Path(options.json).write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
