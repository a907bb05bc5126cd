#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Measures quality on the rendered rooms and speed on a real recording, and writes docs/benchmarks.md.

Usage: tools/benchmarks.py PROGRAM [--kitchen FOLDER] [--studio FOLDER] [--only SECTION...] [--work build/benchmarks] [--out docs]
FOLDER is a 640x480 recording (7-Scenes red kitchen in the published page); without it speed is not measured. --studio
is what tools/blender_scene/render.py wrote; without it that scene is not measured. Rooms, masks and maps stay in the work folder: a broken-off run goes on where it stopped, a finished one is only read again.
"""
import argparse
import datetime
import functools
import itertools
import json
import os
import pathlib
import shutil
import subprocess

import lasting
import speed
import tracking
import visits
from speed import map_recording, run, run_json

TUNED, UNSEEN = ["living-room", "bedroom", "kitchen"], ["office", "bathroom"]
MASKS = ["gt", "sam", "none"]
# Aims of the standard protocol, class-agnostic, with sensor noise.
AIMS = {"gt": {"ap50": 0.92}, "sam": {"ap50": 0.60, "ap25": 0.78}, "none": {"ap25": 0.60}}
ABLATIONS = ["masks", "views", "fusion", "incremental", "timing"]  # on the unseen rooms
# A schedule is one of a video: a walk through an unseen room. A network takes seconds a frame, true masks nothing.
WALK = ["--room", "office", "--walk", "--seconds", "20", "--size", "320x240"]
SCHEDULES = {"gt": [], "sam": ["--frames", "::5"]}
SECTIONS = ["tiny", "rooms", "exact", "apartments", "desks", "speed", "track", "corridor", "lasting", "surface", "visits", "masks", "views", "fusion", "incremental", "schedule", "timing"]
NEED_KITCHEN = ["speed", "lasting"]
# Two crops a view instead of six: the ablations compare, and embedding is most of their time.
FEW_CROPS = ["--set", "crops.scales=1"]


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown processor"


# ------------------------------------------------------------------------------------------------------- quality

def tiny_rows(program, work):
    for noise in (False, True):
        room = work / "tiny" / ("noisy" if noise else "exact")
        run(program, "synth", room, "--room", "tiny", *(["--noise"] if noise else []))
        for masks, options in (("gt", []), ("sam", ["--set", "mask_interval=1"]), ("none", [])):
            map_file = work / "tiny" / "room.ovimap"
            map_recording(program, room / "room", map_file, "--masks", masks, "--encoder", "none", *options)
            scores = run_json(program, "eval", map_file, "--gt", room / "room", "--encoder", "none")
            standard, reference = scores["standard"]["class_agnostic"], scores["reference"]["class_agnostic"]
            geometry = scores["standard"]["geometry"]
            yield (f"| {'on' if noise else 'off'} | {masks} | {standard['miou']:.3f} | {standard['ap']:.3f} | {standard['ap75']:.3f} "
                   f"| {standard['ap50']:.3f} | {standard['ap25']:.3f} | {reference['miou']:.3f} | {reference['ap50']:.3f} "
                   f"| {standard['predicted_instances']} / {standard['truth_instances']} "
                   f"| {1e3 * geometry['accuracy_m']:.1f} | {geometry['completeness']:.3f} |")


def tiny_section(program, work):
    return ["## Quality: the room `tiny`, 40 frames of 320x240", "",
            "    ovimap synth DIR --room tiny [--noise]", "    ovimap run DIR/room --masks MASKS -o MAP", "    ovimap eval MAP --gt DIR/room", "",
            "Class-agnostic. MobileSAM on every frame (`--masks sam --set mask_interval=1`).", "",
            "| noise | masks | mIoU | AP | AP75 | AP50 | AP25 | ref. mIoU | ref. AP50 | objects found / true | error, mm | completeness |",
            "| --- " * 12 + "|", *tiny_rows(program, work), ""]


def render(program, work, noise):
    folder = work / "rooms" / ("noisy" if noise else "exact")
    run(program, "synth", folder, "--room", "rooms-v1", *(["--noise"] if noise else []))
    return folder


def map_of(program, work, rooms, name, masks):
    file = work / "maps" / f"{rooms.name}-{name}-{masks}.ovimap"
    file.parent.mkdir(parents=True, exist_ok=True)
    if not file.exists():
        encoder = [] if masks != "none" else ["--encoder", "none"]
        map_recording(program, rooms / name, file, "--masks", masks, *FEW_CROPS, *encoder)
    return file


SIZES = ["small", "medium", "large", "flat"]
SIZE_HEADS = ["under 2 l", "2 to 20 l", "larger", "flat"]


def recalled(group):
    return f"{group['recall']:.2f} of {group['things']}" if group["things"] else "-"


def figure(scores, name, aim):
    value = scores[name]
    mark = "" if aim is None else " (aim met)" if value >= aim else f" (aim {aim:.2f})"
    return f"{value:.3f}{mark}"


def quality_row(program, work, rooms, names, group, masks):
    maps = [map_of(program, work, rooms, name, masks) for name in names]
    scores = run_json(program, "eval", *maps, "--gt", *(rooms / name for name in names))
    standard, reference = scores["standard"]["class_agnostic"], scores["reference"]["class_agnostic"]
    geometry, noisy = scores["standard"]["geometry"], rooms.name == "noisy"
    aims = AIMS[masks] if noisy else {}
    semantic = scores["standard"].get("semantic")
    words = [f"{semantic[key]:.3f}" for key in ("miou", "macc", "ap50", "ap25")] if semantic else ["-"] * 4
    aq = f"{semantic['aq']:.1f}" if semantic else "-"
    sizes = scores["standard"]["recall_by_size"]
    return (f"| {group} | {masks} | {figure(standard, 'miou', aims.get('miou'))} "
            f"| {standard['ap75']:.3f} | {figure(standard, 'ap50', aims.get('ap50'))} "
            f"| {figure(standard, 'ap25', aims.get('ap25'))} | {reference['miou']:.3f} | {reference['ap75']:.3f} "
            f"| {reference['ap50']:.3f} | {reference['ap25']:.3f} | {standard['predicted_instances']} / "
            f"{standard['truth_instances']} | {1e3 * geometry['accuracy_m']:.1f} | {geometry['completeness']:.3f} "
            f"| {' | '.join(recalled(sizes[group]) for group in SIZES)} | {' | '.join(words)} | {aq} |")


def quality_section(program, work, noisy):
    rooms = render(program, work, noisy)
    heads = ["rooms", "masks", "mIoU", "AP75", "AP50", "AP25", "ref. mIoU", "ref. AP75", "ref. AP50", "ref. AP25",
             "objects found / true", "error, mm", "completeness", *SIZE_HEADS, "class mIoU", "class mAcc", "class AP50", "class AP25", "AQ"]
    rows = [quality_row(program, work, rooms, names, group, masks)
            for group, names in (("tuned on", TUNED), ("unseen", UNSEEN))
            for masks in (MASKS if noisy else ["gt"])]
    return ["## Quality: rooms-v1, " + ("with sensor noise" if noisy else "exact"), "",
            "    ovimap synth DIR --room rooms-v1" + (" --noise" if noisy else ""), "    ovimap run DIR/ROOM --masks MASKS --set crops.scales=1 -o MAP",
            "    ovimap eval MAP... --gt DIR/ROOM...", "",
            "`standard` protocol unless it says ref., which computes what the paper's released code calls AP. Masks: gt = the true 2D "
            "instances, sam = MobileSAM on the frames that the program asks it about by itself (`mask_motion`), none = depth alone. Scenes are pooled. Parameters were tuned on living "
            "room, bedroom and kitchen; office and bathroom were only measured. Under 2 l and so on: recall of things of that size, and of flat ones, with an IoU of one half. Class figures: the default encoder, the room's own "
            "class names. The error is that of the surface, point to triangle.", "",
            "| " + " | ".join(heads) + " |", "| --- " * len(heads) + "|", *rows, ""]


def ablate(program, name, scenes, folder, out, picture, *options):
    """The lines that an ablation prints; its picture goes to the page's."""
    run(program, "ablate", name, *scenes, "-o", folder, *FEW_CROPS, *options)
    text, drawn = (folder / f"{name}.md").read_text().splitlines(), folder / f"{name}.svg"
    if drawn.exists():
        (out / "ablations").mkdir(exist_ok=True)
        shutil.copy(drawn, out / "ablations" / picture)
        text += ["", f"![{name}](ablations/{picture})"]
    return text


