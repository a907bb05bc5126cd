#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Plays an agent that looks for things in a map, and prints what it asked and what it was told: the session of docs/agents.md.

Usage: tools/agent_session.py MAP
MAP is a map file or the address of `ovimap serve`. Needs the package with its optional group mcp.
"""
import argparse
import json
import os
import sys

import anyio
from mcp.client.client import Client
from mcp.client.stdio import StdioServerParameters, get_default_environment, stdio_client

WIDTH = 118
PASSED_ON = ("PYTHONPATH", "OVIMAP_MODELS", "OVIMAP_TOKEN")


def shown(result):
    """An answer in lines: JSON as it is, of pictures their kind and size."""
    if result.is_error or result.structured_content is None:
        for item in result.content:
            yield item.text if item.type == "text" else f"[picture, {item.mime_type}, {len(item.data) * 3 // 4} bytes]"
        return
    value = result.structured_content
    value = value["result"] if set(value) == {"result"} else value
    head = {key: entry for key, entry in value.items() if not isinstance(entry, list) or not entry or not isinstance(entry[0], dict)} if isinstance(value, dict) else None
    if head is None:
        yield from (json.dumps(entry) for entry in value)
        return
    yield json.dumps(head)
    for key, entries in value.items():
        if key not in head:
            yield f"{key}:"
            yield from (f"  {json.dumps(entry)}" for entry in entries)


def folded(line):
    while len(line) > WIDTH:
        cut = line.rfind(" ", 0, WIDTH)
        yield line[:cut]
        line = "      " + line[cut + 1 :]
    yield line


async def session(arguments, variables):
    server = StdioServerParameters(command=sys.executable, args=["-m", "ovimap.mcp_command", *arguments], env=variables)
    async with Client(stdio_client(server)) as client:

        async def ask(tool, **given):
            print(f"> {tool}({', '.join(f'{name}={json.dumps(value)}' for name, value in given.items())})")
            result = await client.call_tool(tool, given)
            for line in shown(result):
                print("\n".join("    " + part for part in folded(line)))
            return result.structured_content

        print("tools:", ", ".join(tool.name for tool in (await client.list_tools()).tools))
        await ask("maps")
        on_table = await ask("find", map="room", text="anything on the table")
        if on_table is None or not on_table["matches"]:
            return
        await ask("find", map="room", text="elephant")
        chosen = on_table["matches"][0]["id"]
        await ask("look", map="room", object=chosen, pictures=2)
        await ask("describe", map="room", object=chosen)
        await ask("describe", map="room", object=999999)
        named = await ask("rename", map="room", object=chosen, name="fruit bowl")
        await ask("find", map="room", text="anything on the table")
        await ask("undo", map="room", correction=named["correction"])
        await ask("what_changed", map="room")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("map", help="of which nothing is changed in the end")
    variables = {**get_default_environment(), **{name: os.environ[name] for name in PASSED_ON if name in os.environ}}
    anyio.run(session, [f"room={parser.parse_args().map}", "--allow-corrections"], variables)


if __name__ == "__main__":
    main()
