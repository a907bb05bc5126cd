# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The command `ovimap` of a wheel: becomes the native program that the wheel carries.

It stands beside the package ovimap, not in it: the program needs no NumPy and no bindings, and starts without loading them.
"""

import os
import pathlib
import sys

PROGRAM = pathlib.Path(__file__).resolve().parent / "ovimap" / "bin" / "ovimap"


def main():
    os.environ["OVIMAP_PYTHON"] = sys.executable  # `ovimap models fetch default` asks its pip
    os.execv(PROGRAM, ["ovimap", *sys.argv[1:]])
