# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""ovimap's side of a comparison: it decodes the frames and brings colour to the depth, so both sides see the same."""
import subprocess

import numpy

MAX_RANGE_M = 10.0


class Ours:
    def __init__(self, program, recording, folder):
        self.folder = folder
        self.process = subprocess.Popen([str(program), str(recording), str(folder)], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        self.frames = int(self.process.stdout.readline())

    def do(self, command, argument=""):
        self.process.stdin.write(f"{command} {argument}\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise SystemExit("the other side ended; see above")
        return float(answer)

    def raw(self, name, kind):
        return numpy.fromfile(self.folder / name, dtype=kind)
