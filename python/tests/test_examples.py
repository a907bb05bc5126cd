# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Every example runs and says something true."""
import pathlib
import re
import shutil
import subprocess
import sys

import ovimap
import pytest

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def short(room, tmp_path_factory):
    """The first frames of the room."""
    root = tmp_path_factory.mktemp("short")
    (root / "room/results").mkdir(parents=True)
    shutil.copy(f"{room}/../cam_params.json", root)
    lines = (pathlib.Path(room) / "traj.txt").read_text().splitlines(keepends=True)
    (root / "room/traj.txt").write_text("".join(lines[:12]))
    for kind in ("frame", "depth"):
        for file in sorted((pathlib.Path(room) / "results").glob(f"{kind}*"))[:12]:
            (root / "room/results" / file.name).symlink_to(file)
    return root / "room"


def run(name, *arguments):
    done = subprocess.run([sys.executable, EXAMPLES / name, *arguments], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("name", ["map_my_folder.py", "map_live.py"])
def test_mapping_examples_save_what_they_say(name, short, tmp_path):
    said = run(name, short, tmp_path / "a.ovimap")
    made = ovimap.Map.open(tmp_path / "a.ovimap")
    assert said.startswith(f"{len(made)} objects from 12 frames") and made.frames == 12


def test_reading_lists_every_object(saved_map):
    assert len(re.findall(r"^object \d+ at ", run("read_a_map.py", saved_map), re.M)) == len(ovimap.Map.open(saved_map))


def test_own_models_make_a_map_that_answers(short, tmp_path):
    assert re.fullmatch(r"the bluest object is \d+\n", run("my_own_models.py", short, tmp_path / "a.ovimap"))


def test_every_example_is_tested():
    here = pathlib.Path(__file__).parent
    text = "".join(file.read_text() for file in [*here.glob("test_*.py"), here.parents[1] / "tests/overnight_test.py"])
    assert all(file.name in text for file in EXAMPLES.glob("*.py"))
