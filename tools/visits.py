# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Rooms that change between visits, for tools/benchmarks.py: what the map keeps of what left, and what it tells."""
import functools
import statistics
import sys

from speed import map_recording, run, run_json

# The last one is a flat with doors that turn, filmed by a walk.
ROOMS = {"tiny": ["--noise"], "kitchen": ["--noise"], "office": ["--noise"],
         "harbour": ["--fps", 2, "--seconds", 90, "--size", "320x240"]}  # fmt: skip
MOVER_ROOMS = ["office", "living-room"]
VISITS = 4
MASKS = ["gt", "sam"]
KINDS = ["moved", "removed", "added"]
WITHOUT = ["--set", "free_space.enabled=false", "--dynamic", "off"]


@functools.cache
def render(program, folder, room, *options):
    """Once for all rows of a room."""
    run(program, "synth", folder, "--room", room, *options)


def continued_map(program, folder, masks, settings):
    file = folder / f"{masks}.ovimap"
    common = ["--masks", masks, "--encoder", "none", *settings]
    map_recording(program, folder / "visit1", file, *common)
    for visit in range(2, VISITS + 1):
        map_recording(program, folder / f"visit{visit}", file, "--continue", file, *common)
    return file


def row(program, work, room, masks, settings):
    folder = work / "visits" / room
    render(program, folder, room, *ROOMS[room], "--visits", VISITS)
    map_file = continued_map(program, folder, masks, settings)
    scores = run_json(program, "eval-changes", map_file, folder)
    now = run_json(program, "eval", map_file, "--gt", folder / f"visit{VISITS}", "--encoder", "none")["standard"]
    changes = [f"{scores[kind]['precision']:.2f} / {scores[kind]['recall']:.2f} ({scores[kind]['real']})" for kind in KINDS]
    return (f"| {room} | {masks} | {'off' if settings else 'on'} | {100 * scores['ghost']:.1f} % | {100 * scores['static_kept']:.1f} % "
            f"| {now['class_agnostic']['ap50']:.3f} | {' | '.join(changes)} | {scores['ids_kept']} + {scores['in_doubt']} of {scores['moved']['real']} |")


def mover_row(program, work, room, mode):
    folder = work / "movers" / room
    render(program, folder, room, "--walk", "--fps", 8, "--seconds", 30, "--visits", 1, "--figure", "--size", "320x240")
    map_file = folder / f"{mode}.ovimap"
    map_recording(program, folder / "visit1", map_file, "--masks", "gt", "--encoder", "none", "--dynamic", mode)
    scores = run_json(program, "eval-changes", map_file, folder)
    now = run_json(program, "eval", map_file, "--gt", folder / "visit1", "--encoder", "none")["standard"]
    return (f"| {room} | {mode} | {100 * scores['mover_left']:.2f} % | {100 * scores['static_kept']:.1f} % "
            f"| {now['class_agnostic']['ap50']:.3f} |")


def movers(program, work):
    rows = [told(mover_row(program, work, room, mode)) for room in MOVER_ROOMS for mode in ("off", "drop")]
    return ["Somebody walks through the room with a carton in the hands (`synth --figure`). Left: share of her surface, frame by frame, that the map shows.", "",
            "| room | `--dynamic` | left | kept | AP50 of the room |", "| --- " * 5 + "|", *rows, ""]


def cost_row(program, work, room):
    """A visit in which nothing moves, with and without, by turns."""
    folder, ways = work / "visits" / room, {"off": WITHOUT, "on": []}
    render(program, folder, room, *ROOMS[room], "--visits", VISITS)
    runs, maps = {way: [] for way in ways}, {way: folder / f"still-{way}.ovimap" for way in ways}
    for way in list(ways) * 3:
        runs[way].append(run_json(program, "run", folder / "visit1", "--masks", "gt", "--encoder", "none", "-o", maps[way], *ways[way]))
    median = {way: {of: statistics.median(one[of] for one in runs[way]) for of in ("cpu_seconds", "peak_rss_mb")} for way in ways}
    scores = {way: run_json(program, "eval", maps[way], "--gt", folder / "visit1", "--encoder", "none")["standard"] for way in ways}
    more = [f"{100 * (median['on'][of] / median['off'][of] - 1):+.1f} %" for of in ("cpu_seconds", "peak_rss_mb")]
    same = [" -> ".join(f"{scores[way][part][of]:.3f}" for way in ways) for part, of in
            (("class_agnostic", "ap50"), ("class_agnostic", "ap25"), ("geometry", "completeness"))]  # fmt: skip
    return f"| {room} | {' | '.join(same + more)} |"


def costs(program, work):
    return ["What it costs where nothing moves: the first visit, true masks, with `" + " ".join(WITHOUT) + "` -> as it is; processor time and peak memory of whole runs, medians of three by turns.", "",
            "| room | AP50 | AP25 | completeness | processor time | memory |", "| --- " * 6 + "|", *(told(cost_row(program, work, room)) for room in ROOMS), ""]  # fmt: skip


def told(made):
    """Hours go into this table: what is there is said at once."""
    print(made, file=sys.stderr, flush=True)
    return made


def section(program, work):
    rows = [told(row(program, work, room, masks, settings)) for room in ROOMS for masks in MASKS
            for settings in ([], ["--set", "free_space.enabled=false"]) if masks == "gt" or not settings]
    return [f"## {VISITS} visits to rooms where things move", "",
            f"    ovimap synth DIR --room ROOM --noise --visits {VISITS}        # harbour: {' '.join(map(str, ROOMS['harbour']))} --visits {VISITS}", "    ovimap run DIR/visit1 --masks MASKS --encoder none -o MAP",
            "    ovimap run DIR/visit2 --masks MASKS --encoder none --continue MAP -o MAP", "    ovimap eval-changes MAP DIR", "",
            "Between two visits three things move, one is carried off and one brought in; in the flat `harbour`, of which a walk sees less, a door turns as well. Left: share of the surface of what left that the map still "
            "shows, where five frames looked through. Kept: share of unchanged surface within 2 cm of the map's. AP50: of the last visit's objects. Changes: precision / "
            "recall (how many there were); ids of what moved: kept, and told in doubt. docs/changes.md says how they are counted.", "",
            "| room | masks | free space | left | kept | AP50 | moved | removed | added | ids of moved kept |", "| --- " * 10 + "|", *rows, "", *movers(program, work), *costs(program, work)]
