#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Says which C++ sources are not as .clang-format has them; --fix writes them so.

Usage: check_format.py [--fix]   with the clang-format of tools/requirements-test.txt, since versions differ in their taste
"""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ("src", "apps", "tests", "fuzz", "bench", "examples", "python")
WRITTEN_BY_PROGRAMS = {"pair_judge_weights.h"}
NOT_AVAILABLE = 77


def main():
    tool = next((place for place in (pathlib.Path(sys.executable).parent / "clang-format", ROOT / ".venv/bin/clang-format") if place.is_file()), None)
    if not tool:
        print("clang-format is not installed; run tools/setup.sh --tests")
        return NOT_AVAILABLE
    sources = sorted(str(path) for folder in FOLDERS for ending in ("*.cpp", "*.h") for path in (ROOT / folder).rglob(ending)
                     if path.name not in WRITTEN_BY_PROGRAMS)  # fmt: skip
    assert len(sources) > 1000, sources
    options = ["-i"] if "--fix" in sys.argv[1:] else ["--dry-run", "-Werror"]
    checked = subprocess.run([tool, *options, *sources], cwd=ROOT, capture_output=True, text=True)
    wrong = sorted({line.split(":")[0] for line in checked.stderr.splitlines() if "[-Wclang-format-violations]" in line})
    for path in wrong:
        print(f"{pathlib.Path(path).relative_to(ROOT)} is not formatted; run tools/check_format.py --fix")
    return 1 if wrong or checked.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
