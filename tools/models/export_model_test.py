#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Exports tiny models of every kind, compares ONNX Runtime with torch, and the golden folders made
anew with those committed.

Needs requirements-export.txt in the interpreter that $OVIMAP_EXPORT_PYTHON names, or in this one;
without them it ends with exit code 77 and says so, which ctest shows as a skipped test.
"""

import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SKIPPED = 77
NEEDED = ("torch", "transformers", "onnx", "onnxruntime", "sentencepiece", "PIL", "yaml", "scipy")


def missing_packages(python: str) -> list:
    code = (
        "import importlib.util as u, sys;"
        "print(*[n for n in sys.argv[1:] if u.find_spec(n) is None])"
    )
    found = subprocess.run([python, "-c", code, *NEEDED], capture_output=True, text=True)
    return found.stdout.split() if found.returncode == 0 else [python]


def main() -> int:
    python = os.environ.get("OVIMAP_EXPORT_PYTHON") or sys.executable
    missing = missing_packages(python)
    if missing:
        print(
            f"{python} lacks {', '.join(missing)}; pip install -r "
            "tools/models/requirements-export.txt and name that Python in OVIMAP_EXPORT_PYTHON"
        )
        return SKIPPED
    environment = os.environ | {"HF_HUB_OFFLINE": "1", "TRANSFORMERS_VERBOSITY": "error"}
    environment["HF_HUB_DISABLE_PROGRESS_BARS"] = "1"
    discover = ["-m", "unittest", "discover", "-s", "export_tests", "-p", "*.py", "-t", "."]
    return subprocess.run([python, "-W", "ignore", *discover], cwd=HERE, env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())
