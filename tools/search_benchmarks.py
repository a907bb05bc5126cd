#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Measures how well words find objects, and writes docs/search-benchmarks.md.

Usage: tools/search_benchmarks.py PROGRAM [--rooms build/benchmarks/rooms/noisy] [--kitchen FOLDER]
                                 [--out docs/search-benchmarks.md] [--keep-rooms]
       tools/search_benchmarks.py PROGRAM --only-evidence [--rooms ...] [--kitchen-map MAP] [--out ...]
--rooms: where rooms-v1 with noise is, or goes. FOLDER is 7-Scenes "red kitchen" (every 5th frame); without it only the
rendered rooms are measured. --keep-rooms: the page's figures of the rooms stay as they are. The section on evidence is made by
--only-evidence, which leaves the rest of the page as it is; the rooms must be there. MAP: of the kitchen, as `ovimap run
KITCHEN --masks sam --set crops.kept_size_px=640` makes it and `ovimap read` reads it.
"""
import argparse
import datetime
import json
import pathlib
import shutil
import subprocess
import tempfile

import search_evidence

DATA = pathlib.Path(__file__).parent / "data"
EVERYTHING = 1000
STUFF = {"floor", "wall", "ceiling"}
KITCHEN_HEAD = "## A real kitchen"
VIEWS_HEAD = "## Which views to embed"
# The encoder's halves, to compare with, where they were built:
#   build_default_encoder.py WHEELS .models/default-encoder-VARIANT --variant VARIANT
PARTS = [(variant, pathlib.Path(f".models/default-encoder-{variant}")) for variant in ("classifier", "head")]
VIEWS = ["default", "viewcov", "paper", "vis"]
# One scale of crops, plain and without background, is enough to compare with.
FEW_CROPS = ["--set", "crops.scales=1"]
WITHOUT_WRITING = ("all but writing", ["--set", "query.evidence.writing_weight=0"])


def run_json(*command, accepted=(0,)):
    command = [str(word) for word in command] + ["--json"]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode not in accepted:
        raise SystemExit(f"{' '.join(command)} ended with exit code {done.returncode}")
    return json.loads(done.stdout)


def query(program, map_file, texts, *options, top=EVERYTHING):
    """The answers to all texts in one run; exit code 1 means that some were not found."""
    return run_json(program, "query", map_file, *texts, "--top", top, *options, accepted=(0, 1))["results"]


def rows_of(name):
    for line in (DATA / name).read_text().splitlines():
        if line and not line.startswith("#"):
            yield line.split(";")


# --------------------------------------------------------------------------------------------- the kitchen

def object_at(instances, point, reach=0.3):
    """The object whose centroid is nearest to the point, in metres; None when none is that near."""
    def distance(instance):
        return sum((a - b) ** 2 for a, b in zip(instance["centroid"], point)) ** 0.5

    nearest = min(instances, key=distance)
    return nearest["id"] if distance(nearest) < reach else None


def kitchen_ranks(program, map_file, *options):
    """By phrase: the rank of the first right object, None when the map has none, and the verdict."""
    instances = run_json(program, "info", map_file)["instances"]
    phrases = [(row[0], {object_at(instances, [float(x) for x in point.split()]) for point in row[1:]} - {None})
               for row in rows_of("kitchen_phrases.csv")]
    answers = query(program, map_file, [phrase for phrase, _ in phrases], "--set", "query.grammar=false", *options)
    for (phrase, right), answer in zip(phrases, answers):
        ranks = [rank for rank, found in enumerate(answer["instances"], 1) if found["id"] in right]
        yield phrase, min(ranks, default=None), answer["verdict"], answer["instances"][0]["id"] if answer["instances"] else 0


def verdict_rates(program, map_file, *options):
    words = list(rows_of("kitchen_words.csv"))
    answers = query(program, map_file, [word for _, word in words], "--set", "query.grammar=false", *options, top=1)
    wrong = {"present": [], "absent": []}
    for (kind, word), answer in zip(words, answers):
        if (answer["verdict"] == "found") != (kind == "present"):
            wrong[kind].append(word)
    return wrong


def recall(ranks, k):
    return sum(1 for rank in ranks if rank is not None and rank <= k) / len(ranks)


def kitchen_section(program, kitchen, work):
    made = work / "kitchen.ovimap"
    summary = run_json(program, "run", kitchen, "--masks", "sam", "-o", made)
    encoders = []
    for name, folder in PARTS:
        if folder.exists():
            map_file = work / f"kitchen_{name}.ovimap"
            run_json(program, "reembed", made, "--encoder", folder, "-o", map_file)
            encoders.append((f"{name} alone", map_file, ["--encoder", folder]))
    encoders.append(("both, picture alone", made, dict(search_evidence.PIECES)["picture alone"]))
    encoders.append(("both (default)", made, []))
    how = ["    ovimap run KITCHEN --masks sam -o kitchen.ovimap", "",
           f"{summary['instances']} objects, {summary['embedding_queries']} embedding queries "
           f"({summary['embedding_queries'] / summary['instances']:.1f} an object), {summary['seconds']:.0f} s."]
    return (kitchen_phrases(program, encoders, how) + [""] + kitchen_views(program, kitchen, made, work)
            + relation_section(program, made))


def known_kitchen_section(program, map_file):
    """Of a map of the kitchen that was made before, by the default encoder alone."""
    count = len(run_json(program, "info", map_file)["instances"])
    how = ["    ovimap run KITCHEN --masks sam --set crops.kept_size_px=640 -o kitchen.ovimap", "    ovimap read kitchen.ovimap", "",
           f"{count} objects."]
    return kitchen_phrases(program, [("both (default)", map_file, [])], how) + [""] + relation_section(program, map_file)


def kitchen_phrases(program, encoders, how):
    """Ranks and verdicts of the phrases and words for encoders (name, map, options of the query)."""
    columns = {name: list(kitchen_ranks(program, map_file, *options)) for name, map_file, options in encoders}
    text = [KITCHEN_HEAD, "", measured_at(), "", *how, "",
            "Rank of the first right object among all; a dash: the map has no such object of its own.", "",
            "| phrase | " + " | ".join(f"{name}: rank | verdict" for name in columns) + " |",
            "| --- |" + " --- | --- |" * len(columns)]
    for entries in zip(*columns.values()):
        text.append(f"| {entries[0][0]} | " + " | ".join(
            f"{rank if rank else '-'} | {verdict.replace('_', ' ')}" for _, rank, verdict, _ in entries) + " |")
    for name, entries in columns.items():
        ranks = [rank for _, rank, _, _ in entries]
        text += ["", f"{name.capitalize()}: right object first for {recall(ranks, 1):.0%} of the phrases, among the first "
                     f"five for {recall(ranks, 5):.0%}."]
    text += ["", "### Not in the map", "", "50 words for things in the kitchen, 50 for things that are not "
             "(tools/data/kitchen_words.csv).", "", "| encoder | absent, yet found | present, yet not found |", "| --- | --- | --- |"]
    for name, map_file, options in encoders:
        wrong = verdict_rates(program, map_file, *options)
        text.append(f"| {name} | {len(wrong['absent']) / 50:.0%} ({', '.join(wrong['absent']) or 'none'}) "
                    f"| {len(wrong['present']) / 50:.0%} ({', '.join(wrong['present'])}) |")
    return text


def kitchen_views(program, kitchen, made, work):
    """The same objects, other views: the map's mesh goes the way of any finished geometry."""
    mesh, map_file = work / "kitchen.ply", work / "kitchen_views.ovimap"
    run_json(program, "export", made, mesh, "--what", "instances")
    text = ["### Which views to embed", "", "    ovimap export kitchen.ovimap kitchen.ply --what instances",
            "    ovimap embed kitchen.ply KITCHEN --views PRESET -o views.ovimap", "",
            "The phrases above; one scale of crops.", "", "| views | AQ | MRR | first | first five |", "| --- | --- | --- | --- | --- |"]
    for preset in VIEWS:
        summary = run_json(program, "embed", mesh, kitchen, *FEW_CROPS, "--views", preset, "-o", map_file)
        ranks = [rank for _, rank, _, _ in kitchen_ranks(program, map_file)]
        mrr = sum(1 / rank for rank in ranks if rank) / len(ranks)
        text.append(f"| {preset} | {summary['embedding_queries'] / summary['instances']:.1f} | {mrr:.3f} | {recall(ranks, 1):.3f} "
                    f"| {recall(ranks, 5):.3f} |")
    return text + [""]


