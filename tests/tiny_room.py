# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The program and a map that it made, for tests that read what it writes. The test's first argument is the program."""
import json
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = sys.argv.pop(1)


def ovimap(*arguments, code=0):
    result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if result.returncode != code:
        raise AssertionError(f"{arguments}: exit code {result.returncode}, {result.stderr}")
    return result.stdout or result.stderr


class TinyRoom:
    """A folder with a rendered room of some frames, and its map from true masks; removed by close()."""

    def __init__(self, frames, voxel_size_m):
        self._scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self._scratch.name)
        self.map = self.folder / "room.ovimap"
        ovimap("synth", self.folder / "synth", "--room", "tiny", "--frames", frames)
        ovimap("run", self.folder / "synth/room", "--masks", "gt", "--encoder", "none", "-o", self.map,
               "--set", f"map.voxel_size_m={voxel_size_m}")
        self.info = json.loads(ovimap("info", self.map, "--json"))

    def close(self):
        self._scratch.cleanup()
