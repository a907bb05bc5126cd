#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The programs of examples/ do what docs/cpp.md says of them. Usage: cpp_examples_test.py PROGRAM FOLDER, with the examples in it."""
import pathlib
import re
import subprocess
import sys
import tempfile


def output(*command, code=0):
    ended = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    assert ended.returncode == code, f"{command}: exit code {ended.returncode}\n{ended.stderr}"
    return ended.stdout or ended.stderr


def main(program, folder):
    examples = {name: pathlib.Path(folder) / f"example_{name}" for name in ("map_my_folder", "map_live", "read_a_map")}
    with tempfile.TemporaryDirectory() as scratch:
        place = pathlib.Path(scratch)
        output(program, "synth", place, "--room", "tiny", "--frames", "8", "--size", "320x240")
        for name in ("map_my_folder", "map_live"):
            made = place / f"{name}.ovimap"
            said = output(examples[name], place / "room", made)
            assert re.search(r"[1-9][0-9]* objects", said), said
            output(program, "info", "--check", made)
        assert output(examples["read_a_map"], place / "map_my_folder.ovimap").strip()
        for name, example in examples.items():
            assert f"usage: {name}" in output(example, code=2)
            assert "nowhere" in output(example, place / "nowhere", *([place / "b.ovimap"] if name != "read_a_map" else []), code=2)
    print("the three examples do what they say")


if __name__ == "__main__":
    main(*sys.argv[1:])