def ablation_section(program, work, out, name):
    rooms = render(program, work, True)
    return ablate(program, name, [rooms / room for room in UNSEEN], work / "ablations" / "all-frames", out, f"{name}.svg")


def live_lines(program, work, walk):
    """The same walk from a camera that does not wait; made anew each time, for it hangs on what the machine manages."""
    options = ["--masks", "sam", "--recognizer", "none", *FEW_CROPS]
    file = work / "walks" / "live.ovimap"
    live = run_json(program, "run", walk, "--live", "--fps", 30, *options, "-o", file)
    scores = run_json(program, "eval", file, "--gt", walk)
    yield from ["", "Live, with MobileSAM on what there is time for:", "",
                f"    ovimap run DIR/office --live --fps 30 {' '.join(options)} -o MAP", "    ovimap eval MAP --gt DIR/office", "",
                "| schedule | protocol | mIoU | mAcc | AP25 | AP50 | AP | inst mIoU | inst AP50 |", "| --- " * 9 + "|"]
    for protocol in ("standard", "reference"):
        words, objects = scores[protocol]["semantic"], scores[protocol]["class_agnostic"]
        figures = [words[key] for key in ("miou", "macc", "ap25", "ap50", "ap")] + [objects["miou"], objects["ap50"]]
        yield f"| live, 30 frames/s | {protocol} | {' | '.join(f'{100 * figure:.1f}' for figure in figures)} |"
    yield from ["", speed.live_line("Live", live)]


