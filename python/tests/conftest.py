# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What the tests share. OVIMAP_TEST_ROOM, OVIMAP_TEST_MAP: a rendered room and its map, else one is made."""
import contextlib
import os
import pathlib
import sqlite3
import struct

import numpy as np
import ovimap
import pytest

SKIPPED = 77  # what ctest takes for "skipped"


@pytest.fixture(scope="session")
def room(tmp_path_factory):
    """A recording of a small rendered room."""
    given = os.environ.get("OVIMAP_TEST_ROOM", "")
    return given if os.path.isdir(given) else ovimap.synth(tmp_path_factory.mktemp("room"))


@pytest.fixture(scope="session")
def kitchen():
    """The recorded kitchen."""
    folder = pathlib.Path(os.environ.get("OVIMAP_DATA_DIR", "")) / "kitchen"
    if "OVIMAP_DATA_DIR" not in os.environ or not folder.is_dir():
        pytest.skip("the kitchen recording is not there; set OVIMAP_DATA_DIR to the folder that holds it")
    return folder


@pytest.fixture(scope="session")
def home_map():
    """A map of two visits, 14 and 16 March 2026."""
    given = os.environ.get("OVIMAP_TEST_HOME", "")
    if not os.path.isfile(given):
        pytest.skip("there is no map of two visits; run the test viewer_map first")
    return given


@pytest.fixture(scope="session")
def saved_map(room, tmp_path_factory):
    """A map with embeddings."""
    given = os.environ.get("OVIMAP_TEST_MAP", "")
    if os.path.isfile(given):
        return given
    path = tmp_path_factory.mktemp("map") / "room.ovimap"
    try:
        ovimap.run(room, path, masks="gt", frames="::4")
    except ovimap.Error as error:
        if "default-encoder" not in str(error):
            raise
        pytest.skip("the default encoder is missing; run tools/setup.sh")
    return str(path)


@pytest.fixture
def camera():
    return ovimap.PinholeCamera(width=64, height=48, fx=60, fy=60, cx=31.5, cy=23.5)


def wall(camera, index, depth_m=2.0, **options):
    """A frame of a wall, seen a little from the side each time."""
    pose = np.eye(4)
    pose[0, 3] = 0.01 * index
    color = np.full((camera.height, camera.width, 3), 128, np.uint8)
    depth = np.full((camera.height, camera.width), depth_m, np.float32)
    return ovimap.Frame(color, depth, pose, camera, **options)


def set_meta(path, key, value):
    """Makes a map say something else of itself, with the check that fits (docs/map-format.md)."""
    xxhash = pytest.importorskip("xxhash")

    def text(word):
        return b"t" + struct.pack("<q", len(word.encode())) + word.encode()

    with contextlib.closing(sqlite3.connect(path)) as file, file:
        file.execute("UPDATE meta SET value = ? WHERE key = ?", (value, key))
        total = sum(xxhash.xxh64_intdigest(text(name) + text(said)) for name, said in file.execute("SELECT key, value FROM meta"))
        [signed] = struct.unpack("<q", struct.pack("<Q", total % 2**64))
        file.execute("UPDATE checks SET hash = ? WHERE name = 'meta'", (signed,))


def pytest_sessionfinish(session, exitstatus):
    """A file whose tests were all skipped is skipped for ctest too."""
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if exitstatus == 0 and reporter and reporter.stats.get("skipped") and not reporter.stats.get("passed"):
        session.exitstatus = SKIPPED


def pytest_unconfigure(config):
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    for report in (reporter.stats.get("skipped", []) if reporter else [])[:1]:
        print(report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr)
