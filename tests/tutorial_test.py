#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of docs/tutorial.md in their order, where `ovimap demo` was run before, as a reader would.

Usage: tutorial_test.py PROGRAM    PYTHONPATH holds the Python package and python/tests
"""
import json
import os
import pathlib
import shlex
import signal
import subprocess
import sys
import tempfile
import time
import urllib.request

PAGE = pathlib.Path(__file__).parent.parent / "docs/tutorial.md"
TOOLS = {"ovimap-bag": "ovimap.bags", "ovimap-camera": "ovimap.camera_command"}
# A camera must be there: the Python package's tests run this with one that RealSense's library plays.
WITHOUT_CAMERA = {"ovimap-camera realsense": "RealSense"}


def commands():
    """Indented lines that call a program of ours, without their remarks."""
    for line in PAGE.read_text().splitlines():
        if line.startswith("    ovimap"):
            yield line.split("   #")[0].strip()


def record_bag(room, bag):
    """The recording as a robot would have recorded it."""
    import numpy as np
    import ovimap
    from bag_fixture import Shot, record

    frames = list(ovimap.open_source(room).frames("::4"))
    shots = [Shot(np.asarray(frame.color), np.asarray(frame.depth), np.asarray(frame.world_from_camera)) for frame in frames]
    record(bag, shots, frames[0].camera)


class Reader:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def number(self):
        """What section 4 answered with, whichever number that object got."""
        asked = self.run('ovimap query room.ovimap "sofa" --json')
        return str(json.loads(asked.stdout)["results"][0]["instances"][0]["id"])

    def words(self, command):
        name, *arguments = shlex.split(command)
        arguments = [self.number() if argument == "NUMBER" else argument for argument in arguments]
        return [*([self.program] if name == "ovimap" else [sys.executable, "-m", TOOLS[name]]), *arguments]

    def run(self, command):
        return subprocess.run(self.words(command), cwd=self.folder, capture_output=True, text=True)

    def serve(self, command):
        """Until it answers; then Ctrl-C, as the page says."""
        process = subprocess.Popen([*self.words(command), "--port", "0", "--json"], cwd=self.folder, stdout=subprocess.PIPE, text=True)
        try:
            address = json.loads(process.stdout.readline())["address"]
            with urllib.request.urlopen(address + "api/map") as answer:
                assert json.loads(answer.read())["program"]
        finally:
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)

    def fault_of(self, command):
        if command.split()[1] == "serve":
            self.serve(command)
            return ""
        ended = self.run(command)
        if command in WITHOUT_CAMERA:
            return "" if WITHOUT_CAMERA[command] in ended.stderr else f"{command}: {ended.stderr}"
        fine = ended.returncode in (0, 1) and (ended.stdout + ended.stderr).strip()
        return "" if fine else f"{command}: exit code {ended.returncode}\n{(ended.stdout + ended.stderr)[-2000:]}"


def main(program):
    with tempfile.TemporaryDirectory() as scratch:
        reader = Reader(str(pathlib.Path(program).resolve()), pathlib.Path(scratch))
        made = reader.run("ovimap synth demo/tiny --room tiny")
        assert made.returncode == 0, made.stderr
        record_bag(reader.folder / "demo/tiny/room", reader.folder / "walk.mcap")
        ran = list(commands())
        assert len(ran) > 12, "the page's commands were not found"
        faults = []
        for command in ran:
            begin = time.monotonic()
            faults.append(reader.fault_of(command))
            print(f"{time.monotonic() - begin:6.1f} s  {command}", flush=True)
    faults = [fault for fault in faults if fault]
    print("\n".join(faults) or f"{len(ran)} commands ran")
    return 1 if faults else 0


if __name__ == "__main__":
    os.environ.setdefault("PYTHONDONTWRITEBYTECODE", "1")
    sys.exit(main(sys.argv[1]))