def schedule_section(program, work, out):
    run(program, "synth", work / "walks", *WALK)
    walk = work / "walks" / "office"
    title, *text = [], "", f"    ovimap synth DIR {' '.join(WALK)}"
    for masks, options in SCHEDULES.items():
        title, *table = ablate(program, "schedule", [walk], work / "ablations" / f"schedule-{masks}", out, f"schedule-{masks}.svg",
                               "--masks", masks, *options)
        text += table
    return [title, *text, *live_lines(program, work, walk)]


# ---------------------------------------------------------------------------------------------- places of no tuning

# What is reported: the halves of the sets that nothing is tuned or trained on.
PLACES = {"apartments": {"set": "apartments-v1", "unseen": ["harbour", "meadow"],
                         "aims": {"gt": {"ap50": 0.92}, "sam": {"ap50": 0.45, "ap25": 0.70}, "none": {"ap25": 0.60}}},
          "desks": {"set": "desks-v1", "unseen": ["work-desk", "evening-desk", "supper-table", "open-shelf"],
                    "aims": {"gt": {"ap50": 0.92}, "sam": {"ap50": 0.50}, "none": {"ap25": 0.60}}}}  # fmt: skip
# True masks on every frame; a network where the program asks by itself.
PLACE_MASKS = {"gt": ["--set", "mask_interval=1"], "sam": [], "none": []}


def place_map(program, work, scene, masks):
    file = work / "maps" / f"{scene.parent.name}-{scene.name}-{masks}.ovimap"
    file.parent.mkdir(parents=True, exist_ok=True)
    if not file.exists():
        map_recording(program, scene, file, "--masks", masks, "--encoder", "none", *PLACE_MASKS[masks])
    return file


def place_row(program, work, name, scenes, masks, aims):
    maps = [place_map(program, work, scene, masks) for scene in scenes]
    scores = run_json(program, "eval", *maps, "--gt", *scenes, "--encoder", "none", "--protocol", "standard")["standard"]
    objects, sizes, geometry = scores["class_agnostic"], scores["recall_by_size"], scores["geometry"]
    recalls = " | ".join(recalled(sizes[group]) for group in (*SIZES, "unscored"))
    return (f"| {name} | {masks} | {figure(objects, 'ap50', aims.get('ap50'))} | {figure(objects, 'ap25', aims.get('ap25'))} | {objects['miou']:.3f} | {sizes['objects_per_thing']:.2f} "
            f"| {recalls} | {1e3 * geometry['accuracy_m']:.1f} | {geometry['completeness']:.3f} |")


def place_rows(program, work, name, studio):
    chosen, folder = PLACES[name], work / PLACES[name]["set"]
    for scene in chosen["unseen"]:
        run(program, "synth", folder, "--room", scene)
    groups = [("all unseen", [folder / scene for scene in chosen["unseen"]])]
    if name == "apartments":
        groups += [(scene, [folder / scene]) for scene in chosen["unseen"]]
        if studio:
            groups.append(("studio (Blender)", [studio]))
    for group, scenes in groups:
        for source in MASKS:
            yield place_row(program, work, group, scenes, source, chosen["aims"][source])
    exact = work / f"{folder.name}-exact"
    for scene in chosen["unseen"]:
        run(program, "synth", exact, "--room", scene, "--exact")
    yield place_row(program, work, "all unseen, exact", [exact / scene for scene in chosen["unseen"]], "gt", {"ap50": 0.95})


