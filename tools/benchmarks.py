#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Measures quality on rendered rooms and speed on a real recording, and writes docs/benchmarks.md.

Usage: tools/benchmarks.py PROGRAM [--kitchen FOLDER] [--out docs/benchmarks.md]
FOLDER is a 640x480 recording (7-Scenes red kitchen in the published page); without it speed is not measured.
"""
import argparse
import datetime
import json
import pathlib
import subprocess
import tempfile

TARGETS_MS = {"depth segmentation": 30, "association + fusion + labels": 40, "ray cast": 20, "MobileSAM frame": 4000}


def run_json(*command):
    command = [str(word) for word in command] + ["--json"]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def quality_rows(program, work):
    for noise in (False, True):
        room = work / ("noisy" if noise else "exact")
        run_json(program, "synth", room, "--room", "tiny", *(["--noise"] if noise else []))
        for masks, options in (("gt", []), ("sam", ["--set", "mask_interval=1"]), ("none", [])):
            scene, map_file = room / "room", work / "room.ovimap"
            run_json(program, "run", scene, "--masks", masks, *options, "-o", map_file)
            scores = run_json(program, "eval", map_file, "--gt", scene)
            standard, reference = scores["standard"]["class_agnostic"], scores["reference"]["class_agnostic"]
            geometry = scores["standard"]["geometry"]
            yield (f"| {'on' if noise else 'off'} | {masks} | {standard['miou']:.3f} | {standard['ap']:.3f} | {standard['ap75']:.3f} "
                   f"| {standard['ap50']:.3f} | {standard['ap25']:.3f} | {reference['miou']:.3f} | {reference['ap75']:.3f} "
                   f"| {reference['ap50']:.3f} | {reference['ap25']:.3f} | {standard['predicted_instances']} / {standard['truth_instances']} "
                   f"| {1e3 * geometry['accuracy_m']:.1f} | {geometry['completeness']:.3f} |")


def stage_rows(bench):
    for name, stage in bench["stages"].items():
        yield f"| {name} | {stage['p50_ms']:.1f} | {stage['p95_ms']:.1f} | {stage['p99_ms']:.1f} | {stage['count']} |"


def measured_ms(bench, sam):
    p50 = {name: stage["p50_ms"] for name, stage in bench["stages"].items()}
    return {"depth segmentation": p50["surface"] + p50["regions"],
            "association + fusion + labels": p50["associate"] + p50["integrate"] + p50["registry"],
            "ray cast": p50["project"], "MobileSAM frame": sam["stages"]["masks"]["p50_ms"]}


def speed_section(program, kitchen):
    bench = run_json(program, "bench", kitchen)
    sam = run_json(program, "bench", kitchen, "--masks", "sam", "--frames", "::10", "--set", "mask_interval=1")
    text = ["## Speed: 7-Scenes red kitchen, 200 frames of 640x480, 1 cm voxels", "",
            "    ovimap bench KITCHEN", "    ovimap bench KITCHEN --masks sam --frames ::10 --set mask_interval=1", "",
            f"Depth alone: {bench['fps']:.1f} frames a second, decoding included; peak memory {bench['peak_rss_mb']:.0f} MB; "
            f"{bench['bytes_per_voxel']:.1f} bytes a voxel; map file {bench['map_bytes'] / 1e6:.1f} MB.", "",
            "| what | target, ms | measured p50, ms |", "| --- | --- | --- |"]
    text += [f"| {name} | {TARGETS_MS[name]} | {value:.1f} |" for name, value in measured_ms(bench, sam).items()]
    text += ["", "Every stage, depth alone:", "", "| stage | p50 ms | p95 ms | p99 ms | count |", "| --- | --- | --- | --- | --- |"]
    return text + list(stage_rows(bench)), bench["machine"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--kitchen", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("docs/benchmarks.md"))
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    speed, machine = speed_section(program, arguments.kitchen) if arguments.kitchen else ([], "not recorded")
    with tempfile.TemporaryDirectory() as work:
        quality = list(quality_rows(program, pathlib.Path(work)))
    version = subprocess.run([program, "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout.strip()
    page = ["# Benchmarks", "", "Written by `make benchmarks KITCHEN=FOLDER`. Nothing here was typed in by hand.", "",
            f"Machine: {machine}. Program: {version}. Date: {datetime.date.today()}.", "",
            "## Quality: the rendered room `tiny`, 40 frames of 320x240, class-agnostic", "",
            "    ovimap synth DIR --room tiny [--noise]", "    ovimap run DIR/room --masks MASKS -o MAP",
            "    ovimap eval MAP --gt DIR/room", "",
            "`standard` is ranked one-to-one average precision over all true instances; `reference` computes what the paper's "
            "released code calls AP (right predictions per prediction). Masks: gt = the true 2D instances, sam = MobileSAM on every "
            "frame, none = depth alone. The error is that of the surface, point to triangle.", "",
            "| noise | masks | mIoU | AP | AP75 | AP50 | AP25 | ref. mIoU | ref. AP75 | ref. AP50 | ref. AP25 | objects found / true | error, mm | completeness |",
            "| --- " * 14 + "|", *quality, "", *speed, ""]
    arguments.out.write_text("\n".join(page))


if __name__ == "__main__":
    main()
