# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The native program as a piece of work that may be killed at any moment and begun again."""

from __future__ import annotations

import errno
import json
import os
import pty
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from typing import IO, Any

from .._ovimap import Error
from ..command_line import find_program

TELL_S = 1.0  # between reports of how far the program is
KEPT_CHARACTERS = 8192  # of what it says: its last line is among them
PROGRESS = re.compile(r"\r[^\r\n]*? (\d+)/(\d+) [^\r\n]*\x1b\[K")
MENDABLE = 2  # exit code of what the user can mend


class Crash(Exception):
    """The program was killed or met a defect: trying again may help."""


def run_program(
    arguments: Sequence[str], *, lock: int, program: str = "", cwd: str = "", tell: Callable[[int, int], Any] | None = None
) -> dict[str, Any]:
    """Runs `ovimap ARGUMENTS --json` and returns the object it prints.

    cwd: the folder that paths among the arguments are relative to, where this machine has it. tell: is told
    (frames done, all frames) about once a second. Raises Error with the program's own line for what the user can mend,
    Crash for any other bad end.
    """
    folder = cwd if os.path.isdir(cwd) else None
    command = [*_die_with_worker(), find_program(program), *arguments, "--json"]
    screen, terminal = pty.openpty()  # the program tells its progress to terminals alone
    with tempfile.TemporaryFile() as out, os.fdopen(screen, "rb", buffering=0) as said:
        with subprocess.Popen(command, stdout=out, stderr=terminal, stdin=subprocess.DEVNULL, cwd=folder, pass_fds=[lock]) as process:
            os.close(terminal)
            try:
                last = _listen(said, tell)
                code = process.wait()
            except BaseException:
                process.kill()
                raise
        out.seek(0)
        if code == 0:
            report: dict[str, Any] = json.load(out)
            return report
    if code == MENDABLE:
        raise Error(last)
    raise Crash(f"the program was ended by signal {-code}" if code < 0 else f"the program ended with {code}: {last}")


def _listen(screen: IO[bytes], tell: Callable[[int, int], Any] | None) -> str:
    """Reads what the program writes until it ends; returns its last line that is no progress."""
    text, told = "", 0.0
    while chunk := _read(screen):
        text = (text + chunk)[-KEPT_CHARACTERS:]
        progress = PROGRESS.findall(text)
        if tell is not None and progress and time.monotonic() - told > TELL_S:
            told = time.monotonic()
            tell(int(progress[-1][0]), int(progress[-1][1]))
    lines = [line.strip() for line in re.sub(PROGRESS, "", text).splitlines()]
    return next((line for line in reversed(lines) if line), "").removeprefix("ovimap: ")


def _read(screen: IO[bytes]) -> str:
    try:
        return screen.read(4096).decode(errors="replace")
    except OSError as fault:
        if fault.errno == errno.EIO:  # how a terminal says that nobody can write to it any more
            return ""
        raise


def _die_with_worker() -> list[str]:
    # A worker that is killed cannot end its program, which would go on eating memory. Util-linux can tie the two.
    tie = shutil.which("setpriv")
    return [tie, "--pdeathsig", "KILL"] if tie else []

