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
from .agents.backend import MapBackend, MapFault, Verdict, checked_text, open_map
from .agents.facts import MapObject

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
        if "://" not in os.fspath(map):  # a server may come later, a path that is no map becomes none
            backend.summary()
        Watch(backend, queries, callback, hold_s=hold_s).run()
    except MapFault as fault:
        raise Error(str(fault)) from None


@dataclass
class _Standing:
    """A query, what was told of it, and what the map says by now."""

    told: bool = False
    verdict: Verdict = Verdict(False, None)
    since_s: float = 0.0
    last: Verdict = Verdict(False, None)  # the latest that was found
    fault: str = ""


class Watch:
    """Standing queries on one map. The map is asked only when its objects changed.

    A query is found or not: a second mug tells nothing new, and an object that merges into another, or is given another id, is
    the same thing as long as the query finds it."""

    def __init__(self, backend: MapBackend, queries: Sequence[str], callback: Callable[[WatchEvent], Any], *, hold_s: float = HOLD_S) -> None:
        if not queries:
            raise MapFault("there is nothing to watch for; give words, as \"fire extinguisher\"")
        self._standing = {checked_text(query): _Standing() for query in queries}
        self._backend, self._callback, self._hold_s = backend, callback, hold_s
        self._state = ""
        self._live = self._due = False
        self._rest_until_s = 0.0
        self._fault = ""
        self._ended = False

    def run(self) -> None:
        """Goes on until callback returns False."""
        changed = True
        try:
            while not self._ended:
                self.step(time.monotonic(), changed)
                changed = not self._ended and self._pause()
        finally:
            self._backend.close()

    def step(self, now_s: float, changed: bool = True) -> None:
        """Looks at the map where it may have changed, and tells what has stood long enough."""
        self._due = self._due or changed
        try:
            if self._due and now_s >= self._rest_until_s:
                state, self._live = self._backend.state()
                if state != self._state:
                    self._look(state, now_s)
                self._due = False
        except MapFault as fault:
            self._state = ""  # what answers next may be another map, whose states have the same names
            self._note(str(fault))
            return
        self._note("")
        self._tell_all(now_s)

    def _pause(self) -> bool:
        """Whether the map may have changed meanwhile."""
        if self._fault:
            time.sleep(RETRY_S)
            return True
        return self._backend.wait(TICK_S)

    def _look(self, state: str, now_s: float) -> None:
        began_s = time.monotonic()
        verdicts = self._backend.verdicts(list(self._standing))
        spent_s = time.monotonic() - began_s
        seen_s = now_s + spent_s
        self._state, self._rest_until_s = state, seen_s + min(spent_s / WORK_SHARE, MOST_REST_S)
        for (query, standing), verdict in zip(self._standing.items(), verdicts, strict=True):
            if verdict.fault:
                if verdict.fault != standing.fault:
                    self._send("fault", query, standing, verdict.fault)
                standing.fault = verdict.fault
                continue  # what was told stays
            standing.fault = ""
            if verdict.found != standing.verdict.found:
                standing.since_s = seen_s
            standing.verdict = verdict
            if verdict.found:
                standing.last = verdict

    def _tell_all(self, now_s: float) -> None:
        if self._live and self._due:  # there are states that were not looked at yet
            return
        for query, standing in self._standing.items():
            stands = not self._live or now_s - standing.since_s >= self._hold_s
            if stands and standing.verdict.found != standing.told:
                standing.told = standing.verdict.found
                self._send("found" if standing.told else "gone", query, standing)

    def _note(self, fault: str) -> None:
        """Tells once of a map that does not answer, and once when it does not for another reason."""
        if fault and fault != self._fault:
            self._send("fault", "", _Standing(), fault)
        self._fault = fault

    def _send(self, event: str, query: str, standing: _Standing, fault: str = "") -> None:
        last = Verdict(False, None) if event == "fault" else standing.last
        said = WatchEvent(event, self._backend.name, query, time.time(), last.object, last.probability if event == "found" else None, fault)
        if not self._ended and self._callback(said) is False:
            self._ended = True
