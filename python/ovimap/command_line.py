# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What the package's commands have in common: exit codes, and faults in one line with the remedy."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Collection

from ._ovimap import Error

DONE, NO, MENDABLE = 0, 1, 2  # exit codes, as the program's


def line_of(fault: OSError) -> str:
    """What the system refuses, with the remedy."""
    return f"{fault}; make room, or give a folder that can be written"


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
    except ModuleNotFoundError as fault:
        if fault.name not in packages:
            raise
        said = f"{fault.name} is not installed; pip install 'ovimap[{extra}]'"
    print(f"{name}: {said}", file=sys.stderr)
    return MENDABLE