def place_section(program, work, name, studio):
    title = {"apartments": "Flats that nothing was tuned on: apartments-v1", "desks": "Small and flat things: desks-v1"}[name]
    return [f"## {title}", "", f"    ovimap synth DIR --room {PLACES[name]['set']}", "    ovimap run DIR/SCENE --masks MASKS -o MAP",
            "    ovimap eval MAP... --gt DIR/SCENE...", "",
            "Class-agnostic, `standard` protocol, scenes pooled, sensor noise and motion blur on but for the last row. Recalls: an object with an IoU of one half; docs/evaluation.md "
            "says what is scored and which scenes are unseen. gt: true masks on every frame; sam: MobileSAM on the frames that the program asks it about by itself (`mask_motion`).", "",
            f"| scenes | masks | AP50 | AP25 | mIoU | objects / true | {' | '.join(SIZE_HEADS)} | not scored | error, mm | completeness |",
            "| --- " * 13 + "|", *place_rows(program, work, name, studio), ""]


# ------------------------------------------------------------------------------------------------------- surface

# Large places: one whose walk chose the defaults, and one that chose nothing. Errors of a real sensor are alike over windows, and its lens bends.
WINDOWS = ["--set", "sensor.correlation_px=6", "--set", "sensor.lens_bias_px=0.05"]
LARGE = {"flat": ["--plan", "flat"], "harbour": ["--room", "harbour"], "hall": ["--plan", "hall"]}
SENSORS = {"each pixel errs by itself": [], "neighbours err alike": WINDOWS}
FUSIONS = {"ovimap, raw depth, 1/z^2, any weight": ["depth.enabled=false", "map.min_mesh_weight=0.0001"],
           "ovimap": []}
OPEN3D_WEIGHTS = [1, 3, 5, 10]


def surface_scores(program, scene, surface):
    return run_json(program, "eval", surface, "--gt", scene, "--encoder", "none", "--protocol", "standard")["standard"]


def surface_row(name, scores, agnostic="- | -"):
    geometry = scores["geometry"]
    return (f"| {name} | {1e3 * geometry['accuracy_median_m']:.1f} | {1e3 * geometry['accuracy_m']:.1f} | {100 * geometry['stray']:.1f} "
            f"| {geometry['completeness']:.3f} | {geometry['completeness_1cm']:.3f} | {agnostic} |")


def open3d_scores(program, scene, folder):
    """By weight. Nothing where `make rivals` was not run."""
    python = speed.RIVALS / "bin" / "python"
    if not python.exists():
        return {}
    run(python, "bench/rivals/open3d_surface.py", pathlib.Path(program).parent / "ovimap_fusion_steps", scene, folder,
        "--weights", *OPEN3D_WEIGHTS)
    return {weight: surface_scores(program, scene, folder / f"weight-{weight}.ply") for weight in OPEN3D_WEIGHTS}


def surface_curve(program, surface, scene, completenesses):
    command = [pathlib.Path(program).parent / "ovimap_surface_curve", surface, scene, *map(str, completenesses)]
    return json.loads(subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout)


def surface_rows(program, scene, folder):
    """The table, and a sentence on what the frames tell well."""
    rows, surface = [], folder / "surface.ovimap"
    for name, settings in FUSIONS.items():
        options = [word for setting in settings for word in ("--set", setting)]
        map_recording(program, scene, surface, "--masks", "gt", "--encoder", "none", *options)
        scores = surface_scores(program, scene, surface)
        objects = scores["class_agnostic"]
        rows.append(surface_row(name, scores, f"{objects['ap50']:.3f} | {objects['ap25']:.3f}"))
    theirs = open3d_scores(program, scene, folder)
    complete = {weight: scores["geometry"]["completeness"] for weight, scores in theirs.items()}
    curve = surface_curve(program, surface, scene, complete.values())
    for (weight, scores), ours in zip(theirs.items(), curve["curve"]):
        rows += [surface_row(f"Open3D, weight >= {weight}", scores),
                 f"| ... ovimap as complete | {1e3 * ours['median_m']:.1f} | {1e3 * ours['mean_m']:.1f} | {100 * ours['stray']:.1f} | {ours['completeness']:.3f} | - | - | - |"]
    return [*rows, "", f"All frames together tell {100 * curve['known']:.0f} % of the true vertices to 10 mm (one standard deviation, if each pixel erred by itself); "
            f"of these the map has {100 * curve['completeness_of_known']:.1f} %."]


