#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Speed of mapping on a recording beside its targets, and beside Open3D where that is installed (`make rivals`).

Usage: tools/speed.py PROGRAM RECORDING [--rivals build/rivals]
"""
import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess
import tempfile

CORRIDOR_FRAMES = 10000
TURNS = 5
RIVALS = pathlib.Path("build/rivals")
TARGET_FUSE_MS, TARGET_CAST_MS = 22, 73  # Open3D's, where the targets were set


def run_json(*command):
    command = [str(word) for word in command] + ["--json"]
    return json.loads(subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout)


def run(program, *words):
    subprocess.run([str(word) for word in (program, *words)], check=True, stdout=subprocess.DEVNULL)


def map_recording(program, recording, file, *options):
    """From its beginning: what a run left that was broken off goes."""
    for left in file.parent.glob(f"{file.name}.partial*"):
        left.unlink()
    run(program, "run", recording, *options, "-o", file)


def measure_live(program, recording, *options):
    with tempfile.TemporaryDirectory() as folder:
        return run_json(program, "run", recording, "--live", "--fps", 30, *options, "-o", pathlib.Path(folder) / "map.ovimap")


def measure_open3d(program, recording, rivals):
    """Ours and theirs in turn; None where Open3D is not installed."""
    python = rivals / "bin" / "python"
    if not python.exists():
        return None
    return run_json(python, "bench/rivals/open3d_fusion.py", program.parent / "ovimap_fusion_steps", recording)


# ---------------------------------------------------------------------------------------------- targets

def slowness_of(open3d):
    """How many times as long this machine takes as the one the targets were set for; 1 without Open3D."""
    if not open3d:
        return 1.0
    return math.sqrt(open3d["theirs_fuse"] / TARGET_FUSE_MS * open3d["theirs_cast"] / TARGET_CAST_MS)


class Targets:
    """Rows of the table. What depends on the machine's speed stands there twice: as measured, and scaled by `slowness`."""

    def __init__(self, slowness):
        self.slowness = slowness

    def row(self, name, sign, target, value, scaled, unit, digits):
        met = scaled <= target if sign == "<=" else scaled >= target
        beside = f"{scaled:.{digits}f} {unit}" if scaled != value else "-"
        return f"| {name} | {sign} {target} {unit} | {value:.{digits}f} {unit} | {beside} | {'yes' if met else 'no'} |"

    def size(self, name, target, value, unit, digits=1):
        return self.row(name, "<=", target, value, value, unit, digits)

    def time(self, name, target, value, unit="ms", digits=1):
        return self.row(name, "<=", target, value, value / self.slowness, unit, digits)

    def rate(self, name, target, value):
        return self.row(name, ">=", target, value, value * self.slowness, "frames/s", 1)

    def kept_rate(self, name, target, value):
        """A rate that a camera's 30 frames/s bound, which no faster machine would exceed."""
        return self.row(name, ">=", target, value, value, "frames/s", 1)


def target_rows(bench, tracking_ms, sam, live, live_sam, open3d):
    p50 = {name: stage["p50_ms"] for name, stage in bench["stages"].items()}
    targets = Targets(slowness_of(open3d))
    yield targets.time("depth segmentation, while another frame is fused", 8, p50["surface"] + p50["regions"])
    if open3d:
        yield targets.time("depth segmentation, nothing beside it", 8, open3d["ours_segment"])
        yield targets.size("association + fusion with colour and labels, of Open3D's allocate + integrate", 0.6, open3d["fuse_ratio"], "x", 2)
        yield targets.size("ray cast guided by depth, as mapping uses it, of Open3D's ray cast", 0.12, open3d["guided_ratio"], "x", 3)
        yield targets.size("ray cast of all pixels, of Open3D's", 0.35, open3d["cast_ratio"], "x", 2)
    yield targets.time("mesh update, a frame", 10, p50["mesh_update"])
    yield targets.rate("geometry alone, decoding included", 30, bench["fps"])
    yield targets.time("processor time a frame of that", 45, cpu_ms(bench))
    yield targets.time("... and what finding the poses adds (`--track`)", 8, tracking_ms)
    yield targets.size("memory, a voxel", 16, bench["bytes_per_voxel"], "bytes")
    yield targets.size("peak memory without networks", 300, bench["peak_rss_mb"], "MB", 0)
    yield targets.size("map file", 22, bench["map_bytes"] / 1e6, "MB")
    if sam:
        yield targets.time("MobileSAM keyframe", 1000, sam["stages"]["masks"]["p50_ms"], digits=0)
    yield targets.kept_rate("live at 30 frames/s, geometry alone", 29.9, fused_fps(live))
    if live_sam:
        yield targets.kept_rate("live with MobileSAM and the default encoder: geometry", 15, fused_fps(live_sam))
        yield targets.time("... seconds from masks to masks", 4, seconds_between_masks(live_sam), "s")


