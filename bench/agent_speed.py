#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""How long agents wait for an answer, and what a thousand standing queries cost (docs/agents.md).

Usage: bench/agent_speed.py MAP
MAP is a map file or the address of `ovimap serve --no-limits`. Needs the package with its optional group mcp.
"""
import argparse
import os
import pathlib
import statistics
import sys
import time

import anyio
from mcp.client.client import Client
from mcp.client.stdio import StdioServerParameters, get_default_environment, stdio_client
from ovimap.agents import open_map
from ovimap.watching import watch_map

ROOT = pathlib.Path(__file__).resolve().parent.parent
KINDS = ("old", "new", "small", "large")
STANDING = 1000
ASKED = 100


def words():
    lines = (ROOT / "src/ovimap/semantics/data/vocabulary.txt").read_text().splitlines()
    things = [line.strip() for line in lines if line.strip() and not line.startswith("#")]
    return [f"{kind} {thing}" for kind in KINDS for thing in things][:STANDING]


def line(title, seconds):
    ordered = sorted(seconds)
    print(f"{title}: median {statistics.median(ordered) * 1e3:.1f} ms, 95 % {ordered[int(0.95 * len(ordered))] * 1e3:.1f} ms")


async def time_finds(given):
    passed = {name: os.environ[name] for name in ("PYTHONPATH", "OVIMAP_MODELS", "OVIMAP_TOKEN") if name in os.environ}
    server = StdioServerParameters(command=sys.executable, args=["-m", "ovimap.mcp_command", f"map={given}"], env={**get_default_environment(), **passed})
    async with Client(stdio_client(server)) as client:
        await client.call_tool("find", {"map": "map", "text": "warm up"})
        for title in ("find, new text", "find, text known"):
            seconds = []
            for text in words()[:ASKED]:
                begin = time.perf_counter()
                await client.call_tool("find", {"map": "map", "text": text})
                seconds.append(time.perf_counter() - begin)
            line(title, seconds)


def time_standing(given):
    """A server is asked as `ovimap-watch` does: it tells the first when all were asked."""
    backend = open_map(given)
    print(f"{backend.summary().objects} objects, {STANDING} standing queries")
    queries = [*words()[1:], "largest object"]
    served = "://" in given
    for title in ("first look, texts encoded", "another client" if served else "second look"):
        cpu, wall = time.process_time(), time.perf_counter()
        if served:
            watch_map(backend, queries, lambda event: False)
        else:
            backend.verdicts(queries)
        print(f"{title}: {time.perf_counter() - wall:.2f} s, of which {time.process_time() - cpu:.2f} s of this process")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("map")
    chosen = parser.parse_args().map
    anyio.run(time_finds, chosen)
    time_standing(chosen)
