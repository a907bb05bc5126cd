# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What a map file says of itself, read without opening the map (docs/map-format.md)."""

from __future__ import annotations

import contextlib
import hashlib
import os
import pathlib
import sqlite3
from dataclasses import dataclass

from ._ovimap import Error


@dataclass(frozen=True)
class Encoder:
    """Whose space embeddings are in. Those of different encoders cannot be compared."""

    name: str
    dimension: int
    digest: str  # SHA-256 over the model's files

    def __str__(self) -> str:
        return f"{self.name} ({self.dimension} numbers, {self.digest[:8] or 'no digest'})"


@dataclass(frozen=True)
class MapFacts:
    """The identity of a map."""

    source: str  # "kind:path", or what its frames were pushed by, as "http"
    frames: int
    unfinished: bool  # a checkpoint
    content_hash: str  # of the voxels
    encoder: Encoder | None
    revision: str  # changes with anything but the timings: corrections and embeddings too

    @property
    def recording(self) -> str:
        """The path its frames came from; empty where they were pushed."""
        return self.source.partition(":")[2]


def map_facts(path: str | os.PathLike[str], *, checkpoint: bool = False) -> MapFacts:
    """Reads them. Raises Error for what is no map.

    checkpoint: the file is one that a killed run left, with a log beside it that only who may write can read. Its run
    must be over.
    """
    try:
        with open(path, "rb"):
            pass  # the system says better than SQLite why not
        with contextlib.closing(sqlite3.connect(_uri(path, "rw" if checkpoint else "ro"), uri=True)) as file:
            meta = dict(file.execute("SELECT key, value FROM meta").fetchall())
            checks = file.execute("SELECT name, rows, hash FROM checks WHERE name <> 'meta' ORDER BY name").fetchall()
    except OSError as fault:
        raise Error(f"cannot open map '{os.fspath(path)}': {fault.strerror}; give a map file that `ovimap run` wrote") from None
    except sqlite3.Error as fault:
        raise Error(f"{os.fspath(path)} is no map ({fault}); give a file that `ovimap run` wrote") from None
    encoder = Encoder(meta.get("encoder.name", ""), int(meta.get("encoder.dimension") or 0), meta.get("encoder.digest", ""))
    said = (meta.get("content_hash", ""), encoder, checks)
    return MapFacts(
        source=meta.get("source", ""),
        frames=int(meta.get("frames") or 0),
        unfinished=meta.get("unfinished") == "true",
        content_hash=meta.get("content_hash", ""),
        encoder=encoder if encoder.name else None,
        revision=hashlib.sha256(repr(said).encode()).hexdigest()[:16],
    )


def _uri(path: str | os.PathLike[str], mode: str) -> str:
    return f"{pathlib.Path(path).absolute().as_uri()}?mode={mode}"
