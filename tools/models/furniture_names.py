# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What the names of furniture models mean in plain English words."""

import csv
import functools
import pathlib
import re

TABLE = pathlib.Path(__file__).with_name("furniture_names.csv")


def table_rows() -> list:
    """(name, meanings) pairs of the table."""
    lines = TABLE.read_text(encoding="utf-8").splitlines()
    rows = csv.reader(line for line in lines if line and not line.startswith("#"))
    return [(name, [m for m in meaning.split("|") if m]) for name, meaning in rows]


@functools.cache
def _table() -> dict:
    return dict(table_rows())


def meanings(name: str) -> list:
    """The plain word for a model's name, then its synonyms; empty where the name says nothing.
    A name that the table lacks is lower-cased and loses numbers and sizes ("Bed 140x190")."""
    if name in _table():
        return _table()[name]
    words = re.sub(r"\d+(\s*x\s*\d+)*(\s*(cm|mm|m|\u00b0|\u20ac)\b)?", " ", name.lower()).split()
    return [" ".join(words)] if words else []
