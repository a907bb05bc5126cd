#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the example that each command's --help ends with, where `ovimap demo` was run before, as a user would.

Usage: examples_test.py PROGRAM
"""
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

NOT_AVAILABLE = 77
# These do not end by themselves, or need the data of others: the tests named here run them.
ELSEWHERE = {"serve": "serve_program_test.cpp", "reproduce": "reproduce_program_test.cpp"}


class Place:
    """A folder with what the examples speak of."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, *arguments):
        return subprocess.run([self.program, *arguments], cwd=self.folder, capture_output=True, text=True)

    def prepare(self):
        made = self.run("demo", "--masks", "gt")  # a network's masks: tutorial_test.py
        assert made.returncode == 0, made.stderr
        for name in ("monday", "friday", "upstairs", "downstairs"):
            shutil.copy(self.folder / "demo/tiny.ovimap", self.folder / f"{name}.ovimap")

    def prepare_correction(self):
        """A map that keeps its frames, and poses for them: its own."""
        room = self.folder / "demo/tiny/room"
        made = self.run("run", str(room), "--set", "frame_store.max_mb=100", "-o", "room.ovimap")
        assert made.returncode == 0, made.stderr
        (self.folder / "better.txt").write_text((room / "traj.txt").read_text())

    def prepare_visits(self):
        """A map of two visits to one room, and the truth of both."""
        for made in (self.run("synth", "rooms", "--room", "tiny", "--visits", "2", "--frames", "24", "--size", "160x120"),
                     self.run("run", "rooms/visit1", "--masks", "gt", "--encoder", "none", "-o", "home.ovimap"),
                     self.run("run", "rooms/visit2", "--masks", "gt", "--encoder", "none", "--continue", "home.ovimap")):  # fmt: skip
            assert made.returncode == 0, made.stderr

    def fault_of(self, example):
        if example[0] == "correct":
            self.prepare_correction()
        if example[0] == "eval-changes":
            self.prepare_visits()
        if example[0] == "eval-poses":
            self.run("run", "demo/tiny/room", "--trajectory", "tracked.txt", "-o", "tracked.ovimap")
        begin = time.monotonic()
        ended = self.run(*example)
        print(f"{time.monotonic() - begin:6.1f} s  {shlex.join(example)}", flush=True)
        text = ended.stdout + ended.stderr
        return "" if ended.returncode in (0, 1) and ended.stdout.strip() else f"{shlex.join(example)}: exit code {ended.returncode}\n{text[-2000:]}"


def example_of(help_text):
    """Arguments of the example, which may go over several lines."""
    text = help_text.rpartition("Example")[2].replace("\\\n", " ")
    found = re.search(r"^\s+ovimap (.*)$", text, re.MULTILINE)
    return shlex.split(found[1]) if found else []


def main(program):
    with tempfile.TemporaryDirectory() as scratch:
        place = Place(str(pathlib.Path(program).resolve()), pathlib.Path(scratch))
        if not any("mobilesam" in line for line in place.run("models", "list").stdout.splitlines()):
            print("the models are not installed; run tools/setup.sh")
            return NOT_AVAILABLE
        place.prepare()
        faults = []
        manual = place.run("manual", "share")
        names = sorted(page.name[7:-2] for page in (place.folder / "share/man/man1").glob("ovimap-*.1"))
        assert len(names) > 20, manual.stderr
        for name in names:
            example = example_of(place.run(name, "--help").stdout)
            if not example or example[0] != name:
                faults.append(f"{name}: --help gives no example")
            elif name == "demo":
                pass  # it made what the others use
            elif name in ELSEWHERE:
                here = pathlib.Path(__file__).parent / ELSEWHERE[name]
                assert f'"{name} ' in here.read_text() or f"{name} " in here.read_text(), here
            else:
                faults.append(place.fault_of(example))
        shell = subprocess.run(["bash", "-c", 'source share/bash-completion/completions/ovimap; COMP_WORDS=(ovimap query --to) COMP_CWORD=2; _ovimap ovimap --to; echo "$COMPREPLY"'],
                               cwd=place.folder, capture_output=True, text=True)  # fmt: skip
        faults.append("" if shell.stdout.strip() == "--top" else f"bash completes '--to' to '{shell.stdout}{shell.stderr}'")
    faults = [fault for fault in faults if fault]
    print("\n".join(faults) or f"examples of {len(names)} commands ran")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
