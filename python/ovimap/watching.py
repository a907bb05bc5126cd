# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Standing queries: told once when a thing is found in a map, and once when it is gone (docs/agents.md)."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from ._ovimap import Error
from .agents.backend import MapBackend, MapFault, NoAnswer, RequestRefused, Verdict, checked_text, open_map
from .agents.facts import MapObject
from .agents.file_backend import FileBackend
from .agents.http_backend import NOT_UNDERSTOOD, HttpBackend

HOLD_S = 3.0  # a map that is being made has a new state every second or so: three agree
WORK_SHARE = 0.05  # of the time is spent on asking at most, however many the queries,
MOST_REST_S = 10.0  # unless that would make it slower than this
TICK_S = 0.5
RETRY_S = 2.0


@dataclass(frozen=True)
class WatchEvent:
    """What became of a standing query."""

    event: str
    """"found", "gone", or "fault": the map or its server does not answer, or the query cannot be asked"""
    map: str
    query: str
    """empty: of all"""
    time_s: float
    """seconds since 1970 UTC"""
    object: MapObject | None = None
    """what was found, or last found"""
    probability: float | None = None
    fault: str = ""

    def as_dict(self) -> dict[str, Any]:
        """The event as a JSON object, without what it does not have."""
        return {key: value for key, value in asdict(self).items() if value is not None and (value != "" or key == "query")}


def watch(
    map: str | os.PathLike[str],
    queries: Sequence[str],
    callback: Callable[[WatchEvent], Any],
    *,
    token: str = "",
    cafile: str | None = None,
    hold_s: float = HOLD_S,
) -> None:
    """Watches a map file, or the address of a server that makes a map, until callback returns False or raises.

    queries: in the grammar of docs/query.md. callback(event) is called once when a query is found, once when it is not any
    more, and when the map does not answer, from this thread; what changes meanwhile is seen afterwards. hold_s: how long
    a verdict on a map that is being made must stand before it is told; those on a finished map are told at once. token, cafile:
    as the server wants them. Raises Error for queries that cannot be asked, and a path that is no map."""
    try:
        backend = open_map(map, token=token, cafile=cafile)
        if isinstance(backend, FileBackend):  # a server may come later, a path that is no map becomes none
            backend.summary()
        watch_map(backend, queries, callback, hold_s=hold_s)
    except MapFault as fault:
        raise Error(str(fault)) from None


def watch_map(backend: MapBackend, queries: Sequence[str], callback: Callable[[WatchEvent], Any], *, hold_s: float = HOLD_S) -> None:
    """Likewise of an opened map, which is closed at the end. Raises MapFault."""
    try:
        if isinstance(backend, HttpBackend):
            ServerWatch(backend, queries, callback, hold_s=hold_s).run()
        elif isinstance(backend, FileBackend):
            FileWatch(backend, queries, callback).run()
    finally:
        backend.close()


class _Teller:
    """What was told, of a map that may stop to answer."""

    def __init__(self, name: str, queries: Sequence[str], callback: Callable[[WatchEvent], Any]) -> None:
        if not queries:
            raise MapFault("there is nothing to watch for; give words, as \"fire extinguisher\"")
        self._queries = list(dict.fromkeys(checked_text(query) for query in queries))
        self._name, self._callback = name, callback
        self._last: dict[str, MapObject | None] = {}  # the latest that was found
        self._fault = ""  # what stands between us and the map; empty: nothing
        self._ended = False

    def _note(self, fault: str, reason: str = "") -> None:
        """Tells once of a map that does not answer, and once when it does not for another reason. reason: where the same one has
        several sentences."""
        reason = reason or fault
        if fault and reason != self._fault:
            self._send("fault", "", fault=fault)
        self._fault = reason

    def _send(self, event: str, query: str, *, probability: float | None = None, fault: str = "") -> None:
        found = self._last.get(query) if event != "fault" else None
        said = WatchEvent(event, self._name, query, time.time(), found, probability, fault)
        if not self._ended and self._callback(said) is False:
            self._ended = True