def surface_section(program, work):
    lines = ["## The surface of large places under sensor noise", "",
             "    ovimap synth DIR PLACE --fps 2 [--set SENSOR...]", "    ovimap run DIR/SCENE --masks gt [--set SETTING...] -o MAP",
             "    bench/rivals/open3d_surface.py build/release/bin/ovimap_fusion_steps DIR/SCENE OUT", "    ovimap eval MAP|PLY --gt DIR/SCENE",
             "    build/release/bin/ovimap_surface_curve MAP DIR/SCENE COMPLETENESS...", "",
             "Error: from the vertices to the true surface; stray are those farther than 20 cm from it, which count in neither error. One walk at 640x480, "
             "voxels of 1 cm, truncation 5 cm for all. Raw depth: `" + " ".join(FUSIONS["ovimap, raw depth, 1/z^2, any weight"])
             + "`. Neighbours err alike: `" + " ".join(WINDOWS) + "`. Open3D 0.20's VoxelBlockGrid shows surface from a weight of 3 unless told otherwise. "
             "As complete: those vertices of the row `ovimap` that are known best, as many as make it as complete as Open3D's row above.", ""]
    for (place, options), (sensor, settings) in itertools.product(LARGE.items(), SENSORS.items()):
        folder = work / "surface" / (place + ("-windows" if settings else ""))
        run(program, "synth", folder, *options, "--fps", "2", *settings)
        lines += [f"### {place}: {sensor}", "",
                  "| surface | median error, mm | mean, mm | stray, % | completeness | ... within 1 cm | AP50 | AP25 |",
                  "| --- " * 8 + "|", *surface_rows(program, folder / place, folder), ""]
    return lines


# --------------------------------------------------------------------------------------------------------- speed

def speed_section(program, kitchen):
    return ["## Speed: 7-Scenes red kitchen, 640x480", "",
            "    make rivals; make bench SOURCE=KITCHEN", "", *speed.speed_lines(program, kitchen)]


def track_section(program, work, kitchen):
    return ["## Tracking without poses", "", "    make benchmarks KITCHEN=KITCHEN_VIDEO ONLY=track", "",
            *tracking.tracking_lines(program, work, kitchen)]


def lasting_section(program, kitchen):
    return ["## What a map that lasts costs", "", "    make benchmarks KITCHEN=FOLDER ONLY=lasting", "",
            *lasting.lasting_lines(program, kitchen)]


def corridor_section(program):
    return ["## Does mapping slow down as the map grows?", "",
            f"    ovimap bench --corridor {speed.CORRIDOR_FRAMES} --masks gt", "", *speed.corridor_lines(program)]


# ----------------------------------------------------------------------------------------------------------- page

HEAD = ["# Benchmarks", "", "Written by `make benchmarks KITCHEN=FOLDER`. Nothing here was typed in by hand. Each part says what made it.", ""]


def mark(section):
    return f"<!-- {section} -->"


def kept_sections(page):
    """The parts of an earlier page: name, text from its mark to the next."""
    text = page.read_text() if page.exists() else ""
    starts = sorted((text.index(mark(name)), name) for name in SECTIONS if mark(name) in text)
    ends = [start for start, _ in starts[1:]] + [len(text)]
    return {name: text[start:end].rstrip() + "\n" for (start, name), end in zip(starts, ends)}


def provenance(program):
    version = subprocess.run([program, "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout.strip()
    return f"{processor()}, {os.cpu_count()} threads; {version}; {datetime.date.today()}."


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--kitchen", type=pathlib.Path)
    parser.add_argument("--studio", type=pathlib.Path)
    parser.add_argument("--only", nargs="+", choices=SECTIONS, help="measure these parts; the page keeps the others as they are")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("build/benchmarks"))
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("docs"))
    arguments = parser.parse_args()
    program, work, page = arguments.program.resolve(), arguments.work, arguments.out / "benchmarks.md"
    measure = {"tiny": lambda: tiny_section(program, work),
               "rooms": lambda: quality_section(program, work, noisy=True),
               "exact": lambda: quality_section(program, work, noisy=False),
               **{name: functools.partial(place_section, program, work, name, arguments.studio) for name in PLACES},
               "speed": lambda: speed_section(program, arguments.kitchen),
               "track": lambda: track_section(program, work, arguments.kitchen),
               "corridor": lambda: corridor_section(program),
               "lasting": lambda: lasting_section(program, arguments.kitchen),
               "surface": lambda: surface_section(program, work),
               "visits": lambda: visits.section(program, work),
               "schedule": lambda: schedule_section(program, work, arguments.out),
               **{name: functools.partial(ablation_section, program, work, arguments.out, name) for name in ABLATIONS}}
    for name in arguments.only or SECTIONS:
        if name in NEED_KITCHEN and not arguments.kitchen:
            print(f"{name} is not measured: name a recording with --kitchen FOLDER")
            continue
        title, *body = measure[name]()
        sections = kept_sections(page)
        sections[name] = "\n".join([mark(name), title, "", provenance(program), *body]).rstrip() + "\n"
        page.write_text("\n".join([*HEAD, *(sections[known] for known in SECTIONS if known in sections)]))


if __name__ == "__main__":
    main()
