# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Notes beside maps that say which order made them, so that finished work is known again."""

from __future__ import annotations

import pathlib
from typing import Any

from .._ovimap import Error
from ..files import read_json, write_json
from ..map_facts import map_facts

FOLDER = "jobs"  # beside the maps: notes and locks


def record_of(map: pathlib.Path) -> pathlib.Path:
    return map.parent / FOLDER / f"{map.stem}.json"


def lock_of(map: pathlib.Path) -> pathlib.Path:
    return map.parent / FOLDER / f"{map.stem}.lock"


def checkpoint_of(map: pathlib.Path) -> pathlib.Path:
    return map.with_name(map.name + ".partial")


def finished(map: pathlib.Path, order: dict[str, Any]) -> dict[str, Any] | None:
    """The report of the run that made this map by this order; None when there is work to do.

    Raises Error when the map is there but was made by another order: it is somebody's work.
    """
    record = _read(record_of(map))
    if record is None or not map.is_file() or map_facts(map).content_hash != record["content_hash"]:
        return None
    different = _different(record, order)
    if different:
        raise Error(f"{map} was made with {different}; delete it to make it anew, or give another output")
    report: dict[str, Any] = record["report"]
    return report


def claim(map: pathlib.Path, order: dict[str, Any]) -> None:
    """Notes an order before its map is written. Raises Error when a map, or one that was begun, is there by no such order."""
    record, begun = _read(record_of(map)), checkpoint_of(map)
    if begun.exists() and (record is None or _different(record, order)):
        other = _different(record, order) if record else "frames that nothing tells"
        raise Error(f"{begun} was begun with {other}; give the same again to go on with it, or delete {begun} to begin anew")
    if map.exists() and (record is None or record["order"] != order):
        raise Error(f"{map} is there and was not made by this command; delete it, or give another output")
    write_json(record_of(map), {"order": order, "content_hash": "", "report": {}})


def write_record(map: pathlib.Path, order: dict[str, Any], report: dict[str, Any]) -> None:
    """To be called when the map is there."""
    write_json(record_of(map), {"order": order, "content_hash": map_facts(map).content_hash, "report": report})


def _different(record: dict[str, Any], order: dict[str, Any]) -> str:
    """The first thing in which an order differs from the one noted; empty: in nothing."""
    noted = record["order"]
    return next((f"other {key} ({_words(noted.get(key))})" for key in order if order[key] != noted.get(key)), "")


def _words(value: Any) -> str:
    return (" ".join(map(str, value)) if isinstance(value, list) else str(value)) or "none"


def _read(path: pathlib.Path) -> dict[str, Any] | None:
    try:
        record = read_json(path)
    except (OSError, ValueError):
        return None  # there is no note, or it means nothing: the work is done again, or gone on with
    return record if {"order", "content_hash", "report"} <= record.keys() else None
