# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Says what goes wrong once, with the remedy, and counts it afterwards."""

from __future__ import annotations

import sys
import threading
from collections import Counter


class Reporter:
    """Of one command; its threads share it."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self._said: set[str] = set()
        self._lock = threading.Lock()

    def say(self, line: str) -> None:
        with self._lock:
            print(f"ovimap-ros: {line}", file=sys.stderr, flush=True)

    def once(self, what: str, line: str) -> None:
        """Says it the first time for `what`."""
        with self._lock:
            new = what not in self._said
            self._said.add(what)
        if new:
            self.say(line)

    def count(self, what: str, line: str, *, where: str = "") -> None:
        """Says it the first time for `what` of `where`; `what` is what the summary counts."""
        self.counts[what] += 1
        self.once(f"{what} {where}", line)

    def again(self, what: str) -> None:
        """The next `once` of it is said again: it went well meanwhile."""
        with self._lock:
            self._said.discard(what)

    def summary(self) -> str:
        """"3 without a transform, 1 refused"; empty where all went well."""
        return ", ".join(f"{count} {what}" for what, count in sorted(self.counts.items()))
