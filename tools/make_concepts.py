#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes src/ovimap/semantics/data/concepts.txt: which words name a kind of which thing, from WordNet 3.0.

Usage: tools/make_concepts.py WORDNET      (a folder with data.noun, of Debian's package wordnet-base)

The table holds the household words of tools/data/household_words.txt, what is above them, and what is below them as far as
WordNet's own texts use it or ImageNet has a class for it. A line a kind: words;parents, as line numbers from 0. Parents come
before their children. A household word stands first, with an asterisk.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
WORDS = ROOT / "tools/data/household_words.txt"
IMAGENET = ROOT / "tools/models/imagenet_classes.txt"
OUT = ROOT / "src/ovimap/semantics/data/concepts.txt"
ARTIFACT = 6  # WordNet's lexicographer file of artefacts
WIDEST = 400  # kinds below a word; what is below wider ones ("food") is left out
HEAD = """# SPDX-FileCopyrightText: 2006 Princeton University
# SPDX-License-Identifier: LicenseRef-WordNet-3.0
# Kinds of things: words;parents. Written by tools/make_concepts.py; do not edit. Contains parts of
# WordNet 3.0, Copyright 2006 by Princeton University. All rights reserved. See docs/NOTICE-wordnet.md.
"""


class Kind:
    def __init__(self, words, parents, file=ARTIFACT):
        self.words, self.parents, self.file = words, parents, file


def read_wordnet(folder):
    """Kinds by offset, and the offsets of a word, the commonest sense first."""
    kinds, senses = {}, {}
    for line in (folder / "data.noun").read_text().splitlines():
        if line.startswith("  "):
            continue
        field = line.split("|")[0].split()
        count = int(field[3], 16)
        words = [field[4 + 2 * i].replace("_", " ") for i in range(count)]
        rest = field[5 + 2 * count :]
        parents = [rest[i + 1] for i in range(0, len(rest) - 3, 4) if rest[i] == "@"]
        kinds[field[0]] = Kind(words, parents, int(field[1]))
    for line in (folder / "index.noun").read_text().splitlines():
        if not line.startswith("  "):
            field = line.split()
            senses[field[0].replace("_", " ")] = field[-int(field[2]) :]
    return kinds, senses


def used_words(folder):
    """Words that WordNet's tagged texts use as a noun."""
    lines = (field.split("%") for field in (line.split()[0] for line in (folder / "cntlist.rev").read_text().splitlines()))
    return {word.replace("_", " ") for word, rest in lines if rest.startswith("1")}


def above(kinds, start):
    found, todo = set(), list(start)
    while todo:
        kind = todo.pop()
        if kind not in found:
            found.add(kind)
            todo += kinds[kind].parents
    return found


def below(children, start):
    found, todo = set(), [start]
    while todo:
        kind = todo.pop()
        if kind not in found:
            found.add(kind)
            todo += children.get(kind, [])
    return found


def chosen_sense(kinds, senses, word, under):
    found = senses.get(word, [])
    if under:
        found = [s for s in found if any(under in kinds[a].words for a in above(kinds, [s]) - {s})]
    else:
        found = [s for s in found if kinds[s].file == ARTIFACT] or found
    if not found:
        sys.exit(f"make_concepts: WordNet has no '{word}'" + (f" under '{under}'" if under else ""))
    return found[0]


def household(kinds, senses):
    """(word, kind) of each; adds to `kinds` what WordNet lacks."""
    chosen = []
    for line in WORDS.read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        definition, *synonyms = [part.strip() for part in line.split(";")]
        word, same, under, parent = (part and part.strip() for part in re.fullmatch(
            r"([^=<+]+)(?:=([^<+]+))?(?:<([^+]+))?(?:\+(.+))?", definition).groups())
        if parent:
            kind = f"new {word}"
            kinds[kind] = Kind([word], [dict(chosen).get(parent) or chosen_sense(kinds, senses, parent, None)])
        else:
            kind = chosen_sense(kinds, senses, same or word, under)
        kinds[kind].words = kinds[kind].words + synonyms
        chosen.append((word, kind))
    return chosen


def kept_kinds(kinds, senses, chosen, folder):
    children = {}
    for kind, entry in kinds.items():
        for parent in entry.parents:
            children.setdefault(parent, []).append(kind)
    narrow = [b for b in (below(children, kind) for _, kind in chosen) if len(b) < WIDEST]
    used = used_words(folder)
    classes = {frozenset(w.strip().lower() for w in line.split(",")) for line in IMAGENET.read_text().splitlines()}
    known = {k for k in set().union(*narrow) if any(w in used for w in kinds[k].words)
             or frozenset(w.lower() for w in kinds[k].words) in classes}
    return above(kinds, known | {kind for _, kind in chosen})


def in_order(kinds, kept):
    """Parents first; otherwise by their words, so that the same WordNet gives the same file."""
    order, placed = [], set()

    def place(kind):
        if kind in placed:
            return
        placed.add(kind)
        for parent in sorted(kinds[kind].parents):
            place(parent)
        order.append(kind)

    for kind in sorted(kept):
        place(kind)
    return order


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    kinds, senses = read_wordnet(folder)
    chosen = household(kinds, senses)
    order = in_order(kinds, kept_kinds(kinds, senses, chosen, folder))
    place = {kind: i for i, kind in enumerate(order)}
    first = {kind: word for word, kind in chosen}
    lines = []
    for kind in order:
        words = [w for w in kinds[kind].words if w == w.lower() or kind in first]
        if kind in first:
            words = ["*" + first[kind]] + [w for w in words if w != first[kind]]
        lines.append("|".join(words).lower() + ";" + " ".join(str(place[p]) for p in kinds[kind].parents))
    OUT.write_text(HEAD + "\n".join(lines) + "\n")
    print(f"{len(order)} kinds, {len(first)} household words, {OUT.stat().st_size} bytes")


if __name__ == "__main__":
    main()
