# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Standing queries of a robot: what becomes of them, beside all else that the map's node does."""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator, Sequence

from .._ovimap import Error
from ..agents.backend import MapFault, checked_text
from ..sender import _address
from ..watching import WatchEvent, watch
from .reporter import Reporter
from .source import is_address


class Standing:
    """Queries that a thread of their own asks of a map file or a server, until the program ends. Raises Error for one that no map
    can be asked."""

    def __init__(self, map: str, queries: Sequence[str], hold_s: float, cafile: str | None, reporter: Reporter) -> None:
        try:
            self._queries = [checked_text(query) for query in queries]
        except MapFault as fault:
            raise Error(str(fault)) from None
        self._map = _address(map).geturl() if is_address(map) else map
        self._hold_s, self._cafile, self._report = hold_s, cafile, reporter
        self._events: queue.SimpleQueue[WatchEvent] = queue.SimpleQueue()
        if self._queries:
            threading.Thread(target=self._watch, daemon=True, name="standing queries").start()

    def events(self) -> Iterator[WatchEvent]:
        """What came since it was last asked for."""
        while True:
            try:
                yield self._events.get_nowait()
            except queue.Empty:
                return

    def _watch(self) -> None:
        try:
            watch(self._map, self._queries, self._events.put, cafile=self._cafile, hold_s=self._hold_s)
        except Error as fault:
            self._report.say(f"standing queries are not asked: {fault}")
