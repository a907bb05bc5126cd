# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Search among many embeddings by cosine: exact while they are few; when they are many, faiss proposes and exact cosines decide."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import faiss
import numpy as np
import numpy.typing as npt

Vectors = npt.NDArray[np.float32]
Ids = npt.NDArray[np.int64]

EXACT_ROWS = 50_000  # up to here looking at all of them takes a few milliseconds
# Texts lie far from all embeddings of pictures, so that lists near a text hold too few of its neighbours: half of them are
# searched, on short codes, and what comes out is many candidates. docs/many-maps.md has the figures.
CODE_NUMBERS = 128
LISTS = 256
PROBED_SHARE = 2
CANDIDATES = 400
TRAINING_ROWS = 65_536
BLOCK_ROWS = 50_000


@dataclass(frozen=True)
class State:
    """Which files hold the vectors, and how much of them counts: what is behind that was never committed."""

    file: str  # FILE.f16, rows of 16-bit floats, and FILE.ids, 64-bit numbers; only ever appended to
    rows: int = 0
    codes: str = ""  # faiss' index of the rows; empty: there is none, every row is looked at
    trained_rows: int = 0  # how many there were when it was trained

    @property
    def files(self) -> set[str]:
        return {f"{self.file}.f16", f"{self.file}.ids", self.codes}


class VectorFiles:
    """Vectors of length 1 under 64-bit ids, in a folder. Files in force are never changed, but for what is appended."""

    def __init__(self, folder: pathlib.Path, dimension: int, state: State) -> None:
        self.folder, self.dimension, self.state = folder, dimension, state

    def append(self, blocks: Iterable[tuple[Vectors, Ids]]) -> VectorFiles:
        """Adds vectors behind those that count; they count for the result."""
        rows = self.state.rows
        with _open_at(self._path(".f16"), rows * self.dimension * 2) as vectors, _open_at(self._path(".ids"), rows * 8) as ids:
            for block_vectors, block_ids in blocks:
                vectors.write(block_vectors.astype(np.float16).tobytes())
                ids.write(block_ids.astype(np.int64).tobytes())
                rows += len(block_ids)
            for file in (vectors, ids):
                file.flush()
                os.fsync(file.fileno())
        return VectorFiles(self.folder, self.dimension, replace(self.state, rows=rows))

    def with_codes(self, name: str) -> VectorFiles:
        """The same with an index of all rows in a new file of that name, when there are so many that it pays."""
        state = self.state
        if state.rows <= EXACT_ROWS:
            return VectorFiles(self.folder, self.dimension, replace(state, codes="", trained_rows=0))
        if state.codes and state.rows <= 4 * state.trained_rows:
            codes, trained_rows = faiss.read_index(str(self.folder / state.codes)), state.trained_rows
        else:
            codes, trained_rows = self._trained(), state.rows
        for first in range(codes.ntotal, state.rows, BLOCK_ROWS):
            codes.add(self._vectors[first:first + BLOCK_ROWS].astype(np.float32))
        faiss.write_index(codes, str(self.folder / name))
        with open(self.folder / name, "rb") as file:
            os.fsync(file.fileno())
        return VectorFiles(self.folder, self.dimension, replace(state, codes=name, trained_rows=trained_rows))

    def search(self, query: Vectors, count: int, numbers: Ids) -> tuple[Vectors, Ids]:
        """Cosines and ids of the nearest, best first, among ids whose upper half is one of `numbers` (sorted)."""
        query = np.ascontiguousarray(query, np.float32)
        if self.state.codes:
            _, found = self._codes.search(query[None], max(CANDIDATES, 4 * count))
            rows = np.sort(found[0][found[0] >= 0])
            cosines, ids = self._vectors[rows].astype(np.float32) @ query, self._ids[rows]
        else:
            cosines, ids = self._exact @ query, self._ids
        cosines = np.where(np.isin(ids >> 32, numbers), cosines, -np.inf)
        best = np.argsort(-cosines, kind="stable")[:count]
        best = best[np.isfinite(cosines[best])]
        return cosines[best], ids[best]

    @cached_property
    def _codes(self) -> Any:
        # Lists stay in the file, and come into memory as they are searched: opening takes no time.
        codes = faiss.read_index(str(self.folder / self.state.codes), faiss.IO_FLAG_MMAP)
        lists = faiss.extract_index_ivf(codes)
        lists.nprobe = lists.nlist // PROBED_SHARE
        return codes  # one thread a query, faiss' default: two that share one wait for each other on a busy machine

    @cached_property
    def _vectors(self) -> npt.NDArray[np.float16]:
        return np.memmap(self._path(".f16"), np.float16, "r", shape=(self.state.rows, self.dimension))

    @cached_property
    def _ids(self) -> Ids:
        return np.fromfile(self._path(".ids"), np.int64, count=self.state.rows)

    @cached_property
    def _exact(self) -> Vectors:
        return self._vectors.astype(np.float32) if self.state.rows else np.zeros((0, self.dimension), np.float32)

    def _path(self, ending: str) -> pathlib.Path:
        return self.folder / f"{self.state.file}{ending}"

    def _trained(self) -> Any:
        rows = np.random.default_rng(0).choice(self.state.rows, min(TRAINING_ROWS, self.state.rows), replace=False)
        sample = self._vectors[np.sort(rows)].astype(np.float32)
        kept = min(CODE_NUMBERS, self.dimension)
        # The directions that carry most of the products. Not centred: a mean taken off would change the ranking.
        axes = np.linalg.eigh(sample.T @ sample)[1][:, ::-1][:, :kept]
        projection = faiss.LinearTransform(self.dimension, kept, False)
        faiss.copy_array_to_vector(np.ascontiguousarray(axes.T).ravel(), projection.A)
        projection.is_trained = True
        lists = faiss.IndexIVFScalarQuantizer(
            faiss.IndexFlatIP(kept), kept, LISTS, faiss.ScalarQuantizer.QT_8bit, faiss.METRIC_INNER_PRODUCT, False)
        lists.cp.spherical = True
        codes = faiss.IndexPreTransform(projection, lists)
        codes.train(sample)
        return codes


def _open_at(path: pathlib.Path, size: int) -> Any:
    """Opens a file for writing behind its first `size` bytes; what stands there is dropped."""
    file = open(path, "r+b" if path.exists() else "w+b")
    file.truncate(size)
    file.seek(size)
    return file
