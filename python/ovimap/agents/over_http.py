# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The server for agents over streamable HTTP: on this machine alone, and for those who show the token."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import hmac
import ipaddress
import secrets
import socket
import sys
from collections.abc import Iterable, Sequence
from typing import cast

import h11
import uvicorn
from mcp.server.transport_security import TransportSecuritySettings
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Receive, Scope, Send
from uvicorn.protocols.http.h11_impl import H11Protocol

from .._ovimap import Error
from .tools import MapServer

PATH = "/mcp"
LOOPBACK_NAMES = ("localhost", "127.0.0.1", "[::1]")
CONNECTIONS = 128
ACCEPTED_AT_ONCE = 32  # far fewer than CONNECTIONS, so that the head of who comes is read before others crowd him out
HEAD_LIMIT_S = 5.0


class TokenGate:
    """Lets through who shows the token, and nobody else; no byte of a body is read before."""

    def __init__(self, app: ASGIApp, token: str) -> None:
        self._app, self._wanted = app, f"Bearer {token}".encode()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "websocket":
            await send({"type": "websocket.close"})
            return
        if scope["type"] == "http":
            if not self.shown_in(scope["headers"]):
                said = {"error": "show the token that ovimap-mcp printed or was given: Authorization: Bearer TOKEN"}
                await JSONResponse(said, 401, {"WWW-Authenticate": "Bearer"})(scope, receive, send)
                return
        await self._app(scope, receive, send)

    def shown_in(self, headers: Iterable[tuple[bytes, bytes]]) -> bool:
        shown = [value for name, value in headers if name == b"authorization"]
        return len(shown) == 1 and hmac.compare_digest(shown[0], self._wanted)


class BoundedHTTP(H11Protocol):
    """HTTP that nobody can use up without the token. A connection costs a file, of which a process has 1,024 as a rule, and uvicorn bounds
    neither connections nor the time that a head takes: so who has not shown the token in a whole head within HEAD_LIMIT_S is cut off, and
    where there are more than CONNECTIONS, the one that has owed it the longest gives way, the newest itself where all others showed it."""

    _limit: asyncio.TimerHandle | None = None  # while the token is owed

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._owe_token()
        if len(self.connections) > CONNECTIONS:
            owing = [(other._limit.when(), other) for other in self.connections if isinstance(other, BoundedHTTP) and other._limit]
            min(owing, key=lambda item: item[0])[1]._give_way()

    def connection_lost(self, exc: Exception | None) -> None:
        self._owe_nothing()
        super().connection_lost(exc)

    def handle_events(self) -> None:
        before = self.scope
        super().handle_events()
        if self.scope is not before:  # a head is whole
            if cast(TokenGate, self.config.app).shown_in(self.headers):
                self._owe_nothing()
            else:
                self._owe_token()
        elif self.conn.their_state is h11.IDLE and self.conn.trailing_data[0]:  # a later head has begun
            self._owe_token()

    def _owe_token(self) -> None:
        if self._limit is None and not self.transport.is_closing():
            self._limit = self.loop.call_later(HEAD_LIMIT_S, self._give_way)

    def _owe_nothing(self) -> None:
        if self._limit is not None:
            self._limit.cancel()
            self._limit = None

    def _give_way(self) -> None:
        self._owe_nothing()
        self.connections.discard(self)  # at once, as others may come before it is lost
        self.transport.abort()


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
    config = uvicorn.Config(
        app, http=BoundedHTTP, ws="none", backlog=ACCEPTED_AT_ONCE, log_level="warning", lifespan="on", timeout_graceful_shutdown=2
    )
    if not given:
        print(f"ovimap-mcp: token {token}", file=sys.stderr, flush=True)
    shown = f"[{host}]" if ":" in host else host
    print(f"ovimap-mcp: http://{shown}:{listening.getsockname()[1]}{PATH}", file=sys.stderr, flush=True)
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(_until_interrupted(config, listening))


async def _until_interrupted(config: uvicorn.Config, listening: socket.socket) -> None:
    """asyncio logs what goes wrong in its loop, the log that mcp sets up reads sources to show them, and where no file is left to open
    that would end the loop; so it is said without."""
    asyncio.get_running_loop().set_exception_handler(lambda _, context: _say_once(f"{context['message']}: {context.get('exception')}"))
    await uvicorn.Server(config).serve(sockets=[listening])


@functools.lru_cache(maxsize=64)
def _say_once(line: str) -> None:
    """What lasts goes wrong again with every try."""
    print(f"ovimap-mcp: {line}", file=sys.stderr, flush=True)


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
