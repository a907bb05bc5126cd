# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""ovimap-camera openni, with the real library and the software camera of tests/openni."""
import json
import os
import struct
import subprocess
import sys

import numpy as np
import ovimap
import pytest

LIBRARY = os.environ.get("OVIMAP_OPENNI_FOLDER", "")
pytestmark = pytest.mark.skipif(not os.path.isdir(LIBRARY), reason="OpenNI 2 was not there when this was built (libopenni2-dev)")

WIDTH, HEIGHT, FPS, FRAMES = 64, 48, 10, 12


def picture(number):
    """Its middle tells left from right, and frames apart."""
    v, u = np.mgrid[:HEIGHT, :WIDTH]
    color = np.stack([3 * u, 4 * v, np.full_like(u, 10 * number)], -1).astype(np.uint8)
    return color, (1000 + 10 * u + v + 100 * number).astype(np.uint16)


def write_film(file, unit_um=1000):
    """As tests/openni/camera_film.h reads it."""
    with file.open("wb") as film:
        film.write(struct.pack("<5i2f", WIDTH, HEIGHT, FPS, unit_um, FRAMES, 1.0, 0.8))
        for number in range(FRAMES):
            color, depth = picture(number)
            film.write(struct.pack("<Q", 1_000_000 + 100_000 * number) + depth.tobytes() + color.tobytes())


def camera_command(*arguments, film=None):
    environment = {**os.environ, "LD_LIBRARY_PATH": LIBRARY, **({"OVIMAP_CAMERA_FILM": str(film)} if film else {})}
    command = [sys.executable, "-m", "ovimap.camera_command", "openni", *map(str, arguments)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)


def test_what_the_camera_shows_is_recorded_as_it_is(tmp_path):
    write_film(tmp_path / "film")
    folder = tmp_path / "recording"
    done = camera_command("--folder", folder, "--wait-s", 0, "--json", film=tmp_path / "film")
    assert done.returncode == 1, done.stderr
    assert "ovimap software camera was unplugged" in done.stderr
    said = json.loads(done.stdout)
    assert said["camera"] == "ovimap software camera" and said["taken"] >= FRAMES - 4 and said["refused"] == 0
    camera = json.loads((folder / "camera.yaml").read_text().splitlines()[0].partition(": ")[2])
    assert camera["fx"] == pytest.approx(WIDTH / 2 / np.tan(0.5), rel=1e-6) and camera["cy"] == (HEIGHT - 1) / 2
    for file in (folder / "depth").iterdir():
        number = round((float(file.stem) - 1) * 10)
        assert np.array_equal(ovimap.decode_gray_png(file.read_bytes()), picture(number)[1])


def test_faults_are_one_line_each(tmp_path):
    absent = camera_command("--folder", tmp_path / "a")
    assert (absent.returncode, absent.stderr.count("\n")) == (2, 1) and "no OpenNI camera is plugged in" in absent.stderr
    file = camera_command("--file", "room.oni", "--folder", tmp_path / "a")
    assert (file.returncode, file.stderr.count("\n")) == (2, 1) and "give it the .oni file" in file.stderr
    size = camera_command("--size", "320x240", "--folder", tmp_path / "a")
    assert (size.returncode, size.stderr.count("\n")) == (2, 1) and "leave --size" in size.stderr