def relation_section(program, map_file):
    phrases = ["mug on the table", "chair nearest to the television", "largest cabinet", "plastic box on the table"]
    text = ["### Relations", "", "| query | reading | verdict | best object | because |", "| --- | --- | --- | --- | --- |"]
    for answer in query(program, map_file, phrases, top=1):
        best = answer["instances"][0] if answer["instances"] else None
        place = ", ".join(f"{x:.2f}" for x in best["centroid"]) if best else ""
        text.append(f"| {answer['query']} | {answer['reading']} | {answer['verdict'].replace('_', ' ')} "
                    f"| {'at (' + place + ')' if best else '-'} | {best['evidence'] if best else answer['reason']} |")
    return text


# -------------------------------------------------------------------------------------------- rendered rooms

def room_recall(program, room, map_file, *options):
    """Share of truth classes whose query is answered by an object of that class first, and among three."""
    names = json.loads((room / "labels.json").read_text())["instances"]
    classes = sorted(set(names.values()) - STUFF)
    answers = query(program, map_file, classes, "--set", "query.grammar=false", *options)
    ranks = []
    for name, answer in zip(classes, answers):
        right = [rank for rank, found in enumerate(answer["instances"], 1) if names.get(str(found["id"])) == name]
        ranks.append(min(right, default=None))
    return recall(ranks, 1), recall(ranks, 3), sum(1 / rank for rank in ranks if rank) / len(ranks)


