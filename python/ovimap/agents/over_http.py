# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The server for agents over streamable HTTP: on this machine alone, and for those who show the token."""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import ipaddress
import secrets
import socket
import sys
from collections.abc import Sequence

import uvicorn
from mcp.server.transport_security import TransportSecuritySettings
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Receive, Scope, Send

from .._ovimap import Error
from .tools import MapServer

PATH = "/mcp"
LOOPBACK_NAMES = ("localhost", "127.0.0.1", "[::1]")


class TokenGate:
    """Lets through who shows the token, and nobody else; no byte of a body is read before."""

    def __init__(self, app: ASGIApp, token: str) -> None:
        self._app, self._wanted = app, f"Bearer {token}".encode()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "websocket":
            await send({"type": "websocket.close"})
            return
        if scope["type"] == "http":
            shown = [value for name, value in scope["headers"] if name == b"authorization"]
            if len(shown) != 1 or not hmac.compare_digest(shown[0], self._wanted):
                said = {"error": "show the token that ovimap-mcp printed or was given: Authorization: Bearer TOKEN"}
                await JSONResponse(said, 401, {"WWW-Authenticate": "Bearer"})(scope, receive, send)
                return
        await self._app(scope, receive, send)


def serve(server: MapServer, host: str, port: int, given: str, names: Sequence[str] = ()) -> None:
    """Serves until it is interrupted. given: the token that clients must show; empty: a random one, which is printed for whoever
    started this. Raises Error where it cannot listen there."""
    if not all(" " < letter < "\x7f" for letter in given):
        raise Error("the token may have printable ASCII characters alone, and no blanks")
    listening = _listening(host, port)
    token = given or secrets.token_urlsafe(24)
    hosts = [*LOOPBACK_NAMES, *names]
    security = TransportSecuritySettings(
        allowed_hosts=[*hosts, *(f"{name}:*" for name in hosts)],
        allowed_origins=[f"http://{name}:*" for name in LOOPBACK_NAMES] + [f"https://{name}" for name in names],
    )
    app = TokenGate(server.streamable_http_app(streamable_http_path=PATH, transport_security=security), token)
    config = uvicorn.Config(app, log_level="warning", lifespan="on", timeout_graceful_shutdown=2)
    if not given:
        print(f"ovimap-mcp: token {token}", file=sys.stderr, flush=True)
    shown = f"[{host}]" if ":" in host else host
    print(f"ovimap-mcp: http://{shown}:{listening.getsockname()[1]}{PATH}", file=sys.stderr, flush=True)
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(uvicorn.Server(config).serve(sockets=[listening]))


def _listening(host: str, port: int) -> socket.socket:
    try:
        loopback = host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        loopback = False
    if not loopback:
        raise Error(f"'{host}' is no address of this machine alone; give one in 127.0.0.0/8, ::1 or localhost, and put a proxy with TLS "
                    "before it for others")
    if not 0 <= port <= 65535:
        raise Error(f"the port must be from 0 to 65535, not {port}")
    listening = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((host, port))
        listening.listen()
    except OSError as fault:
        listening.close()
        raise Error(f"cannot listen at {host}:{port} ({fault.strerror}); choose another port, or 0 for any free one") from None
    return listening
