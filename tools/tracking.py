# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Tracking for tools/benchmarks.py: poses found without any given, against the true ones, beside Open3D's."""
import pathlib
import subprocess

from speed import RIVALS, run_json

# Name, what makes it beside --room or --plan, aim of the ATE in cm.
WALKS = [("living-room", ["--room", "living-room", "--walk", "--seconds", "10"], 1.0),
         ("loop", ["--plan", "loop", "--fps", "10", "--size", "320x240"], 2.0)]
FPS = {"loop": 10}
KITCHEN_AIM_CM = 3.0
HEAD = ["recording", "frames", "tracker", "tracked", "ATE rmse, cm", "aim", "ATE max, cm", "RPE, mm a frame", "end off, cm", "loops", "ms a frame, p50"]


def recordings(program, work, kitchen):
    """Name, folder, step, aim; the walks are rendered once."""
    if kitchen:
        yield "kitchen video", kitchen, 1, KITCHEN_AIM_CM
        yield "kitchen video", kitchen, 3, KITCHEN_AIM_CM
    for name, options, aim in WALKS:
        folder = work / "walks" / name
        if not (folder / "done").exists():
            subprocess.run([str(program), "synth", str(folder), *options], check=True, stdout=subprocess.DEVNULL)
            (folder / "done").touch()
        yield name, folder / name, 1, aim


def row(name, tracker, report, scores, step, aim, loops, p50_ms):
    share = f"{report['frames_tracked']} of {report['frames']}"
    ate = 100 * scores["ate_m"]["rmse"]
    met = "" if aim is None else f"<= {aim:g}: {'yes' if ate <= aim else 'no'}"
    which = "all" if step == 1 else f"every {step}rd"
    return (f"| {name} | {which} | {tracker} | {share} | {ate:.2f} | {met} | {100 * scores['ate_m']['max']:.2f} "
            f"| {1e3 * scores['rpe_m']['rmse']:.1f} | {100 * scores['closure_m']:.2f} | {loops} | {p50_ms:.1f} |")


def our_rows(program, work, name, recording, step, aim):
    for closing in ([True, False] if name == "loop" else [True]):
        trajectory = work / "walks" / f"{name.replace(' ', '-')}-{step}.txt"
        options = [] if closing else ["--set", "loops.min_path_m=1000000"]
        report = run_json(program, "run", recording, "--poses", "track", "--frames", f"::{step}", *options,
                          "--trajectory", trajectory, "-o", work / "walks" / "map.ovimap")
        scores = run_json(program, "eval-poses", trajectory, recording)
        tracking = report["tracking"]
        yield row(name, "ovimap" if closing else "ovimap, loops not closed", tracking, scores, step, aim if closing else None,
                  tracking["loops_closed"], report["stages"]["track"]["p50_ms"])


def their_rows(program, work, name, recording, step):
    python = RIVALS / "bin" / "python"
    if not python.exists():
        return
    for method in ("odometry", "slam"):
        trajectory = work / "walks" / f"open3d-{method}.txt"
        report = run_json(python, "bench/rivals/open3d_odometry.py", program.parent / "ovimap_fusion_steps", recording,
                          "--method", method, "--step", step, "--fps", FPS.get(name, 30), "-o", trajectory)
        scores = run_json(program, "eval-poses", trajectory, recording)
        counts = {"frames": report["frames"] + report["failed"], "frames_tracked": report["frames"]}
        yield row(name, f"Open3D {report['open3d']} {method}", counts, scores, step, None, "-", report["p50_ms"])


def tracking_lines(program, work, kitchen):
    (work / "walks").mkdir(parents=True, exist_ok=True)
    rows = []
    for name, recording, step, aim in recordings(program, work, kitchen):
        rows += our_rows(program, work, name, recording, step, aim)
        rows += their_rows(program, work, name, pathlib.Path(recording), step)
    yield from ["    ovimap synth DIR " + " ".join(WALKS[0][1]) + "; ovimap synth DIR " + " ".join(WALKS[1][1]),
                "    ovimap run RECORDING --poses track --trajectory FILE -o MAP",
                "    ovimap eval-poses FILE RECORDING", "    make rivals    # Open3D, where it is installed", "",
                "The kitchen's own poses come from a depth tracker and are good to some centimetres; the walks are rendered with the noise "
                "and blur of a sensor and have exact truth. Times are of tracking alone, the ray cast of the map included.", "",
                "| " + " | ".join(HEAD) + " |", "| --- " * len(HEAD) + "|", *rows, ""]
