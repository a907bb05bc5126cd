# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Servers that the tests of agents and standing queries ask, each until its block ends."""
import contextlib
import json
import os
import signal
import subprocess
import sys

import anyio
import httpx2
import pytest
from mcp.client.client import Client
from mcp.client.stdio import StdioServerParameters, stdio_client
from mcp.client.streamable_http import streamable_http_client

PROGRAM = os.environ.get("OVIMAP_PROGRAM")
needs_program = pytest.mark.skipif(not PROGRAM, reason="the program was not built; set OVIMAP_PROGRAM")
PASSED_ON = ("HOME", "PATH", "PYTHONPATH", "OVIMAP_MODELS", "OVIMAP_DATA_DIR", "PYTHONDONTWRITEBYTECODE", "XDG_CACHE_HOME")


@contextlib.contextmanager
def serving(*arguments, port=0):
    """`ovimap serve`; gives the process, with its address."""
    command = [PROGRAM, "serve", *map(str, arguments), "--port", str(port), "--viewer", "none", "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        server.address = json.loads(server.stdout.readline())["address"]
        try:
            yield server
        finally:
            if server.poll() is None:
                server.send_signal(signal.SIGINT)
                server.wait(timeout=300)


def environment(**more):
    return {name: os.environ[name] for name in PASSED_ON if name in os.environ} | more


class Said:
    """An answer of a tool."""

    def __init__(self, result):
        self.error = result.content[0].text if result.is_error else ""
        self.value = result.structured_content
        if self.value is not None and set(self.value) == {"result"}:
            self.value = self.value["result"]
        self.pictures = [item for item in result.content if item.type == "image"]


class Agent:
    """The library's own client, asked without async."""

    def __init__(self, transport):
        self._portal = anyio.from_thread.start_blocking_portal()
        self._transport = transport

    def __enter__(self):
        portal = self._portal.__enter__()
        self._stack = contextlib.ExitStack()
        self._client = self._stack.enter_context(portal.wrap_async_context_manager(Client(self._transport)))
        self._call = portal.call
        return self

    def __exit__(self, *fault):
        self._stack.close()
        self._portal.__exit__(*fault)

    def tools(self):
        return {tool.name: tool for tool in self._call(self._client.list_tools).tools}

    def __getattr__(self, tool):
        return lambda **arguments: Said(self._call(self._client.call_tool, tool, arguments))


def agent_over_stdio(*arguments, **variables):
    command = ["-m", "ovimap.mcp_command", *map(str, arguments)]
    return Agent(stdio_client(StdioServerParameters(command=sys.executable, args=command, env=environment(**variables))))


@contextlib.contextmanager
def http_server(*arguments, first="", **variables):
    """`ovimap-mcp --http 0`; gives its address and, where it made one, its token. first: Python that it runs before."""
    code = f"import sys\nfrom ovimap import mcp_command\n{first}\nsys.exit(mcp_command.main())"
    command = [sys.executable, "-c", code, *map(str, arguments), "--http", "0"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment(**variables)) as server:
        address = token = ""
        while not address:
            line = server.stderr.readline()
            assert line, "the server ended before it listened"
            kind, _, value = line.removeprefix("ovimap-mcp: ").strip().partition(" ")
            token = value if kind == "token" else token
            address = kind if kind.startswith("http") else ""
        try:
            yield address, token
        finally:
            server.send_signal(signal.SIGINT)
            assert server.wait(timeout=20) == 0


def agent_over_http(address, token):
    return Agent(streamable_http_client(address, http_client=httpx2.AsyncClient(headers={"Authorization": f"Bearer {token}"}, timeout=60)))
