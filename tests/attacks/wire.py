# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Connections of attackers: any bytes, from any of this machine's 253 other loopback addresses."""
import concurrent.futures
import contextlib
import itertools
import json
import re
import select
import socket
import struct
import time

SOURCES = itertools.cycle(f"127.0.0.{last}" for last in range(2, 255))  # the normal client is 127.0.0.1
AT_ONCE = 16
LENGTH = re.compile(rb"(?i)\r\ncontent-length: *(\d+)")


class Wire:
    """A connection. Nothing here raises because the other side went away: that is what servers do to attackers."""

    def __init__(self, port, source=None, receive_buffer=None):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.bind((source or next(SOURCES), 0))
        self.socket.settimeout(5)
        self.open = True
        with self._noting_the_end():
            self.socket.connect(("127.0.0.1", port))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    @contextlib.contextmanager
    def _noting_the_end(self):
        try:
            yield
        except (OSError, ValueError):
            self.open = False

    def send(self, data, patience_s=5.0):
        """Whether all of it went out."""
        self.socket.settimeout(patience_s)
        with self._noting_the_end():
            self.socket.sendall(data.encode() if isinstance(data, str) else data)
        return self.open

    def receive(self, patience_s=5.0, enough=None):
        """What comes until the other side closes or says nothing for that long, or `enough` says so."""
        data = bytearray()
        while not (enough and enough(bytes(data))) and select.select([self.socket], [], [], patience_s)[0]:
            try:
                piece = self.socket.recv(1 << 16)
            except OSError:
                piece = b""
            if not piece:
                self.open = False
                break
            data += piece
        return bytes(data)

    def reset(self):
        """Goes away as a program does that was killed."""
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.socket.close()


class Reply:
    """One answer of the server."""

    def __init__(self, status, head, body):
        self.status, self.head, self.body = status, head, body

    def __repr__(self):
        return f"{self.status} {self.body[:120]!r}"


def is_whole(data):
    """Whether the first answer is there with all of its body."""
    head, ended, body = data.partition(b"\r\n\r\n")
    length = LENGTH.search(head)
    return bool(ended) and not head.startswith(b"HTTP/1.1 1") and len(body) >= (int(length[1]) if length else 1 << 30)


def replies(data):
    """The answers that a connection brought, the last one perhaps cut off."""
    found = []
    while data.startswith(b"HTTP/1."):
        head, _, data = data.partition(b"\r\n\r\n")
        status = int(head[9:12])
        if 100 <= status < 200:
            continue
        length = LENGTH.search(head)
        size = int(length[1]) if length else len(data)
        body, data = data[:size], data[size:]
        found.append(Reply(status, head, body))
    return found


def head(method, path, *lines):
    """A request's head, addressed to this machine."""
    return "\r\n".join([f"{method} {path} HTTP/1.1", "Host: localhost", *lines, "", ""])


def post(path, body, *lines, kind="application/json"):
    body = body.encode() if isinstance(body, str) else body
    return head("POST", path, f"Content-Type: {kind}", f"Content-Length: {len(body)}", *lines).encode() + body


def rename(instance, *lines, host="Host: localhost"):
    """A sound request that changes the map, if it is taken for one: the first line and Host stand for themselves."""
    body = json.dumps({"kind": "rename", "instance": instance, "name": "owned"})
    return "\r\n".join(["POST /api/corrections HTTP/1.1", *([host] if host else []), *lines, "Content-Type: application/json",
                        f"Content-Length: {len(body)}", "", body]).encode()  # fmt: skip


def ask(port, data, patience_s=1.0, first_only=True):
    """What a connection answers to these bytes: the first answer, or all until it says nothing more for `patience_s`."""
    with Wire(port) as wire:
        wire.send(data)
        return replies(wire.receive(patience_s, enough=is_whole if first_only else None))


def ask_all(port, requests, patience_s=0.5, first_only=True):
    """(request, answers) of each, AT_ONCE of them at a time."""
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        yield from zip(requests, pool.map(lambda request: ask(port, request, patience_s, first_only), requests))


def crowd(port, count, **options):
    """So many connections, each from the next address; those that were not let in are left out."""
    wires = [Wire(port, **options) for _ in range(count)]
    for wire in wires:
        wire.socket.setblocking(False)
    return [wire for wire in wires if wire.open]


def close_all(wires):
    for wire in wires:
        wire.socket.close()


def trickle(wires, data, seconds, pause_s=0.1):
    """Each connection sends the next byte of `data` every `pause_s`, for so long; how many are still open."""
    end = time.monotonic() + seconds
    for byte in data:
        for wire in wires:
            if wire.open:
                with contextlib.suppress(BlockingIOError), wire._noting_the_end():
                    wire.socket.send(bytes([byte]))
        time.sleep(pause_s)
        if time.monotonic() > end:
            break
    return sum(wire.open for wire in wires)
