# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What comes before a request where connections are encrypted: handshakes that stop, that never were one, and too many."""
import concurrent.futures
import contextlib
import os
import ssl
import subprocess
import time

import wire

CROWD = 300  # more than the server serves at once


def write_certificate(folder):
    """A key and a certificate for localhost that it signs itself; (certificate, key)."""
    certificate, key = folder / "cert.pem", folder / "key.pem"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "1",
                    "-subj", "/CN=localhost", "-keyout", key, "-out", certificate], check=True, capture_output=True)  # fmt: skip
    return certificate, key


def stranger():
    """An attacker trusts anybody."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    return context


def client_hello():
    """The first bytes of a sound handshake."""
    outgoing = ssl.MemoryBIO()
    connection = stranger().wrap_bio(ssl.MemoryBIO(), outgoing)
    with contextlib.suppress(ssl.SSLWantReadError):
        connection.do_handshake()
    return outgoing.read()


class Handshakes:
    """Cases for a server of encrypted connections."""

    def greeted(self, greeting, count=CROWD, seconds=2.0):
        """So many connections that send this and then say nothing."""
        with self.watched():
            wires = wire.crowd(self.server.port, count)
            for each in wires:
                each.send(greeting, 0.01)
            time.sleep(seconds)
            wire.close_all(wires)

    def test_silence_before_the_handshake_holds_nobody_up(self):
        self.greeted(b"", count=1000)

    def test_handshakes_that_stop_hold_nobody_up(self):
        hello = client_hello()
        self.greeted(hello[: len(hello) // 2])
        self.greeted(hello)  # the server's answer is never taken up

    def test_trickled_handshakes_hold_nobody_up(self):
        with self.watched():
            wires = wire.crowd(self.server.port, CROWD)
            wire.trickle(wires, client_hello(), 3)
            wire.close_all(wires)

    def test_what_is_no_handshake_is_hung_up_on(self):
        huge = b"\x16\x03\x01\xff\xff" + b"a" * 70_000  # a record longer than any may be
        plain = wire.head("GET", "/api/map").encode()
        with self.watched():
            for data in (plain, self.rename(), b"\x00" * 4096, os.urandom(4096), huge, client_hello() + b"\x00" * 4096):
                with wire.Wire(self.server.port) as attacker:
                    attacker.send(data)
                    self.assertFalse(attacker.receive(3).startswith(b"HTTP/"), data[:40])
                    self.assertFalse(attacker.open, f"{data[:40]!r} ... was not hung up on")

    def test_a_flood_of_handshakes_leaves_others_their_turn(self):
        context = stranger()

        def greet(until):
            count = 0
            while time.monotonic() < until:
                with wire.Wire(self.server.port) as attacker, contextlib.suppress(OSError), context.wrap_socket(attacker.socket):
                    count += 1
            return count

        with self.watched():
            until = time.monotonic() + 3
            with concurrent.futures.ThreadPoolExecutor(4) as pool:
                self.assertGreater(sum(pool.map(greet, [until] * 4)), 20)

    def test_requests_within_a_handshake_are_judged_as_others(self):
        context = stranger()
        with self.watched():
            for request, statuses in ((self.rename(host="Host: evil.example"), range(400, 500)), (wire.head("BREW", "/api/map").encode(), range(400, 600)),
                                      (wire.head("GET", "/api/map", "X: " + "a" * 1_000_000).encode(), range(400, 500))):  # fmt: skip
                with (wire.Wire(self.server.port) as attacker, contextlib.suppress(ConnectionError, ssl.SSLError),
                      context.wrap_socket(attacker.socket) as safe):  # fmt: skip
                    safe.sendall(request)
                    for reply in wire.replies(safe.recv(1 << 16)):
                        self.assertIn(reply.status, statuses)
