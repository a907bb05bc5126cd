# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of an index: a Parquet file for each map, the vectors, and index.json, which says what belongs to it.

New files get new names, and replacing index.json puts them in force: whoever reads, or is killed, meets the old index or the new one.
"""

from __future__ import annotations

import os
import pathlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from .._ovimap import Error
from ..files import exclusive, read_json, write_json
from ..map_facts import Encoder, map_facts
from .objects import embeddings_of, object_table, require_same_encoder
from .vectors import Ids, State, VectorFiles, Vectors

FORMAT = 1
MANIFEST = "index.json"


@dataclass(frozen=True)
class Entry:
    """A map in the index."""

    path: str
    number: int  # never given twice; the upper half of its objects' ids in the vectors
    revision: str
    content_hash: str
    objects: int
    file: str  # its Parquet file, in the index's folder


@dataclass
class Update:
    """What became of maps that were to be put into an index."""

    added: list[str] = field(default_factory=list)
    replaced: list[str] = field(default_factory=list)
    kept: list[str] = field(default_factory=list)
    refused: dict[str, str] = field(default_factory=dict)  # path: why


class Store:
    """Reads the manifest when made; the vectors when they are first searched."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = pathlib.Path(folder)
        self.read()

    def read(self) -> None:
        for cached in ("_vectors", "_numbers"):
            self.__dict__.pop(cached, None)
        try:
            manifest = read_json(self.folder / MANIFEST)
        except FileNotFoundError:
            manifest = {"format": FORMAT, "encoder": None, "vectors": None, "next_number": 1, "maps": []}
        except (OSError, ValueError) as fault:
            raise Error(f"{self.folder} holds no sound index ({fault}); build it anew in another folder") from None
        if manifest.get("format") != FORMAT:
            raise Error(f"{self.folder} holds an index of format {str(manifest.get('format'))[:20]}, this ovimap reads {FORMAT}; build it anew")
        try:
            self._encoder = Encoder(**manifest["encoder"]) if manifest["encoder"] else None
            self._state = State(**manifest["vectors"]) if manifest["vectors"] else None
            self._next_number: int = manifest["next_number"]
            self.entries = {entry["path"]: Entry(**entry) for entry in manifest["maps"]}
            self.paths = {entry.number: entry.path for entry in self.entries.values()}
        except (KeyError, TypeError) as fault:
            raise Error(f"{self.folder} holds no sound index ({fault}); build it anew in another folder") from None

    def require(self) -> None:
        if self._encoder is None:
            raise Error(f"there is no index in {self.folder}; make one: `ovimap-index build MAP... -o {self.folder}`")

    @property
    def encoder(self) -> Encoder:
        self.require()
        assert self._encoder is not None
        return self._encoder

    @cached_property
    def _vectors(self) -> VectorFiles:
        self.require()
        assert self._state is not None
        return VectorFiles(self.folder, self.encoder.dimension, self._state)

    @cached_property
    def _numbers(self) -> Ids:
        return np.array(sorted(self.paths), np.int64)

    def search(self, query: Vectors, count: int) -> list[tuple[str, int, float]]:
        """The objects nearest to an embedding: map, id and cosine, best first."""
        self.require()
        while True:
            known = self._state
            try:
                cosines, ids = self._vectors.search(query, count, self._numbers)
                break
            except (OSError, ValueError, RuntimeError) as fault:
                self.read()
                if self._state == known:  # else a writer has put other files in force and swept ours away
                    raise Error(f"the index {self.folder} is damaged ({fault}); build it anew in another folder") from None
        return [(self.paths[id >> 32], id & 0xFFFFFFFF, cosine) for id, cosine in zip(ids.tolist(), cosines.tolist())]

    def put(self, maps: Iterable[str]) -> Update:
        """Adds maps, or takes them anew where they have changed."""
        with self._writing():
            update, changed = Update(), []
            for path in dict.fromkeys(maps):
                try:
                    entry = self._put_map(path, update)
                except Error as fault:
                    update.refused[path] = str(fault)
                    continue
                if entry is not None:
                    changed.append(entry)
            self._commit(changed, [])
        return update

    def put_tables(self, tables: Iterable[pa.Table], encoder: Encoder) -> None:
        """Adds objects that are in no map file: tables as object_table makes them, each of one map that is not in yet."""
        with self._writing():
            self._encoder = self._encoder or encoder
            self._commit([self._write(table) for table in tables], [])

    def remove(self, maps: Iterable[str]) -> None:
        with self._writing():
            self.require()
            paths = list(dict.fromkeys(maps))
            for path in paths:
                if path not in self.entries:
                    raise Error(f"{path} is not in the index {self.folder}; `ovimap-index list {self.folder}` names what is")
            self._commit([], paths)

    @contextmanager
    def _writing(self) -> Iterator[None]:
        """Waits for other writers and reads what they wrote."""
        try:
            with exclusive(self.folder / "lock"):
                self.read()
                yield
        except Error:
            raise
        except (OSError, RuntimeError) as fault:  # the latter is all that faiss knows
            raise Error(f"cannot write the index {self.folder} ({fault}); it is as it was: make room, or build it anew in a "
                        "folder that can be written") from None

    def _put_map(self, path: str, update: Update) -> Entry | None:
        facts, known = map_facts(path), self.entries.get(path)
        if known is not None and known.revision == facts.revision:
            update.kept.append(path)
            return None
        if self._encoder is not None:
            require_same_encoder(path, self._encoder)
        table = object_table(path)
        self._encoder = self._encoder or facts.encoder
        (update.added if known is None else update.replaced).append(path)
        return self._write(table, path, facts.revision, facts.content_hash)

    def _write(self, table: pa.Table, path: str = "", revision: str = "", content_hash: str = "") -> Entry:
        if not path:
            path, revision, content_hash = (table[name][0].as_py() for name in ("map", "revision", "content_hash"))
        number = self._number()
        entry = Entry(path, number, revision, content_hash, len(table), f"maps/{number}.parquet")
        (self.folder / "maps").mkdir(parents=True, exist_ok=True)
        pq.write_table(table, self.folder / entry.file, compression="zstd")
        return entry

    def _commit(self, changed: list[Entry], removed: list[str]) -> None:
        if not changed and not removed:
            return
        for path in removed:
            del self.entries[path]
        self.entries |= {entry.path: entry for entry in changed}
        vectors = self._changed_vectors(changed)
        manifest = {"format": FORMAT, "encoder": asdict(self.encoder), "vectors": asdict(vectors.state), "next_number": self._next_number,
                    "maps": [asdict(entry) for entry in self.entries.values()]}
        write_json(self.folder / MANIFEST, manifest)
        self.read()
        self._sweep()

    def _changed_vectors(self, changed: list[Entry]) -> VectorFiles:
        """Appends what is new; writes all anew when much of what is there belongs to maps that are gone."""
        rows = sum(entry.objects for entry in self.entries.values())
        vectors = VectorFiles(self.folder, self.encoder.dimension, self._state or State(""))
        if self._state is None or vectors.state.rows + sum(entry.objects for entry in changed) > 2 * rows:
            vectors = VectorFiles(self.folder, self.encoder.dimension, State(f"rows-{self._number()}"))
            changed = list(self.entries.values())
        return vectors.append(self._blocks(changed)).with_codes(f"codes-{self._number()}.faiss")

    def _blocks(self, entries: list[Entry]) -> Iterator[tuple[Vectors, Ids]]:
        for entry in entries:
            table = pq.read_table(self.folder / entry.file, columns=["object", "embedding"])
            vectors, positions = embeddings_of(table)
            yield vectors, (entry.number << 32) + table["object"].to_numpy().astype("int64")[positions]

    def _number(self) -> int:
        self._next_number += 1
        return self._next_number - 1

    def _sweep(self) -> None:
        """Deletes what belongs to no index any more; what a killed writer left, too."""
        ours = {entry.file for entry in self.entries.values()} | (self._state.files if self._state else set())
        for path in [*self.folder.glob("maps/*.parquet"), *self.folder.glob("rows-*"), *self.folder.glob("codes-*")]:
            if path.relative_to(self.folder).as_posix() not in ours:
                path.unlink(missing_ok=True)