def fused_fps(run):
    return run["live"]["frames_fused"] / (run["live"]["camera_seconds"] + 1 / run["live"]["camera_fps"])


def seconds_between_masks(run):
    return run["live"]["camera_seconds"] / max(run["live"]["mask_frames"], 1)


def live_line(name, run):
    live = run["live"]
    lag = live["geometry_lag"]
    masks = f"; masks on {live['mask_frames']} frames, in the map after {live['mask_lag']['p50_ms'] / 1e3:.1f} s" if live["mask_frames"] else ""
    return (f"- {name}: {live['frames_fused']} frames fused, {live['frames_dropped']} dropped, in the map after "
            f"{lag['p50_ms']:.0f} ms (p95 {lag['p95_ms']:.0f}, p99 {lag['p99_ms']:.0f}){masks}; "
            f"{live['views_skipped']} looks at objects left out.")


def open3d_lines(open3d):
    if not open3d:
        return ["Open3D is not installed here, so nothing is compared with it: `make rivals` installs it.", ""]
    return [f"Beside Open3D {open3d['open3d']} (VoxelBlockGrid on the same frames, frame by frame in turn, medians of {open3d['frames']}): "
            f"association and fusion {open3d['ours_fuse']:.1f} ms against {open3d['theirs_fuse']:.1f} ms, which knows no labels; "
            f"ray cast {open3d['ours_cast']:.1f} ms (guided by depth {open3d['ours_guided']:.1f} ms) against {open3d['theirs_cast']:.1f} ms. "
            f"The two surfaces lie {open3d['gap_median_mm']:.1f} mm apart in the median, {open3d['gap_p95_mm']:.1f} mm at 95 %. "
            f"OpenCV {open3d['opencv']} in the same turns (`cv2.Volume` of kind HashTSDF, distances alone, neither colour nor labels): fusion {open3d['opencv_fuse']:.1f} ms, ray cast {open3d['opencv_cast']:.1f} ms, "
            f"which lies {open3d['opencv_error_mm']:.1f} mm from the depth images in the median.", "",
            f"The targets in milliseconds were set for a machine on which Open3D took {TARGET_FUSE_MS} ms to allocate and integrate and "
            f"{TARGET_CAST_MS} ms to cast rays. This one took {open3d['theirs_fuse'] / TARGET_FUSE_MS:.2f} and "
            f"{open3d['theirs_cast'] / TARGET_CAST_MS:.2f} times as long. The column 'scaled' divides times by the geometric mean of both, "
            f"{slowness_of(open3d):.2f}, and 'met' judges that column where it has a figure.", ""]


