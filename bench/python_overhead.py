#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""How much longer a Python loop maps than the program, and how long a saved map takes to answer.

Usage: python_overhead.py PROGRAM RECORDING [--rounds 5] [--map MAP]
Both map the same frames with depth alone, turn about; compared are the medians of the seconds from opening the recording
to the saved map, as the process spent them. PYTHONPATH must lead to the package."""
import argparse
import json
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile
import time

LOOP = """
import sys, ovimap
mapper = ovimap.Mapper()
for frame in ovimap.open_source(sys.argv[1]):
    mapper.process(frame)
mapper.save(sys.argv[2])
"""
ANSWER = """
import sys, time, ovimap
start = time.perf_counter()
opened = ovimap.Map.open(sys.argv[1])
opened_ms = 1e3 * (time.perf_counter() - start)
first = opened.query("chair")
first_ms = 1e3 * (time.perf_counter() - start) - opened_ms
again = time.perf_counter()
opened.query("lamp")
print(opened_ms, first_ms, 1e3 * (time.perf_counter() - again))
"""


def seconds(command):
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - start


def measure_mapping(program, recording, rounds):
    with tempfile.TemporaryDirectory() as folder:
        maps = [str(pathlib.Path(folder) / f"{name}.ovimap") for name in ("program", "python")]
        # The program also writes checkpoints; the loop does not, so they are turned off.
        quiet = ["--set", "checkpoint.seconds=0"]
        commands = [
            [program, "run", recording, "-o", maps[0], *quiet],
            [sys.executable, "-c", LOOP, recording, maps[1]],
        ]
        times = [[], []]
        for i in range(rounds + 1):  # the first round warms the disk's cache
            for taken, command, path in zip(times, commands, maps):
                pathlib.Path(path).unlink(missing_ok=True)
                taken.append(seconds(command))
        hashes = [json.loads(subprocess.check_output([program, "info", path, "--json"]))["content_hash"] for path in maps]
    program_s, python_s = (statistics.median(taken[1:]) for taken in times)
    return {
        "program_seconds": program_s,
        "python_seconds": python_s,
        "overhead_percent": 100 * (python_s / program_s - 1),
        "same_map": hashes[0] == hashes[1],
    }


def measure_answers(path, rounds):
    runs = [[float(word) for word in subprocess.check_output([sys.executable, "-c", ANSWER, path]).split()] for _ in range(rounds)]
    names = ("open_ms", "first_query_ms", "next_query_ms")
    return dict(zip(names, (statistics.median(column) for column in zip(*runs))))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("recording")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--map", help="a map with embeddings, to ask questions of")
    options = parser.parse_args()
    import ovimap

    result = {"machine": platform.processor() or platform.machine(), "commit": ovimap.commit(), "rounds": options.rounds}
    result |= measure_mapping(options.program, options.recording, options.rounds)
    if options.map:
        result |= measure_answers(options.map, options.rounds)
    print(json.dumps(result, indent=2))


if __name__ == "__main__":
    main()
