# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Many clients, slow ones, and those that go away in the middle."""
import random
import time

import wire

CROWD = 300  # more than the server serves at once


class Crowds:
    """Cases for any server."""

    def held(self, request, count=CROWD, seconds=2.0, **options):
        """So many connections that begin with `request` and then say nothing."""
        with self.watched():
            wires = wire.crowd(self.server.port, count, **options)
            for each in wires:
                each.send(request, 0.01)
            time.sleep(seconds)
            wire.close_all(wires)

    def test_trickled_heads_hold_nobody_up(self):
        with self.watched():
            wires = wire.crowd(self.server.port, CROWD)
            wire.trickle(wires, wire.head("GET", "/api/map", "X: " + "a" * 100).encode(), 3)
            wire.close_all(wires)

    def test_trickled_bodies_hold_nobody_up(self):
        request = wire.post("/api/query", b'{"text": "' + b"a" * 100)
        begin = request.index(b"\r\n\r\n") + 4
        with self.watched():
            wires = wire.crowd(self.server.port, CROWD)
            for each in wires:
                each.send(request[:begin], 0.01)
            wire.trickle(wires, request[begin:], 3)
            wire.close_all(wires)

    def test_large_bodies_that_stop_hold_nobody_up(self):
        self.held(wire.head("POST", "/api/frames", "Content-Type: multipart/form-data; boundary=b", "Content-Length: 33000000") + "a" * 60_000)

    def test_silent_connections_hold_nobody_up(self):
        self.held("", count=1000)

    def test_kept_connections_hold_nobody_up(self):
        self.held(wire.head("GET", "/api/map"), count=1000)

    def test_event_streams_hold_nobody_up(self):
        self.held(wire.head("GET", "/api/events"), receive_buffer=4096)

    def test_slow_readers_hold_nobody_up(self):
        chunks = self.server.get("/api/mesh?level=0")["chunks"]
        largest = max(chunks, key=lambda chunk: chunk["vertices"], default={"x": 0, "y": 0, "z": 0})
        path = "/api/mesh/0/{x}/{y}/{z}".format(**largest)
        self.held(wire.head("GET", path) * 5 + wire.head("GET", "/api/openapi.json") * 5, seconds=4, receive_buffer=4096)

    def test_slow_readers_who_keep_coming_hold_nobody_up(self):
        """All places are taken by replies that nobody reads, and each new connection needs another's place."""

        def comers(count):
            wires = wire.crowd(self.server.port, count, receive_buffer=4096)
            for each in wires:
                each.send(wire.head("GET", "/api/openapi.json") * 20, 0.01)
            return wires

        with self.watched():
            wires = comers(3 * CROWD)
            end = time.monotonic() + 3
            while time.monotonic() < end:
                for each in wires[:20]:
                    each.reset()
                wires = wires[20:] + comers(20)
            wire.close_all(wires)

    def test_pipelined_requests_are_answered_or_refused(self):
        with self.watched():
            for count in (10, 100, 500):
                answers = wire.ask(self.server.port, wire.head("GET", "/api/map") * count, 0.5, first_only=False)
                self.assertTrue(answers, f"none of {count} was answered")
                self.assertLessEqual(len(answers), count)
                self.assertTrue(all(reply.status in (200, 429) for reply in answers), answers)

    def test_pipelined_corrections_change_nothing_unasked(self):
        foreign = self.rename(host="Host: evil.example")
        with self.watched():
            for reply in wire.ask(self.server.port, wire.head("GET", "/api/map").encode() + foreign * 100, 0.5, first_only=False)[1:]:
                self.assertGreaterEqual(reply.status, 400)

    def test_clients_that_reset_are_forgotten(self):
        requests = (wire.head("GET", "/api/openapi.json") * 20, wire.head("GET", "/api/events"), wire.post("/api/query", b"a" * 60_000)[:30_000],
                    "GET /api/m", wire.head("GET", "/api/mesh?level=0"))  # fmt: skip
        chance = random.Random(1)
        with self.watched():
            for number in range(400):
                attacker = wire.Wire(self.server.port)
                attacker.send(requests[number % len(requests)], 0.2)
                if chance.random() < 0.3:
                    attacker.receive(0.01)
                attacker.reset()

    def test_a_flood_of_requests_is_shed(self):
        """From one address: it is refused sooner or later, and others never."""
        with self.watched():
            end = time.monotonic() + 3
            while time.monotonic() < end:
                with wire.Wire(self.server.port, source="127.0.0.99") as attacker:
                    attacker.send(wire.head("GET", "/api/openapi.json", "Accept-Encoding: gzip") * 200, 0.5)
                    attacker.receive(0.05)

    def test_exports_leave_others_their_turn(self):
        """The memory of exports is not bounded: each is a whole file."""
        with self.watched(bounded_memory=False):
            wires = wire.crowd(self.server.port, 24)
            for each in wires:
                each.send(wire.head("GET", "/api/export.glb"), 0.2)
            time.sleep(3)
            wire.close_all(wires)