def render_rooms(program, folder):
    run_json(program, "synth", folder, "--room", "rooms-v1", "--noise")
    return tuple(sorted(file.parent for file in folder.glob("*/traj.txt")))


def mean_over_rooms(program, rooms, work, options, ways=((),)):
    """AQ of embeddings made with `options`, then for each way to query reciprocal rank, first and among three."""
    scores = []
    for room in rooms:
        map_file = work / "views.ovimap"
        summary = run_json(program, "embed", "gt", room, *FEW_CROPS, *options, "-o", map_file)
        row = [summary["embedding_queries"] / summary["instances"]]
        for way in ways:
            first, three, mrr = room_recall(program, room, map_file, *way)
            row += [mrr, first, three]
        scores.append(row)
    return " | ".join(f"{sum(column) / len(rooms):.{1 if i == 0 else 3}f}" for i, column in enumerate(zip(*scores)))


def encoders_section(program, rooms, work):
    """Each encoder by its pictures alone, and with all evidence."""
    text = ["## The default encoder and its halves", "", measured_at(), "", "rooms-v1 with sensor noise, true instances, views as by default; the furniture models "
            "of these rooms took no part in the training. With evidence: size, place, rival words and named things.", "",
            "| encoder | AQ | MRR | first | first three | with evidence: MRR | first | first three |", "| --- " * 8 + "|"]
    alone = dict(search_evidence.PIECES)["picture alone"]
    encoders = [(f"{name} alone", ["--encoder", folder]) for name, folder in PARTS if folder.exists()]
    for name, options in [*encoders, ("both (default)", [])]:
        text.append(f"| {name} | {mean_over_rooms(program, rooms, work, options, ([*options, *alone], options))} |")
    return text


def evidence_section(program, rooms, work, unseen=()):
    def map_of(room):
        map_file = work / f"{'-'.join(room.parts[-2:])}.ovimap"
        if not map_file.exists():
            run_json(program, "embed", "gt", room, *FEW_CROPS, "-o", map_file)
        return map_file

    def ranks_of(answers, names):
        return [next((rank for rank, found in enumerate(answer["instances"], 1)
                      if names.get(str(found["id"])) == answer["query"]), EVERYTHING) for answer in answers]

    def ask(map_file, texts, *options):
        return query(program, map_file, texts, "--set", "query.grammar=false", *options)

    def section(places, others):
        return search_evidence.evidence_section(ask, places, map_of, ranks_of, others, taught_by_others(program, places, map_of, work))

    text = [search_evidence.HEAD, "", measured_at(), "", *section(rooms, unseen)]
    if unseen:
        text += ["", "Places that nothing was chosen by:", "", *section(unseen, rooms)]
    return text


def taught_by_others(program, rooms, map_of, work):
    """Names the things of every room in a copy of its map; returns what teaches a room: the lines of all other copies."""
    with tempfile.TemporaryDirectory(dir=work) as folder:
        taught = pathlib.Path(folder) / "taught.json"
        for room in rooms:
            named = pathlib.Path(folder) / map_of(room).name
            shutil.copy(map_of(room), named)
            names = search_evidence.room_names(room)
            for instance in run_json(program, "info", named)["instances"]:
                if str(instance["id"]) in names:
                    run_json(program, "edit", named, "--teach", taught, "rename", instance["id"], names[str(instance["id"])])
        lessons = json.loads(taught.read_text())

    def options(room):
        things = [thing for thing in lessons["things"] if pathlib.Path(thing["map"]).name != map_of(room).name]
        others = work / "others.json"
        others.write_text(json.dumps({**lessons, "things": things}))
        return ["--teach", others]

    return options


