# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The command ovimap-mcp: maps for agents, over the Model Context Protocol (docs/agents.md)."""

from __future__ import annotations

import argparse
import contextlib
import os
import pathlib
import sys
import threading
from typing import TYPE_CHECKING

from ._ovimap import Error, version
from .agents import MapFault, open_map
from .command_line import DONE, run_command
from .map_facts import map_facts

if TYPE_CHECKING:
    from .agents import MapBackend


def main(arguments: list[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    return run_command("ovimap-mcp", _parser().parse_args(arguments), extra="mcp", packages=("mcp", "mcp_types", "pydantic", "uvicorn"))


def _serve(options: argparse.Namespace) -> int:
    maps = opened_maps(options.maps, options.map_token_file)
    own_token = token_of(options.token_file, "OVIMAP_MCP_TOKEN")
    from .agents.tools import MapServer

    for backend in maps:
        threading.Thread(target=_make_ready, args=(backend,)).start()
    server = MapServer(maps, corrections=options.allow_corrections, version=version())
    if options.http is None:
        with contextlib.suppress(KeyboardInterrupt):
            server.run("stdio")
    else:
        from .agents.over_http import serve

        serve(server, options.host, options.http, own_token, options.host_name)
    return DONE


def _make_ready(backend: MapBackend) -> None:
    """Opens map and encoder, which takes a second, before anybody asks."""
    with contextlib.suppress(MapFault):  # whoever asks is told
        backend.summary()


def opened_maps(given: list[str], token_file: str | None) -> list[MapBackend]:
    """The maps that a command line names: MAP, URL, or NAME= before either. A file that is no map is refused now; a server
    may come later."""
    token = token_of(token_file, "OVIMAP_TOKEN")
    maps: dict[str, MapBackend] = {}
    for text in given:
        name, spec = _named(text)
        if "?token=" in spec:
            raise Error("everybody on this machine can read a token in the list of programs; leave it out of the address and use "
                        "--map-token-file, or the variable OVIMAP_TOKEN")
        try:
            backend = open_map(spec, name=name, token=token)
        except MapFault as fault:
            raise Error(str(fault)) from None
        if "://" not in spec:
            map_facts(spec)
        if backend.name in maps:
            raise Error(f"two maps are called '{backend.name}'; give them names: kitchen={spec}")
        maps[backend.name] = backend
    return list(maps.values())


def token_of(file: str | None, variable: str) -> str:
    """The first line of the file, else the variable; empty where there is neither."""
    if file is None:
        return os.environ.get(variable, "")
    lines = pathlib.Path(file).read_text(encoding="utf-8").splitlines()
    if not lines or not lines[0].strip():
        raise Error(f"'{file}' holds no token; write one line into it")
    return lines[0].strip()


def _named(text: str) -> tuple[str, str]:
    """NAME=MAP in two; a path or address may have a = of its own, behind a slash or dot."""
    name, separator, spec = text.partition("=")
    if separator and spec and name and not set(name) & set("/.:?"):
        return name, spec
    return "", text


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="ovimap-mcp", description="lets agents ask maps, over the Model Context Protocol; stdio unless --http")
    parser.add_argument("maps", nargs="+", metavar="MAP", help="map file, or address of `ovimap serve` (also --live); NAME=MAP names it")
    parser.add_argument("--allow-corrections", action="store_true", help="adds the tools rename, merge and undo")
    parser.add_argument("--map-token-file", metavar="FILE", help="first line: the token of the servers named; else the variable OVIMAP_TOKEN")
    parser.add_argument("--http", type=int, metavar="PORT", help="streamable HTTP at http://HOST:PORT/mcp instead of stdio; 0: any free port")
    parser.add_argument("--host", default="127.0.0.1", help="address of this machine to listen at; only loopback is taken (default: %(default)s)")
    parser.add_argument("--host-name", action="append", default=[], metavar="NAME", help="name by which a proxy calls this server. Repeatable")
    parser.add_argument("--token-file", metavar="FILE",
                        help="first line: what clients must show; else the variable OVIMAP_MCP_TOKEN, else a random one that is printed")  # fmt: skip
    parser.set_defaults(command=_serve)
    return parser


if __name__ == "__main__":
    sys.exit(main())
