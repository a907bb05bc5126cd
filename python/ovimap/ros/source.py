# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Where a map comes from: a server, or a file, which is served to this program alone and anew when it changes."""

from __future__ import annotations

import contextlib
import pathlib
import signal
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass

from .._ovimap import Error
from ..command_line import find_program
from ..files import parse_json
from ..map_facts import map_facts


def is_address(text: str) -> bool:
    """And not a file, whether or not that is there."""
    return not pathlib.Path(text).exists() and not text.endswith(".ovimap")


@dataclass
class Source:
    """address: of the server. file: which it serves, as it was then; None for a server that was there before."""

    address: str
    file: pathlib.Path | None = None
    revision: str = ""

    def changed(self) -> bool:
        """Whether the file is another by now, corrected or replaced."""
        if self.file is None:
            return False
        try:
            return map_facts(self.file).revision != self.revision
        except Error:
            return True


@contextlib.contextmanager
def open_source(text: str) -> Iterator[Source]:
    """Of an address, or of a file. Raises Error with the program's line for what is no map."""
    if is_address(text):
        yield Source(text)
        return
    path = pathlib.Path(text)
    if not path.is_file():
        raise Error(f"there is no map '{path}'; give a map file, or the address that `ovimap serve` printed")
    revision = map_facts(path).revision
    command = [find_program(), "serve", str(path), "--port", "0", "--viewer", "none", "--json"]
    with tempfile.TemporaryFile("w+") as said, subprocess.Popen(command, stdout=subprocess.PIPE, stderr=said, text=True) as process:
        assert process.stdout is not None
        try:
            line = process.stdout.readline()
            if not line:
                said.seek(0)
                raise Error(next(iter(said.read().strip().splitlines()[::-1]), f"'{path}' cannot be served"))
            yield Source(str(parse_json(line)["address"]), path, revision)
        finally:
            process.send_signal(signal.SIGINT)
