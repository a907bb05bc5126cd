# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The type stubs: complete, and mypy takes what is right and refuses what is wrong."""
import pathlib
import subprocess
import sys

import ovimap
import pytest

RIGHT = """
import numpy as np
import numpy.typing as npt
import ovimap

def ids(frame: ovimap.Frame, prompts: list[ovimap.MaskPrompt]) -> npt.NDArray[np.uint16]:
    return np.zeros(frame.color.shape[:2], np.uint16)

camera = ovimap.PinholeCamera(64, 48, 60, 60, 31.5, 23.5)
frame = ovimap.Frame(np.zeros((48, 64, 3), np.uint8), np.ones((48, 64)), np.eye(4), camera, index=3)
mapper = ovimap.Mapper(ids, settings={"map.voxel_size_m": 0.02})
regions: int = mapper.process(frame).regions
count: int = mapper.save("a.ovimap")
for read in ovimap.open_source("room").frames("::2"):
    name: str = read.name
answer: ovimap.QueryAnswer = ovimap.Map.open("a.ovimap").query("mug", negatives=["cup"])
probability: float | None = answer.matches[0].probability
vertices: npt.NDArray[np.float32] = ovimap.Map.open("a.ovimap").mesh().vertices
"""

WRONG = {
    "ovimap.Mapper().process(3)": "incompatible type",
    "ovimap.Map.open('a.ovimap').query(3)": "incompatible type",
    "ovimap.open_source('a').nothing": "has no attribute",
    "ovimap.Mapper(preset=3)": "incompatible type",
}


def mypy(tmp_path, text):
    (tmp_path / "a.py").write_text(text)
    root = pathlib.Path(ovimap.__file__).parent.parent
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(root / ".mypy_cache"), "a.py"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, env={"MYPYPATH": str(root), "PATH": ""})
    return done.stdout + done.stderr


def test_right_programs_pass(tmp_path):
    assert "Success" in mypy(tmp_path, RIGHT)


def test_wrong_programs_do_not(tmp_path):
    found = mypy(tmp_path, "import ovimap\n" + "\n".join(WRONG))
    for line, words in enumerate(WRONG.values(), 2):
        assert any(entry.startswith(f"a.py:{line}:") and words in entry for entry in found.splitlines()), found


@pytest.mark.parametrize("name", [name for name in ovimap.__all__ if name[0].isalpha()])
def test_every_public_name_is_documented(name):
    assert (getattr(ovimap, name).__doc__ or "").strip()


def test_every_public_method_is_documented_or_says_it_all():
    bare = []
    for name in ("Mapper", "LiveMapper", "Map", "FrameSource", "ImageTextEncoder"):
        for member, value in vars(getattr(ovimap, name)).items():
            text = value.__doc__ or ""
            if not member.startswith("_") and callable(value) and text.count("\n") < 2:
                bare.append(f"{name}.{member}")
    assert bare == ["LiveMapper.statistics"]


def test_the_package_keeps_its_own_rules():
    root = pathlib.Path(ovimap.__file__).parent.parent
    settings = pathlib.Path(__file__).parents[2] / "pyproject.toml"
    command = [sys.executable, "-m", "mypy", "--config-file", str(settings), "--cache-dir", str(root / ".mypy_cache"), "-p", "ovimap"]
    done = subprocess.run(command, capture_output=True, text=True, env={"MYPYPATH": str(root), "PATH": ""})
    assert "Success" in done.stdout, done.stdout + done.stderr