class FileWatch(_Teller):
    """Standing queries on a map file. It is asked only when its objects changed.

    A query is found or not: a second mug tells nothing new, and an object that merges into another, or is given another id, is
    the same thing as long as the query finds it."""

    def __init__(self, backend: FileBackend, queries: Sequence[str], callback: Callable[[WatchEvent], Any]) -> None:
        super().__init__(backend.name, queries, callback)
        self._backend = backend
        self._told: set[str] = set()
        self._faults: dict[str, str] = {}
        self._state = ""
        self._rest_until_s = 0.0

    def run(self) -> None:
        """Goes on until callback returns False."""
        while not self._ended:
            self.step(time.monotonic())
            if not self._ended:
                time.sleep(RETRY_S if self._fault else TICK_S)

    def step(self, now_s: float) -> None:
        """Looks at the map where it changed, and tells what it finds."""
        if now_s < self._rest_until_s:
            return
        try:
            state = self._backend.state()
            if state != self._state:
                self._look(state, now_s)
        except MapFault as fault:
            self._note(str(fault))
        else:
            self._note("")

    def _look(self, state: str, now_s: float) -> None:
        began_s = time.monotonic()
        verdicts = self._backend.verdicts(self._queries)
        spent_s = time.monotonic() - began_s
        self._state, self._rest_until_s = state, now_s + spent_s + min(spent_s / WORK_SHARE, MOST_REST_S)
        for query, verdict in zip(self._queries, verdicts, strict=True):
            self._tell(query, verdict)

    def _tell(self, query: str, verdict: Verdict) -> None:
        if verdict.fault:
            if verdict.fault != self._faults.get(query):
                self._send("fault", query, fault=verdict.fault)
            self._faults[query] = verdict.fault
            return  # what was told stays
        self._faults.pop(query, None)
        if verdict.found:
            self._last[query] = verdict.object
        if verdict.found and query not in self._told:
            self._told.add(query)
            self._send("found", query, probability=verdict.probability)
        elif not verdict.found and query in self._told:
            self._told.remove(query)
            self._send("gone", query)


class ServerWatch(_Teller):
    """Standing queries that a server asks its map, finished or being made (docs/http-api.md, "Standing queries"). A server that
    goes away is asked again, and goes on where it was."""

    def __init__(self, backend: HttpBackend, queries: Sequence[str], callback: Callable[[WatchEvent], Any], *, hold_s: float = HOLD_S) -> None:
        super().__init__(backend.name, queries, callback)
        self._backend, self._hold_s = backend, hold_s
        self._mark = ""

    def run(self) -> None:
        """Goes on until callback returns False. Raises MapFault for queries that the server does not take."""
        while not self._ended:
            try:
                for event in self._backend.watch(self._queries, self._hold_s, self._mark):
                    self._take(event.kind, event.said)
                    self._mark = event.mark
                    if self._ended:
                        return
            except RequestRefused:
                raise
            except NoAnswer as fault:  # its socket says it in another way each time
                self._note(str(fault), reason="no answer")
            except MapFault as fault:
                self._note(str(fault))
            if not self._ended:
                time.sleep(RETRY_S)

    def _take(self, kind: str, said: dict[str, Any]) -> None:
        query, fault = str(said.get("query", "")), str(said.get("fault", ""))
        if kind == "hello":
            self._note("")
        elif kind == "fault" and not query:
            self._note(fault)
        elif kind == "fault":
            self._send("fault", query, fault=fault)
        elif kind in ("found", "gone"):
            if "object" in said:
                self._last[query] = _object(said["object"])
            self._send(kind, query, probability=said.get("probability"))


def _object(said: Any) -> MapObject:
    try:
        center, size = (tuple(said[name]) if said[name] else None for name in ("center", "size"))
        return MapObject(said["id"], said["title"], said["named"], center, size)
    except (KeyError, TypeError):
        raise MapFault(NOT_UNDERSTOOD) from None
