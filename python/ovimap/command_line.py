# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What the package's commands have in common: exit codes, faults in one line with the remedy, the native program."""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from collections.abc import Collection

from ._ovimap import Error

DONE, NO, MENDABLE = 0, 1, 2  # exit codes, as the program's


def line_of(fault: OSError) -> str:
    """What the system refuses, with the remedy."""
    return f"{fault}; make room, or give a folder that can be written"


def find_program(given: str = "") -> str:
    """The program on this machine: given, else $OVIMAP_PROGRAM, else on the PATH. Raises Error where there is none."""
    asked = given or os.environ.get("OVIMAP_PROGRAM") or "ovimap"
    found = shutil.which(asked)
    if not found:
        raise Error(f"there is no program '{asked}' on {os.uname().nodename}; build it (make build) and name it, "
                    "as the program or in OVIMAP_PROGRAM, by a path that every machine has")
    return found


def run_command(name: str, options: argparse.Namespace, *, extra: str, packages: Collection[str]) -> int:
    """Runs options.command(options) and returns its exit code; what the user can mend is one line on stderr.

    packages: those of the optional group `extra`, which may not be installed.
    """
    try:
        code: int = options.command(options)
        return code
    except Error as fault:
        said = str(fault)
    except OSError as fault:
        said = line_of(fault)
    except ImportError as fault:
        package = (fault.name or "").split(".")[0]
        if package not in packages:
            raise
        said = f"{package} cannot be loaded ({fault}); install the library of the system that it names (docs/cameras.md)"
        if isinstance(fault, ModuleNotFoundError):
            said = f"{package} is not installed; pip install 'ovimap[{extra}]'"
    print(f"{name}: {said}", file=sys.stderr)
    return MENDABLE
