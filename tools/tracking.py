# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Tracking for tools/benchmarks.py: poses found without any given, against the true ones, beside those of Open3D and OpenCV."""
import pathlib
import shutil

from speed import RIVALS, map_recording, run, run_json

# Name, what makes it beside --room or --plan, aim of the ATE in cm.
WALKS = [("living-room", ["--room", "living-room", "--walk", "--seconds", "10"], 1.0),
         ("whip-pans", ["--room", "office", "--walk", "--seconds", "14", "--whip", "120"], None),
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
            run(program, "synth", folder, *options)
            (folder / "done").touch()
        yield name, folder / options[1], 1, aim


def row(name, tracker, report, scores, step, aim, loops, p50_ms):
    share = f"{report['frames_tracked']} of {report['frames']}"
    ate = 100 * scores["ate_m"]["rmse"]
    met = "" if aim is None else f"<= {aim:g}: {'yes' if ate <= aim else 'no'}"
    which = "all" if step == 1 else f"every {step}rd"
    return (f"| {name} | {which} | {tracker} | {share} | {ate:.2f} | {met} | {100 * scores['ate_m']['max']:.2f} "
            f"| {1e3 * scores['rpe_m']['rmse']:.1f} | {100 * scores['closure_m']:.2f} | {loops} | {p50_ms:.1f} |")


def kept(work, name, step, tracker, make):
    """A row of the table, made once: a broken-off run goes on where it stopped. `make` gets the file for the poses."""
    stem = work / "walks" / f"{name}-{step}-{tracker}".replace(" ", "-")
    file = stem.with_suffix(".row")
    if not file.exists():
        file.write_text(make(stem.with_suffix(".txt")))
    return file.read_text()


def our_row(program, name, recording, step, aim, closing, trajectory):
    options = [] if closing else ["--set", "loops.min_path_m=1000000"]
    report = run_json(program, "run", recording, "--poses", "track", "--frames", f"::{step}", "--masks", "none", "--encoder", "none", *options,
                      "--trajectory", trajectory, "-o", trajectory.with_suffix(".ovimap"))
    scores = run_json(program, "eval-poses", trajectory, recording)
    tracking = report["tracking"]
    return row(name, "ovimap" if closing else "ovimap, loops not closed", tracking, scores, step, aim if closing else None,
               tracking["loops_closed"], report["stages"]["track"]["p50_ms"])


def our_rows(program, work, name, recording, step, aim):
    for closing in ([True, False] if name == "loop" else [True]):
        yield kept(work, name, step, "closed" if closing else "open",
                   lambda poses: our_row(program, name, recording, step, aim, closing, poses))


def their_row(program, name, recording, step, method, trajectory):
    report = run_json(RIVALS / "bin" / "python", "bench/rivals/odometry.py", program.parent / "ovimap_fusion_steps", recording,
                      "--method", method, "--step", step, "--fps", FPS.get(name, 30), "-o", trajectory)
    scores = run_json(program, "eval-poses", trajectory, recording)
    counts = {"frames": report["frames"] + report["failed"], "frames_tracked": report["frames"]}
    return row(name, f"{report['version']} {method.split('-')[1]}", counts, scores, step, None, "-", report["p50_ms"])


def their_rows(program, work, name, recording, step):
    if not (RIVALS / "bin" / "python").exists():
        return
    for method in ("open3d-odometry", "open3d-slam", "opencv-odometry"):
        yield kept(work, name, step, method, lambda poses: their_row(program, name, recording, step, method, poses))


def matrix_of(quaternion, place):
    """Of a pose as TUM lines have it: the upper three rows."""
    x, y, z, w = quaternion
    turn = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return [[*row, place[i]] for i, row in enumerate(turn)]


def product(a, b):
    b = [*b, [0, 0, 0, 1]]
    return [[sum(row[k] * b[k][j] for k in range(4)) for j in range(4)] for row in a]


def with_tracked_poses(recording, trajectory, folder):
    """The recording with poses that were found without any, from where the first one truly is: the world of a tracked map is its first camera."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for entry in [*recording.iterdir(), recording.parent / "cam_params.json"]:
        (folder / entry.name).symlink_to(entry.resolve())
    truth = [float(word) for word in (recording / "traj.txt").read_text().splitlines()[0].split()]
    first = [truth[4 * i:4 * i + 4] for i in range(3)]
    lines = []
    for line in trajectory.read_text().splitlines():
        if line.startswith("#"):
            continue
        _, *numbers = map(float, line.split())
        pose = product(first, matrix_of(numbers[3:], numbers[:3]))
        lines.append(" ".join(str(value) for row in [*pose, [0, 0, 0, 1]] for value in row))
    if len(lines) != len((recording / "traj.txt").read_text().splitlines()):
        raise SystemExit(f"{trajectory}: not every frame was tracked, so its objects cannot be counted")
    (folder / "traj.txt").unlink()
    (folder / "traj.txt").write_text("\n".join(lines) + "\n")
    return folder


def object_row(program, poses, recording, truth, file):
    map_recording(program, recording, file, "--masks", "gt", "--encoder", "none")
    scores = run_json(program, "eval", file, "--gt", truth, "--encoder", "none", "--protocol", "standard")["standard"]["class_agnostic"]
    return f"| {poses} | {scores['ap50']:.3f} | {scores['ap25']:.3f} |"


def object_lines(program, work):
    """What objects lose to poses that were tracked."""
    name = WALKS[0][0]
    walks = work / "walks"
    recording = walks / name / name
    tracked = with_tracked_poses(recording, walks / f"{name}-1-closed.txt", walks / f"{name}-tracked")
    yield f"Objects of the {name} with true masks, by true and by tracked poses (aim: AP50 within 0.03):"
    yield from ["", "| poses | AP50 | AP25 |", "| --- | --- | --- |"]
    for poses, source in (("true", recording), ("tracked", tracked)):
        yield kept(work, name, 1, f"objects-{poses}", lambda file: object_row(program, poses, source, recording, file.with_suffix(".ovimap")))
    yield ""


def tracking_lines(program, work, kitchen):
    (work / "walks").mkdir(parents=True, exist_ok=True)
    rows = []
    for name, recording, step, aim in recordings(program, work, kitchen):
        rows += our_rows(program, work, name, recording, step, aim)
        rows += their_rows(program, work, name, pathlib.Path(recording), step)
    yield from [*("    ovimap synth DIR " + " ".join(options) for _, options, _ in WALKS),
                "    ovimap run RECORDING --poses track --masks none --encoder none --trajectory FILE -o MAP",
                "    ovimap eval-poses FILE RECORDING", "    make rivals    # Open3D and OpenCV, where they are installed", "",
                "The kitchen's own poses come from a depth tracker and are good to some centimetres; the walks are rendered with the noise "
                "and blur of a sensor and have exact truth. Times are of tracking alone, the ray cast of the map included.", "",
                "| " + " | ".join(HEAD) + " |", "| --- " * len(HEAD) + "|", *rows, "", *object_lines(program, work)]
