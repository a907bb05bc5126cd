# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What a map file says of itself, read without opening the map."""

from __future__ import annotations

import os
from dataclasses import dataclass

from ._ovimap import map_identity


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


def map_facts(path: str | os.PathLike[str]) -> MapFacts:
    """Reads them. Raises Error for what is no map, or one that is damaged."""
    source, frames, unfinished, content_hash, encoder, revision = map_identity(path)
    known = Encoder(*encoder)
    return MapFacts(source, frames, unfinished, content_hash, known if known.name else None, revision)
