#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Puts a wheel together from what a build folder installs: the Python package, the native program and what it needs.

Its name, version and extras are those of pyproject.toml; the libraries come in by auditwheel afterwards (tools/packages.sh).
    ovimap/           the Python package; bin/ovimap the program, share/ovimap its page, masks, furniture, and what fetches the rest
    ovimap_program.py the command `ovimap`
Usage: wheel.py BUILD STAGE, run by an interpreter that has scikit-build-core; `wheel pack STAGE` makes the file
"""

import os
import pathlib
import shutil
import subprocess
import sys

from scikit_build_core.build import prepare_metadata_for_build_wheel

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODELS = ROOT / "tools/models"
ENCODER = (
    "fetch_default_encoder.py", "build_default_encoder.py", "default-encoder.yaml", "default_encoder.npz", "efficientnet_lite.py",
    "minilm.py", "onnx_graph.py", "weight_files.py",
)  # fmt: skip


def install(build: str, component: str, prefix: pathlib.Path):
    subprocess.run(["cmake", "--install", build, "--strip", "--component", component, "--prefix", str(prefix)], check=True, stdout=sys.stderr)


def add_package(build: str, stage: pathlib.Path):
    """What the bindings need of ONNX Runtime comes in by auditwheel."""
    shutil.copytree(ROOT / "python/ovimap", stage / "ovimap", ignore=shutil.ignore_patterns("__pycache__"))
    install(build, "python", stage)
    for library in (stage / "ovimap").glob("libonnxruntime.so*"):
        library.unlink()


def add_program(build: str, stage: pathlib.Path, share: pathlib.Path):
    """Man pages and completions go to `share`: where shells and man look below an environment."""
    prefix = stage / "ovimap"
    for component in ("program", "data"):
        install(build, component, prefix)
    shutil.rmtree(prefix / "lib", ignore_errors=True)  # ONNX Runtime, likewise
    shutil.rmtree(prefix / "share/doc")  # the Debian package's licences; a wheel carries more
    encoder = prefix / "share/ovimap/encoder"
    encoder.mkdir()
    for name in ENCODER:
        shutil.copy(MODELS / name, encoder)
    share.mkdir(parents=True)
    for place in ("man", "bash-completion", "zsh", "fish"):
        shutil.move(prefix / "share" / place, share / place)
    shutil.copy(ROOT / "tools/packages/ovimap_program.py", stage)


def complete_metadata(build: str, about: pathlib.Path):
    """The command, the tag, the licences."""
    entries = (about / "entry_points.txt").read_text()
    heading = "[console_scripts]\n"
    (about / "entry_points.txt").write_text(entries.replace(heading, f"{heading}ovimap = ovimap_program:main\n"))
    (about / "WHEEL").write_text("Wheel-Version: 1.0\nGenerator: ovimap\nRoot-Is-Purelib: false\nTag: cp310-abi3-linux_x86_64\n")
    program = str(pathlib.Path(build).resolve() / "bin/ovimap")
    subprocess.run([sys.executable, str(ROOT / "tools/packages/licenses.py"), program, str(about / "licenses")], check=True)


def main(build: str, stage: pathlib.Path):
    shutil.rmtree(stage, ignore_errors=True)
    stage.mkdir(parents=True)
    os.chdir(ROOT)  # pyproject.toml is there
    about = stage / prepare_metadata_for_build_wheel(str(stage))
    add_package(build, stage)
    add_program(build, stage, about.with_suffix(".data") / "data/share")
    complete_metadata(build, about)


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]).resolve())
