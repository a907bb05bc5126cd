# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Files that several processes may want, any of which may be killed at any moment."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import pathlib
from collections.abc import Iterator
from typing import Any


@contextlib.contextmanager
def exclusive(path: pathlib.Path) -> Iterator[int]:
    """Waits until nobody else holds this lock; gives its descriptor.

    A program that inherits the descriptor holds the lock too: who tries again waits for one that outlived its worker.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    lock = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX)
        os.ftruncate(lock, 0)
        os.write(lock, f"{os.getpid()} {os.uname().nodename}\n".encode())  # for people who wonder who holds it
        yield lock
    finally:
        os.close(lock)


def parse_json(text: str | bytes) -> dict[str, Any]:
    """The JSON object that somebody else wrote. Raises ValueError, one line, for anything else, also where it is nested
    deeper than the parser goes."""
    try:
        value = json.loads(text)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    if not isinstance(value, dict):
        raise ValueError("it is no JSON object")
    return value


def read_json(path: pathlib.Path) -> dict[str, Any]:
    """Likewise of a file. Raises OSError where it cannot be read."""
    return parse_json(path.read_bytes())


def write_json(path: pathlib.Path, value: Any) -> None:
    """Writes a file as a whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(f"{path.name}.{os.getpid()}.new")
    with open(new, "w", encoding="utf-8") as file:
        json.dump(value, file, indent=1)
        file.flush()
        os.fsync(file.fileno())
    os.replace(new, path)
