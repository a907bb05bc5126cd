# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""One search over the objects of many maps: which room has a fire extinguisher?"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._ovimap import Error, ImageTextEncoder, Map, QueryAnswer, QueryMatch, make_encoder, settings
from ..map_facts import map_facts
from .store import Entry, Store, Update
from .vectors import Vectors

FIRST_HITS = 64  # objects looked at first; more when they come from too few maps
MOST_HITS = 4096
OPEN_MAPS = 8  # kept for the next question; each has an encoder for texts open


@dataclass(frozen=True)
class Hit:
    """An object near a text, before its map was asked."""

    map: str
    object: int
    cosine: float


@dataclass(frozen=True)
class MapAnswer:
    """What one map says to the question."""

    map: str
    hits: list[Hit]  # its objects among the nearest of all maps, best first
    answer: QueryAnswer | None  # the map's own; None where it could not be asked
    notice: str = ""  # why not, or what to know about it

    @property
    def found(self) -> bool:
        """The map's own verdict: there at a rate of 5 % false alarms in this map."""
        return self.answer is not None and self.answer.found

    @property
    def best(self) -> QueryMatch | None:
        return self.answer.matches[0] if self.answer is not None and self.answer.matches else None


@dataclass(frozen=True)
class Answer:
    """What all maps say: the maps where it most likely is come first."""

    query: str
    maps: list[MapAnswer]
    p_value: float | None  # chance that a thing that is in none of the maps scores as high in one of them
    found: bool  # that chance is at most 5 %

    @property
    def verdict(self) -> str:
        """As of `ovimap query`; unknown where it was not found but maps could not be asked, which may have it."""
        if self.found:
            return "found"
        return "unknown" if any(said.answer is None for said in self.maps) else "not_in_map"


def _absolute(maps: Iterable[str | os.PathLike[str]] | str | os.PathLike[str]) -> list[str]:
    """Of several maps, or of one: a string is no list of letters."""
    return [os.path.abspath(path) for path in ([maps] if isinstance(maps, (str, os.PathLike)) else maps)]


