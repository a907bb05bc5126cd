# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A server that takes frames, and a recording's frames to send to it."""
import json
import os
import pathlib
import signal
import subprocess

import numpy as np
import ovimap
import pytest

PROGRAM = os.environ.get("OVIMAP_PROGRAM")
FRAMES = 12


class Serving:
    """`ovimap serve --live http`, until the block ends."""

    def __init__(self, out, *options, errors=None):
        self.process = subprocess.Popen([PROGRAM, "serve", "http", "--live", "-o", out, "--port", "0", "--viewer", "none", "--json", *options],
                                        stdout=subprocess.PIPE, stderr=errors, text=True)  # fmt: skip
        self.address = json.loads(self.process.stdout.readline())["address"]

    def __enter__(self):
        return self

    def saved(self):
        return json.loads(self.process.stdout.readline())["saved"]

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        assert self.process.wait(timeout=60) in (0, 2)
        self.process.stdout.close()


def figures(camera, **more):
    return dict(width=camera.width, height=camera.height, fx=camera.fx, fy=camera.fy, cx=camera.cx, cy=camera.cy, **more)


def hash_of(path):
    info = subprocess.run([PROGRAM, "info", path, "--json"], check=True, capture_output=True, text=True)
    return json.loads(info.stdout)["content_hash"]


needs_program = pytest.mark.skipif(not PROGRAM, reason="the program was not built; set OVIMAP_PROGRAM")


class Shots:
    """The files of a recording's first frames, as a camera's driver would have them."""

    def __init__(self, room):
        self.frames = list(ovimap.open_source(room).frames(f":{FRAMES}"))
        folder = pathlib.Path(room)
        scale = json.loads((folder.parent / "cam_params.json").read_text())["camera"]["scale"]
        self.camera = figures(self.frames[0].camera, depth_scale=scale)
        files = [sorted((folder / "results").glob(f"{kind}*")) for kind in ("frame", "depth")]
        self.files = [(color.read_bytes(), depth.read_bytes()) for color, depth in zip(*files)]
        self.poses = [np.array(line.split(), np.float64).reshape(4, 4) for line in (folder / "traj.txt").read_text().splitlines()]

    def send(self, sender, chosen):
        for i in chosen:
            assert sender.send(*self.files[i], self.poses[i], self.frames[i].timestamp_s, patience_s=60)
