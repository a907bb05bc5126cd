# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What it costs that a map lasts: checkpoints, saving, opening, resuming, a bound on memory. Part of tools/benchmarks.py."""
import pathlib
import tempfile

from speed import CORRIDOR_FRAMES, growth_line, run_json, walk_corridor

BOUND = "100M"  # the kitchen's voxels take more
CORRIDOR_BOUND = "150M"


def stage_row(what, stages, name):
    stage = stages[name]
    return f"| {what} | {stage['p50_ms']:.1f} | {stage['p95_ms']:.1f} | {stage['p99_ms']:.1f} | {stage['count']} |"


def checkpoint_lines(program, recording):
    with tempfile.TemporaryDirectory() as folder:
        run = run_json(program, "run", recording, "--masks", "none", "--encoder", "none", "--set", "checkpoint.frames=5",
                       "-o", pathlib.Path(folder) / "map.ovimap")
    stages = run["stages"]
    worst = max(stages[name]["p99_ms"] for name in ("checkpoint", "checkpoint_end") if name in stages)
    yield from ["A checkpoint after every fifth frame, in milliseconds for which mapping waits:", "",
                "| what | p50 | p95 | p99 | times |", "| --- " * 5 + "|",
                stage_row("its beginning, which copies what changed", stages, "checkpoint")]
    if "checkpoint_end" in stages:
        yield stage_row("its end, once the file has it", stages, "checkpoint_end")
    yield from ["", "| what | target | measured | met |", "| --- " * 4 + "|", f"| longest wait (p99) | <= 20 ms | {worst:.1f} ms | {'yes' if worst <= 20 else 'no'} |", ""]


def file_lines(program, recording):
    yield from ["One recording at two voxel sizes, depth alone:", "",
                "| voxels | file MB | save ms | MB/s | open for queries ms (target <= 50) | go on with it (resume) ms |", "| --- " * 6 + "|"]
    for size in ("0.01", "0.005"):
        bench = run_json(program, "bench", recording, "--set", f"map.voxel_size_m={size}")
        ms = {name: bench["stages"][name]["p50_ms"] for name in ("save", "open_for_queries", "resume")}
        megabytes = bench["map_bytes"] / 1e6
        yield (f"| {100 * float(size):.1f} cm | {megabytes:.1f} | {ms['save']:.0f} | {megabytes / ms['save'] * 1e3:.0f} "
               f"| {ms['open_for_queries']:.1f} | {ms['resume']:.0f} |")
    yield ""


def bound_lines(program, recording):
    free, bound = (run_json(program, "bench", recording, *options) for options in ([], ["--max-memory", BOUND]))
    yield from [f"The same with `--max-memory {BOUND}`: {bound['fps']:.1f} frames a second against {free['fps']:.1f}, "
                f"peak memory {bound['peak_rss_mb']:.0f} MB against {free['peak_rss_mb']:.0f} MB.", "",
                "| a tile | p50 ms | p95 ms | p99 ms | times |", "| --- " * 5 + "|"]
    for what, name in (("leaves memory", "evict_tile"), ("comes back", "load_tile")):
        if name in bound["stages"]:
            yield stage_row(what, bound["stages"], name)
    yield ""


def corridor_lines(program):
    bound = walk_corridor(program, "--max-memory", CORRIDOR_BOUND)
    yield (f"The corridor of {CORRIDOR_FRAMES} frames with true masks under `--max-memory {CORRIDOR_BOUND}`: at the end of the walk a frame takes {growth_line(bound)} in a map that begins there; "
           f"peak memory {bound['peak_rss_mb']:.0f} MB; {bound['stages']['evict_tile']['count']} tiles left memory.")


def lasting_lines(program, recording):
    return [*checkpoint_lines(program, recording), *file_lines(program, recording), *bound_lines(program, recording),
            *corridor_lines(program), ""]
