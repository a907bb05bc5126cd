#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The program runs on any x86-64 processor, and makes the same map there as with AVX2 or AVX-512.

qemu stands for a processor without SSSE3, SSE4 and AVX, and for one with AVX2; this machine for whatever it has. Where the default
encoder is installed, ONNX Runtime is tried as well. Usage: old_processor_test.py PROGRAM
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

NOT_AVAILABLE = 77
OLD, NEW = ("qemu-x86_64", "-cpu", "qemu64"), ("qemu-x86_64", "-cpu", "max")


def output(*command):
    ended = subprocess.run(command, capture_output=True, text=True)
    assert ended.returncode == 0, f"{' '.join(command)}: exit code {ended.returncode}\n{ended.stderr[-2000:]}"
    return ended.stdout


def content_of_map(run, program, room, folder):
    made = str(folder / "made.ovimap")
    output(*run, program, "run", room, "--masks", "none", "--encoder", "none", "--frames", ":3", "-o", made)
    return json.loads(output(program, "info", "--json", made))["content_hash"]


def compare_words(program, room):
    """Similarities of a picture and two texts, which processors may round differently."""
    words = [program, "models", "try", "default-encoder", str(next(pathlib.Path(room, "results").glob("*.jpg"))), "sofa", "lamp", "--json"]
    here, old = (json.loads(output(*run, *words)) for run in ((), OLD))
    for mine, other in zip(here["texts"], old["texts"], strict=True):
        assert abs(mine["cosine"] - other["cosine"]) < 1e-3, (mine["text"], mine["cosine"], other["cosine"])


def main(program):
    if shutil.which(OLD[0]) is None:
        print("qemu-x86_64 is missing; run: apt-get install qemu-user")
        return NOT_AVAILABLE
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        output(*OLD, program, "synth", str(folder / "old"), "--room", "tiny", "--frames", "1", "--size", "64x48")  # Embree
        output(program, "synth", scratch, "--room", "tiny", "--frames", "3", "--size", "320x240")
        room = str(folder / "room")
        contents = {name: content_of_map(run, program, room, folder) for name, run in (("here", ()), ("old", OLD), ("AVX2", NEW))}
        assert len(set(contents.values())) == 1, contents
        print(f"one map on three processors: {contents['here']}")
        if "default-encoder" in output(program, "models", "list"):
            compare_words(program, room)
            print("and the same words")
        else:
            print("ONNX Runtime was not tried: the default encoder is not installed")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