def bench_in_turns(program, recording):
    """The run in the middle of them all, by the processor time of a frame; what `--track` adds to one; the least and the most.

    With and without poses in turn: on a machine shared with others a single run is up to one half off."""
    pairs = [(run_json(program, "bench", recording), run_json(program, "bench", recording, "--track")) for _ in range(TURNS)]
    runs = sorted((bench for bench, _ in pairs), key=cpu_ms)
    tracking_ms = statistics.median(cpu_ms(tracked) - cpu_ms(bench) for bench, tracked in pairs)
    return runs[len(runs) // 2], tracking_ms, (cpu_ms(runs[0]), cpu_ms(runs[-1]))


def cpu_ms(bench):
    return bench["cpu_ms_per_frame"]


def speed_lines(program, recording, rivals=RIVALS, networks=True):
    bench, tracking_ms, (least, most) = bench_in_turns(program, recording)
    sam = live_sam = None
    if networks:
        sam = run_json(program, "bench", recording, "--masks", "sam", "--encoder", "none", "--frames", "::10", "--set", "mask_interval=1")
        live_sam = measure_live(program, recording, "--masks", "sam")
    live = measure_live(program, recording)
    open3d = measure_open3d(program, recording, rivals)
    lines = [f"{bench['frames']} frames, 1 cm voxels. {cpu_ms(bench):.0f} ms of processor time a frame, decoding included: of {TURNS} runs the one in the middle ({least:.0f} to {most:.0f} ms), each in turn with one that finds the poses.", "",
             "| what | target | measured | scaled | met |", "| --- " * 5 + "|", *target_rows(bench, tracking_ms, sam, live, live_sam, open3d), "",
             *open3d_lines(open3d), live_line("Live, depth alone", live)]
    if live_sam:
        lines.append(live_line("Live with MobileSAM and the default encoder", live_sam))
    lines += ["", "Every stage, depth alone. The next frame is prepared (`registration`, `surface`, `estimate`, `free_depth`) while one is fused, so these share the cores with the others and take longer by the clock than alone; so does depth segmentation (`surface` and `regions`) in the table's first row.", "", "| stage | p50 ms | p95 ms | p99 ms | count |", "| --- | --- | --- | --- | --- |"]
    for name, stage in bench["stages"].items():
        lines.append(f"| {name} | {stage['p50_ms']:.1f} | {stage['p95_ms']:.1f} | {stage['p99_ms']:.1f} | {stage['count']} |")
    return [*lines, ""]


def stage_ratio(walk, name):
    old, young = (walk[map_age]["stages"].get(name, {"total_ms": 0})["total_ms"] for map_age in ("old", "young"))
    return old / young if young else math.inf


def walk_corridor(program, *options):
    return run_json(program, "bench", "--corridor", CORRIDOR_FRAMES, "--masks", "gt", *options)


def growth_line(walk):
    """What history costs: the same frames in turn, in the map of the walk and in one that begins there."""
    return f"{walk['growth']:.2f} times the processor time, {walk['old']['cpu_ms']:.1f} ms against {walk['young']['cpu_ms']:.1f}"


def corridor_lines(program):
    walks = sorted((walk_corridor(program) for _ in range(3)), key=lambda walk: walk["growth"])
    tracked = walk_corridor(program, "--track")
    again = walk_corridor(program, "--again")["again"]["parts"]
    walk = walks[1]
    first, last, old, young = walk["parts"][0], walk["parts"][-1], walk["old"], walk["young"]
    lines = [f"A generated corridor with boxes along its walls and on them, true masks of every frame, 320x240, 4 cm voxels. After the walk come as many frames as a tenth of it, each mapped twice, in turn: in the map of the walk and in one "
             f"that begins there, so that both have the machine in the same minutes. In the old map a frame takes {growth_line(walk)} (median of three walks, {walks[0]['growth']:.2f} to {walks[2]['growth']:.2f}; target <= 1.1) "
             f"and touches {old['blocks_touched'] / young['blocks_touched']:.3f} times as many blocks; "
             f"{last['map_mb'] / last['surface_m2']:.3f} MB a square metre of surface at the end, "
             f"{first['map_mb'] / first['surface_m2']:.3f} at first; peak memory of the walk {walk['peak_rss_mb']:.0f} MB.", "",
             "| frames | frame p50 ms | p95 ms | processor ms | projection ms | blocks touched | map MB | surface, m2 | objects |", "| --- " * 9 + "|"]
    for part in walk["parts"]:
        frame = part["stages"]["frame"]
        lines.append(f"| {part['frames']} | {frame['p50_ms']:.2f} | {frame['p95_ms']:.2f} | {part['cpu_ms']:.2f} | {part['stages']['projection']['p50_ms']:.2f} "
                     f"| {part['blocks_touched']:.0f} | {part['map_mb']:.0f} | {part['surface_m2']:.0f} | {part['objects']} |")
    lines += ["", f"The same with poses found (`--track`, one walk): {growth_line(tracked)}; "
              f"lost in {sum(part['frames_lost'] for part in tracked['parts'])} frames, which look for their place, {tracked['parts'][0]['frames_lost']} of the first tenth and {tracked['parts'][-1]['frames_lost']} of the last; peak memory {tracked['peak_rss_mb']:.0f} MB. "
              f"Walked once more, as another visit of the whole map (`--again`): the last tenth takes {again[-1]['cpu_ms'] / again[0]['cpu_ms']:.2f} times the first, {again[0]['cpu_ms']:.1f} ms at first, {again[-1]['cpu_ms']:.1f} at the end. Under a bound on memory: \"What a map that lasts costs\".",
              "", "A frame's stages, milliseconds by the clock (`masks` computes the true ones), in the two maps after the walk in the middle; the ratio is the median of the three walks.", "",
              "| stage | begun there | map of the walk | ratio |", "| --- | --- | --- | --- |"]
    per_frame = CORRIDOR_FRAMES / len(walk["parts"])
    for name, stage in young["stages"].items():
        begin, end = stage["total_ms"] / per_frame, old["stages"].get(name, {"total_ms": 0})["total_ms"] / per_frame
        if max(begin, end) >= 0.01:
            lines.append(f"| {name} | {begin:.2f} | {end:.2f} | {statistics.median(stage_ratio(each, name) for each in walks):.2f} |")
    return [*lines, ""]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("--rivals", type=pathlib.Path, default=RIVALS)
    arguments = parser.parse_args()
    print(f"{os.cpu_count()} threads")
    print("\n".join(speed_lines(arguments.program.resolve(), arguments.recording, arguments.rivals)))


if __name__ == "__main__":
    main()