class ObjectIndex:
    """The objects of many maps in one folder. Opened for questions it never changes the folder.

    encoder: "auto" (the default one, if it made the embeddings), the name of a model, or an encoder. It is opened at
    the first question in words. Raises Error where the folder holds no index.
    """

    def __init__(self, folder: str | os.PathLike[str], *, encoder: Any = "auto", model_dirs: Sequence[str | os.PathLike[str]] = ()) -> None:
        self._store = Store(folder)
        self._store.require()
        self._choice, self._model_dirs = encoder, model_dirs
        self._encoder: Any = None
        self._opened: dict[str, tuple[str, Map]] = {}

    @staticmethod
    def build(folder: str | os.PathLike[str], maps: Iterable[str | os.PathLike[str]]) -> Update:
        """Adds maps, or takes them anew where they have changed; makes the folder where there is none.

        A map that cannot be in the index is left out and named in the result. Killed at any moment it leaves the
        index as it was.
        """
        return Store(folder).put(_absolute(maps))

    @staticmethod
    def remove(folder: str | os.PathLike[str], maps: Iterable[str | os.PathLike[str]]) -> None:
        """Takes maps out. Raises Error for one that is not in."""
        Store(folder).remove(_absolute(maps))

    @property
    def maps(self) -> list[Entry]:
        return list(self._store.entries.values())

    def __len__(self) -> int:
        """Objects in it, with those whose look is unknown."""
        return sum(entry.objects for entry in self.maps)

    def nearest(self, embedding: Vectors, count: int = 10) -> list[Hit]:
        """The objects whose embeddings are nearest to one of length 1, floats [dimension], best first."""
        if np.shape(embedding) != (self._store.encoder.dimension,) or np.asarray(embedding).dtype.kind != "f":
            raise Error(f"embedding must be {self._store.encoder.dimension} floats, as '{self._store.encoder.name}' makes them; "
                        "for words there is nearest_to_text")
        return [Hit(*found) for found in self._store.search(embedding, count)]

    def nearest_to_text(self, text: str, count: int = 10) -> list[Hit]:
        """The same for a text. Commas separate alternatives, as in a query."""
        terms = [term.strip() for term in text.split(",") if term.strip()]
        if not terms:
            raise Error("the query is empty; say what to look for")
        found: dict[tuple[str, int], Hit] = {}
        for embedding in self._text_encoder().encode_texts(terms):
            for hit in self.nearest(embedding, count):
                known = found.get((hit.map, hit.object))
                if known is None or known.cosine < hit.cosine:
                    found[hit.map, hit.object] = hit
        return sorted(found.values(), key=lambda hit: -hit.cosine)[:count]

    def query(self, text: str, *, top: int = 5, negatives: Sequence[str] = ()) -> Answer:
        """Which maps have it? The nearest objects name `top` maps, and each of these is asked: Map.query."""
        hits = self._hits_of_maps(text, top)
        asked = [self._ask(path, own, text, negatives) for path, own in list(hits.items())[:top]]
        asked.sort(key=_rank)
        p_value = _p_among(asked, len(self._store.entries))
        found = any(map.found for map in asked) if p_value is None else p_value <= _false_positive_rate()
        return Answer(text, asked, p_value, found)

    def _hits_of_maps(self, text: str, maps: int) -> dict[str, list[Hit]]:
        """The nearest objects by map, so many that they come from this many maps where there are that many."""
        count = FIRST_HITS
        while True:
            hits: dict[str, list[Hit]] = {}
            for hit in self.nearest_to_text(text, count):
                hits.setdefault(hit.map, []).append(hit)
            if len(hits) >= maps or count >= min(MOST_HITS, len(self)):
                return hits
            count *= 4

    def _ask(self, path: str, hits: list[Hit], text: str, negatives: Sequence[str]) -> MapAnswer:
        if not os.path.exists(path):
            return MapAnswer(path, hits, None, f"the map is not there any more; bring it back, or index it where it is now (`ovimap-index build "
                             f"MAP -o {self._store.folder}`) and take this one out (`ovimap-index remove {self._store.folder} {path}`)")
        try:
            revision = map_facts(path).revision
            answer = self._open(path, revision).query(text, negatives=negatives)
        except Error as fault:
            return MapAnswer(path, hits, None, str(fault))
        entry = self._store.entries.get(path)  # none: it was taken out while we ask
        same = entry is not None and revision == entry.revision
        return MapAnswer(path, hits, answer, "" if same else "it has changed since it was indexed; `ovimap-index build` takes it anew")

    def _open(self, path: str, revision: str) -> Map:
        known, opened = self._opened.pop(path, ("", None))
        if opened is None or known != revision:
            opened = Map.open(path, encoder=self._text_encoder())
        self._opened[path] = (revision, opened)  # at the end: the first is the one not used for longest
        if len(self._opened) > OPEN_MAPS:
            del self._opened[next(iter(self._opened))]
        return opened

    def _text_encoder(self) -> Any:
        if self._encoder is None:
            self._encoder = self._open_encoder()
        return self._encoder

    def _open_encoder(self) -> Any:
        wanted = self._store.encoder
        choice: Any = "default" if self._choice == "auto" else self._choice
        given: Any = make_encoder(choice, model_dirs=self._model_dirs) if isinstance(choice, str) else choice
        digest = given.digest if isinstance(given, ImageTextEncoder) else wanted.digest
        if given is None or (given.name, given.dimension, digest) != (wanted.name, wanted.dimension, wanted.digest):
            raise Error(f"the index has embeddings of {wanted}, which {choice if isinstance(choice, str) else given.name} did not make; "
                        "name that model as the encoder")
        return given


def _rank(asked: MapAnswer) -> tuple[bool, float, float, float]:
    best = asked.best
    if best is None:
        return (True, 1.0, 0.0, -asked.hits[0].cosine)
    return (not asked.found, 1.0 if best.p_value is None else best.p_value, -best.standard_score, -best.score)


def _p_among(asked: Sequence[MapAnswer], maps: int) -> float | None:
    # Each map is a try of its own, so the best of many maps scores high by chance more often (Sidak 1967).
    values = [map.best.p_value for map in asked if map.best is not None and map.best.p_value is not None]
    with np.errstate(divide="ignore"):  # of the logarithm of 0, when nothing is there by any chance: p is 1
        return float(-np.expm1(maps * np.log1p(-min(values)))) if values else None


def _false_positive_rate() -> float:
    return float(next(setting.value for setting in settings("query") if setting.name == "verdict.false_positive_rate"))