def kitchen_evidence(program, map_file):
    text = ["", "The kitchen: the 32 phrases below, and twice 50 words. Writing: `ovimap read` before.", "",
            "| evidence | first | among five | present, not found | absent, found |", "| --- | --- | --- | --- | --- |"]
    for piece, options in [*search_evidence.PIECES, WITHOUT_WRITING]:
        ranks = [rank for _, rank, _, _ in kitchen_ranks(program, map_file, *options)]
        wrong = verdict_rates(program, map_file, *options)
        text.append(f"| {piece} | {recall(ranks, 1):.2f} | {recall(ranks, 5):.2f} | {len(wrong['present']) / 50:.0%} "
                    f"| {len(wrong['absent']) / 50:.0%} |")
    return text


def kept_evidence(page):
    """The section on evidence as it stands, which --only-evidence writes."""
    text = page.read_text()
    return text[text.index(search_evidence.HEAD):text.index(VIEWS_HEAD)].strip().splitlines()


def write_evidence(options):
    rooms, unseen = (tuple(sorted(file.parent for file in folder.glob("**/traj.txt"))) if folder else () for folder in (options.rooms, options.unseen))
    with tempfile.TemporaryDirectory() as folder:
        text = evidence_section(options.program, rooms, options.maps or pathlib.Path(folder), unseen)
    if options.kitchen_map:
        text += kitchen_evidence(options.program, options.kitchen_map)
    page = options.out.read_text()
    begin = page.find(search_evidence.HEAD)
    begin = page.index(VIEWS_HEAD) if begin < 0 else begin
    rest = page[page.index(VIEWS_HEAD):]
    if options.kitchen_map:
        rest = rest.split(KITCHEN_HEAD)[0] + "\n".join(known_kitchen_section(options.program, options.kitchen_map)) + "\n"
    options.out.write_text(page[:begin] + "\n".join(text) + "\n\n" + rest)


def views_section(program, rooms, work):
    """Truth geometry, so that nothing but the choice of views differs."""
    text = [VIEWS_HEAD, "", "    ovimap embed gt ROOM --views PRESET -o room.ovimap", "",
            "rooms-v1 with sensor noise, true instances; mean over the five rooms. AQ: embedding queries "
            "an object. Words: the classes in the room; reciprocal rank, right object first, among three. One scale of crops.", "",
            "| views | AQ | MRR | first | first three |", "| --- | --- | --- | --- | --- |"]
    for preset in VIEWS:
        text.append(f"| {preset} | {mean_over_rooms(program, rooms, work, ['--views', preset])} |")
    return text


def measured_at():
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], stdout=subprocess.PIPE, text=True).stdout.strip()
    return f"Measured on {machine()}, commit {commit}, {datetime.date.today()}."


def machine():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown processor"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--rooms", type=pathlib.Path, default=pathlib.Path("build/benchmarks/rooms/noisy"))
    parser.add_argument("--kitchen", type=pathlib.Path)
    parser.add_argument("--keep-rooms", action="store_true")
    parser.add_argument("--only-evidence", action="store_true")
    parser.add_argument("--kitchen-map", type=pathlib.Path)
    parser.add_argument("--unseen", type=pathlib.Path, help="with --only-evidence: further rooms, of a table of their own")
    parser.add_argument("--maps", type=pathlib.Path, help="with --only-evidence: folder whose maps of rooms are used again")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("docs/search-benchmarks.md"))
    options = parser.parse_args()
    if options.only_evidence:
        write_evidence(options)
        return
    head = ["<!-- SPDX-FileCopyrightText: 2026 The ovimap authors -->", "<!-- SPDX-License-Identifier: Apache-2.0 -->",
            "<!-- Written by tools/search_benchmarks.py; do not edit. -->", "# Search benchmarks", ""]
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        if options.keep_rooms:
            text = options.out.read_text().split(KITCHEN_HEAD)[0].splitlines()
        else:
            rooms = render_rooms(options.program, options.rooms)
            text = head + encoders_section(options.program, rooms, work) + [""] + kept_evidence(options.out) + [""]
            text += views_section(options.program, rooms, work) + [""]
        if options.kitchen:
            text += kitchen_section(options.program, options.kitchen, work)
    options.out.write_text("\n".join(text) + "\n")


if __name__ == "__main__":
    main()
