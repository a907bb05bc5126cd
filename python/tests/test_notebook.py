# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The notebooks of examples/ run from top to bottom, and are kept without what they printed."""
import pathlib

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = sorted((pathlib.Path(__file__).parents[2] / "examples").glob("*.ipynb"))


def code_cells(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_notebooks_hold_no_output(path):
    for cell in code_cells(nbformat.read(path, as_version=4)):
        assert cell.outputs == [] and cell.execution_count is None


def test_many_rooms_are_searched(room, tmp_path, monkeypatch):
    monkeypatch.setenv("ROOM", str(room))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    [path] = NOTEBOOKS
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    printed = "".join(output.text for cell in code_cells(notebook) for output in cell.outputs if output.output_type == "stream")
    pictures = [output for cell in code_cells(notebook) for output in cell.outputs if "image/png" in output.get("data", {})]
    assert "sofa: found" in printed and "elephant: in none of the rooms" in printed
    assert len(pictures) == 2
