# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What size, place, rival words and named things add to a search: a part of tools/search_benchmarks.py."""
import functools
import json
import pathlib

DATA = pathlib.Path(__file__).resolve().parents[1] / "src/ovimap/semantics/data"
HEAD = "## What each piece of evidence adds"
UNCLEAR = "object"
TAUGHT = "all, taught what the other places' things are called"
RELIABILITY = (0, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1)
WIDE = 3  # household words below a word that is called wide ("seat")
NO_SIZE, NO_RIVALS, NO_THINGS = (["--set", f"query.evidence.{weight}=0"] for weight in ("size_weight", "competition", "thing_weight"))
PLAIN_STRUCTURE = ["--set", "query.evidence.structure_weight=0.5", "--set", "query.evidence.most_structure_ratio=3"]  # as other things
PIECES = [
    ("picture alone", NO_SIZE + NO_RIVALS + NO_THINGS),
    ("with size and place", NO_RIVALS + NO_THINGS),
    ("with rival words", NO_SIZE + NO_THINGS),
    ("with named things", NO_SIZE + NO_RIVALS),
    ("all but named things", NO_THINGS),
    ("all, structure as any thing", PLAIN_STRUCTURE),
    ("all (default)", []),
]


class Concepts:
    """src/ovimap/semantics/words/concepts.h in few words."""

    def __init__(self):
        self.above, self.by_word, self.household = [], {}, {}
        for line in (DATA / "concepts.txt").read_text().splitlines():
            if not line or line.startswith("#"):
                continue
            words, parents = line.split(";")
            kind = len(self.above)
            self.above.append({kind}.union(*(self.above[int(parent)] for parent in parents.split())))
            for word in filter(None, words.split("|")):
                if word.startswith("*"):
                    self.household[word[1:]] = kind
                self.by_word.setdefault(word.lstrip("*"), []).append(kind)

    def kinds_of(self, text):
        words = text.split()
        for begin in range(len(words)):
            tail = " ".join(words[begin:])
            for word in (tail, tail.removesuffix("s"), tail.removesuffix("es")):
                if word in self.by_word:
                    return self.by_word[word]
        return []

    def compatible(self, a, b):
        return a == b or any(x in self.above[y] or y in self.above[x] for x in self.kinds_of(a) for y in self.kinds_of(b))

    def is_wide(self, word):
        kind = self.household[word]
        return sum(kind in self.above[other] for other in self.household.values()) > WIDE


@functools.cache
def concepts():
    return Concepts()


def verdict_counts(answers, present, names):
    """Of words in the room: found and right, found and wrong; of the others: found."""
    right = wrong = absent = 0
    for answer in answers:
        if answer["verdict"] != "found":
            continue
        best = names.get(str(answer["instances"][0]["id"]))
        if answer["query"] not in present:
            absent += 1
        elif best == answer["query"]:
            right += 1
        else:
            wrong += 1
    return right, wrong, absent


def name_counts(titles, names):
    """How many objects are called by a right or wrong narrow word, a right or wrong wide one, or none."""
    counts = dict.fromkeys(("right", "wrong", "wide, right", "wide, wrong", "none"), 0)
    for number, title in titles.items():
        if title == UNCLEAR:
            counts["none"] += 1
            continue
        right = "right" if concepts().compatible(title, names[str(number)]) else "wrong"
        counts[f"wide, {right}" if concepts().is_wide(title) else right] += 1
    return counts


def claims_of(answers, present, names):
    """Of each answer: the probability shown for its best object, whether that is such a thing (a chair is a seat), and a
    weight by which present and absent words count the same."""
    absent = len(answers) - len(present)
    for answer in answers:
        best = answer["instances"][0]
        name = names.get(str(best["id"]))
        yield (best["probability"], name is not None and concepts().compatible(answer["query"], name),
               1 / (len(present) if answer["query"] in present else absent))


def reliability(claims):
    """How often objects that a probability was shown for are what was asked for."""
    text = ["", "Probabilities shown for the best object of an answer, by all evidence, present and absent words in equal parts: so often it is such a thing (a chair is a seat).", "",
            "| probability | answers | mean | right |", "| --- | --- | --- | --- |"]
    for low, high in zip(RELIABILITY, RELIABILITY[1:]):
        among = [claim for claim in claims if low <= claim[0] < high or claim[0] == high == 1]
        weight = sum(weight for _, _, weight in among)
        if among:
            mean, right = (sum(claim[column] * claim[2] for claim in among) / weight for column in (0, 1))
            text.append(f"| {low:.2f} to {high:.2f} | {len(among)} | {mean:.2f} | {right:.2f} |")
    return text


def room_names(room):
    return json.loads((room / "labels.json").read_text())["instances"]


def evidence_section(query, rooms, map_of, ranks_of, words_of=(), taught=None):
    """`query(map, texts, *options)` answers texts, `map_of(room)` is a room's map, `ranks_of(answers, names)` ranks of the
    first right objects. `words_of`: other rooms whose words are asked as well. `taught(room)`: options with which other
    rooms' named things teach this one."""
    everywhere = sorted({name for room in [*rooms, *words_of] for name in room_names(room).values()})
    text = [f"{', '.join(sorted('-'.join(room.parts[-2:]) for room in rooms))}: true instances; mean over the rooms. Words: the classes "
            "in the room, floor, walls and ceiling too. Found: of these words, those answered \"found\" with a right object first; of all answered \"found\" among them and "
            "as many absent ones (classes of the other rooms, scaled), those that are right; absent ones answered \"found\".", "",
            "| evidence | MRR | first | found and right | right of found | absent, found |", "| --- | --- | --- | --- | --- | --- |"]
    totals, claims = {}, []
    pieces = [(piece, lambda _, chosen=options: chosen) for piece, options in PIECES]
    for piece, options_of in [*pieces, *([(TAUGHT, taught)] if taught else [])]:
        rows = []
        for room in rooms:
            options = options_of(room)
            names = room_names(room)
            present = sorted(set(names.values()))
            absent = [word for word in everywhere if not any(concepts().compatible(word, name) for name in present)]
            answers = query(map_of(room), present + absent, *options)
            ranks = ranks_of(answers[: len(present)], names)
            right, wrong, false = verdict_counts(answers, set(present), names)
            false *= len(present) / len(absent)
            rows.append((sum(1 / rank for rank in ranks) / len(ranks), sum(rank == 1 for rank in ranks) / len(ranks),
                         right / len(present), right / max(1e-9, right + wrong + false), false / len(present)))
            if not options:
                claims += claims_of(answers, set(present), names)
                titles = {hit["id"]: hit["title"] for hit in answers[0]["instances"]}
                for key, count in name_counts(titles, names).items():
                    totals[key] = totals.get(key, 0) + count
        mean = [sum(column) / len(rows) for column in zip(*rows)]
        text.append(f"| {piece} | {mean[0]:.3f} | {mean[1]:.3f} | {mean[2]:.0%} | {mean[3]:.0%} | {mean[4]:.0%} |")
    objects = sum(totals.values())
    text += ["", "What the viewer calls the objects of these rooms, by all evidence: " + ", ".join(
        f"{key} {count / objects:.0%}" for key, count in totals.items()) + f" of {objects}."]
    return text + reliability(claims)
