#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Holds `ovimap serve` to its own OpenAPI description with schemathesis, which invents requests, sound and broken ones.

Usage: http_api_test.py PROGRAM MAP
"""
import importlib.util
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import urllib.request

NOT_INSTALLED = 77
EXAMPLES = "40"  # of each operation


def fuzz(address):
    """The C++ tests take what cannot be judged here: event streams never end, and cpp-httplib reads the body of a
    request whose method it does not know as the next request."""
    command = [sys.executable, "-m", "schemathesis.cli", "run", address + "api/openapi.json", "--exclude-path", "/api/events",
               "--max-examples", EXAMPLES, "--exclude-checks", "unsupported_method", "--seed", "7", "--phases", "examples,coverage,fuzzing", "--generation-database", "none"]
    return subprocess.run(command, check=False, cwd=tempfile.gettempdir()).returncode


def main(program, source):
    if importlib.util.find_spec("schemathesis") is None:
        print("schemathesis is not installed; run tools/setup.sh")
        return NOT_INSTALLED
    if not pathlib.Path(source).exists():
        print("there is no map to serve: the encoder is missing; run tools/setup.sh")
        return NOT_INSTALLED
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / "map.ovimap"  # corrections change it
        shutil.copy(source, copy)
        with subprocess.Popen([program, "serve", str(copy), "--port", "0", "--json", "--no-limits"], stdout=subprocess.PIPE, text=True) as server:
            address = json.loads(server.stdout.readline())["address"]
            code = fuzz(address)
            with urllib.request.urlopen(address + "api/map", timeout=10) as reply:
                assert reply.status == 200, "the server does not answer any more"
            server.send_signal(signal.SIGINT)
            assert server.wait(timeout=20) == 0, "the server did not end well"
        return code


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
