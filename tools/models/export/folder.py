# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a model folder: its files, and a model.yaml that names and digests them."""

import hashlib
import pathlib
import shutil

import yaml

from .errors import ExportError

MODEL_FILE = "model.yaml"
HEAD = """# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Written by tools/models/export_model.py. The licence of the weights is the key below.
"""


def sha256_of(path: pathlib.Path) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


class FolderWriter:
    """Collects files beside the wanted folder and moves them there at the end, so that a failed
    export leaves no half a model behind."""

    def __init__(self, folder: pathlib.Path):
        self.folder = folder
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise ExportError(f"{folder} exists already; name a new or an empty folder")
        self.partial = folder.with_name(folder.name + ".partial")
        shutil.rmtree(self.partial, ignore_errors=True)
        self.partial.mkdir(parents=True)

    def path(self, name: str) -> pathlib.Path:
        return self.partial / name

    def finish(self, description: dict) -> None:
        """`description` is model.yaml without the digests."""
        digests = {p.name: sha256_of(p) for p in sorted(self.partial.iterdir())}
        text = yaml.safe_dump(
            description | {"sha256": digests},
            sort_keys=False,
            default_flow_style=None,
            allow_unicode=True,
            width=96,
        )
        self.path(MODEL_FILE).write_text(HEAD + text, encoding="utf-8")
        if self.folder.exists():
            self.folder.rmdir()
        self.partial.rename(self.folder)

    def discard(self) -> None:
        shutil.rmtree(self.partial, ignore_errors=True)
