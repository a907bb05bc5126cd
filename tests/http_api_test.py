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


def fuzz(address, chosen, unchecked=""):
    """The C++ tests take what cannot be judged here: event streams never end, and a GET with a body is refused as such (400)
    whatever its path takes."""
    command = [sys.executable, "-m", "schemathesis.cli", "run", address + "api/openapi.json", *chosen,
               "--max-examples", EXAMPLES, "--exclude-checks", "unsupported_method" + unchecked, "--seed", "7", "--phases", "examples,coverage,fuzzing", "--generation-database", "none"]
    return subprocess.run(command, check=False, cwd=tempfile.gettempdir()).returncode


def fuzz_server(arguments, ends_with, *fuzzing, warm=""):
    """Starts a server, fuzzes it, and sees it end well; the exit code of the fuzzing. warm: asked for once before, since that takes its time."""
    with subprocess.Popen([*arguments, "--port", "0", "--json", "--no-limits"], stdout=subprocess.PIPE, text=True) as server:
        address = json.loads(server.stdout.readline())["address"]
        if warm:
            with urllib.request.urlopen(address + warm, timeout=120) as reply:
                assert reply.status == 200, f"{warm} does not answer"
        code = fuzz(address, *fuzzing)
        with urllib.request.urlopen(address + "api/map", timeout=10) as reply:
            assert reply.status == 200, "the server does not answer any more"
        server.send_signal(signal.SIGINT)
        assert server.wait(timeout=20) == ends_with, "the server did not end well"
    return code


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
        # Where to stand and rooms are read anew after every correction, so they are asked apart.
        space = ("/api/approach", "/api/rooms")
        code = fuzz_server([program, "serve", str(copy)], 0, [f"--include-path={path}" for path in space], warm="api/rooms")
        code = code or fuzz_server([program, "serve", str(copy)], 0, [f"--exclude-path={path}" for path in ("/api/events", "/api/watch", *space)])
        # A server that takes frames. No schema can say what a rigid pose is, or an image of the camera's size: sound
        # frames are not invented, and in the end there is no map.
        taking = [program, "serve", "http", "--live", "-o", str(pathlib.Path(folder) / "pushed.ovimap")]
        frames = ["--include-path", "/api/camera", "--include-path", "/api/frames"]
        return code or fuzz_server(taking, 2, frames, ",positive_data_acceptance")


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
