# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The reference page says what the package says."""
import pathlib
import subprocess
import sys

import ovimap

ROOT = pathlib.Path(__file__).resolve().parents[2]


def test_page_is_up_to_date():
    stub = pathlib.Path(ovimap.__file__).parent / "_ovimap.pyi"
    done = subprocess.run([sys.executable, ROOT / "tools" / "python_reference.py", stub, "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_page_is_compared(tmp_path):
    stale = tmp_path / "page.md"
    stale.write_text("# Something else\n")
    stub = pathlib.Path(ovimap.__file__).parent / "_ovimap.pyi"
    command = [sys.executable, ROOT / "tools" / "python_reference.py", stub, "--check", "--out", stale]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 1 and "run: tools/python_reference.py" in done.stderr
    assert stale.read_text() == "# Something else\n"
