# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Requests whose end two readers could see at different places, and requests that have none."""
import concurrent.futures
import time

import wire

LONGEST_S = 15.0  # twice the server's patience, and some; what is not closed by then never is
PIECE = 1 << 18
JSON = "Content-Type: application/json"
CHUNKED = "Transfer-Encoding: chunked"


class Framing:
    """Cases for any server."""

    def assert_not_smuggled(self, befores):
        """`befores`: bytes after which a request lies that must not be taken for one; it would rename an object, too."""
        hidden = wire.head("GET", "/api/openapi.json").encode() + self.rename()
        requests = [before.encode("latin-1") + hidden for before in befores]
        for request, answers in wire.ask_all(self.server.port, requests, 0.3, first_only=False):
            for reply in answers:
                self.assertNotIn(b'"openapi"', reply.body, request[:300])

    def test_a_body_is_not_the_next_request(self):
        hidden = len(wire.head("GET", "/api/openapi.json").encode() + self.rename())
        methods = ("GET", "HEAD", "DELETE", "OPTIONS", "PUT", "PATCH", "TRACE", "FOO", "get", "PROPFIND")
        with self.watched():
            self.assert_not_smuggled([wire.head(method, path, f"Content-Length: {hidden}") for method in methods
                                      for path in ("/api/map", "/api/nothing", "/", "*")])  # fmt: skip

    def test_the_length_of_a_body_is_told_once(self):
        lengths = ("5\r\nContent-Length: 500", "500\r\nContent-Length: 5", "5, 500", "5 500", "+2", "-2", "0x2", "2e0", "2,", "", "2\0", "2\x0b", "99999999999999999999",
                   "18446744073709551618", "-18446744073709551614", "0" * 40 + "500", "\xb2")  # fmt: skip
        with self.watched():
            self.assert_not_smuggled([wire.head(method, "/api/query", JSON, f"Content-Length: {length}") + "{}" for method in ("POST", "GET")
                                      for length in lengths])  # fmt: skip

    def test_transfer_coding_and_length_do_not_contradict(self):
        codings = ("chunked", "identity", "xchunked", "chunked, identity", "gzip, chunked", "chunked, chunked", "\x0bchunked", " chunked ", "Chunked", '"chunked"')
        told = [(f"Transfer-Encoding: {coding}", f"Content-Length: {length}") for coding in codings for length in (5, 500)]
        told += [("Transfer-Encoding : chunked",), ("Transfer-Encoding\t: chunked",), ("X: y\r\n Transfer-Encoding: chunked",), ("Transfer-Encoding:\r\n chunked",),
                 (CHUNKED, "Transfer-Encoding: identity"), ("Transfer-Encoding: identity", CHUNKED)]  # fmt: skip
        with self.watched():
            self.assert_not_smuggled([wire.head(method, "/api/query", JSON, *lines[::order]) + "1f4\r\n" for method in ("POST", "GET")
                                      for lines in told for order in (1, -1)])  # fmt: skip

    def test_malformed_chunks_are_no_requests(self):
        chunks = ("zz\r\n", "-1\r\n", "0x5\r\n", "+5\r\n", " 5\r\n", "ffffffffffffffff\r\n", "10000000000000005\r\n", "5\r\nabcdefg\r\n", "5\nabcde\r\n", "\r\n",
                  "5;" + "e" * 20_000 + "\r\nabcde\r\n", "5\r\nabcde", "5\rabcde\r\n0\r\n", "1\r\na\r\n" * 4000, "0\r\nContent-Length: 500\r\n", "0\r\nX: y",
                  "5\r\nabcde\r\n0\n\n", "5\r\nabcde\r\n0\r", "2\r\n{}\r\n0\r\n" + "X: y\r\n" * 10_000)  # fmt: skip
        with self.watched():
            self.assert_not_smuggled([wire.head("POST", "/api/query", JSON, CHUNKED) + chunk for chunk in chunks])

    def test_malformed_heads_are_no_requests(self):
        heads = ("GET /api/map\r\n\r\n", "GET\r\n\r\n", "\r\n" * 20_000, "GET  /api/map HTTP/1.1\r\n", "GET /api/map HTTP/9.9\r\nHost: localhost\r\n\r\n", "\0" * 5000, "\xff" * 5000,
                 "GET /api/map HTTP/1.1\nHost: localhost\n", "GET /api/map HTTP/1.1\rHost: localhost\r\r", "GET /api/map HTTP/1.1\r\nHost: localhost\r\n: x\r\n",
                 "GET /api/map HTTP/1.1\r\nHost: localhost\r\nX\r\n", "GET /api/map HTTP/1.1\r\nHost: localhost\r\nX: a\0b\r\n", "\x16\x03\x01\x02\0\x01\0\x01\xfc\x03\x03" * 50,
                 "GET /api/map HTTP/1.1\r\n Host: localhost\r\n", "HTTP/1.1 200 OK\r\nContent-Length: 0\r\n\r\n", "CONNECT localhost:22 HTTP/1.1\r\nHost: localhost\r\n\r\n")  # fmt: skip
        with self.watched():
            for head, answers in wire.ask_all(self.server.port, [head.encode("latin-1") for head in heads]):
                for reply in answers:
                    self.assertTrue(reply.status == 200 or reply.status >= 400, f"{head[:60]!r}: {reply}")

    def assert_cut_off(self, attacks):
        """`attacks`: what a connection begins with, and what it repeats without an end."""

        def is_cut_off(attack):
            end = time.monotonic() + LONGEST_S
            with wire.Wire(self.server.port) as attacker:
                attacker.send(attack[0])
                while attacker.open and attacker.send(attack[1]) and time.monotonic() < end:
                    time.sleep(0.001)  # some 100 MB a second: the machine has others to serve
                return not attacker.open

        with self.watched(), concurrent.futures.ThreadPoolExecutor(len(attacks)) as pool:
            for (begin, _), cut_off in zip(attacks, pool.map(is_cut_off, attacks)):
                self.assertTrue(cut_off, f"the server still reads what follows {begin[:60]!r}")

    def test_the_http_2_preface_is_no_request(self):
        self.assert_cut_off([("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", b"\0" * PIECE)])

    def test_endless_heads_are_cut_off(self):
        line, lines, nothing = b"a" * PIECE, b"a: b\r\n" * (PIECE // 6), b"\r\n" * (PIECE // 2)
        begin = "GET / HTTP/1.1\r\nHost: localhost\r\n"
        self.assert_cut_off([("GET /", line), ("GET /?", line), ("", line), ("", nothing), (begin + "X: ", line), (begin, lines), (begin + " ", line), (begin, line)])

    def test_endless_bodies_are_cut_off(self):
        large, chunk = "Content-Length: 10000000000", b"fffff\r\n" + b"a" * 0xFFFFF + b"\r\n"
        self.assert_cut_off([(wire.head(method, path, *lines), chunk if CHUNKED in lines else b"a" * PIECE)
                             for lines in ((CHUNKED,), (large,), (), ("Expect: 100-continue", large))
                             for method, path in (("POST", "/api/query"), ("POST", "/api/frames"), ("GET", "/api/map"), ("PUT", "/"))])  # fmt: skip

    def test_ten_thousand_headers_are_refused(self):
        lines = [f"X-{number}: {number}" for number in range(10_000)]
        with self.watched():
            for _, answers in wire.ask_all(self.server.port, [wire.head("GET", "/api/map", *lines)] * 20):
                for reply in answers:
                    self.assertGreaterEqual(reply.status, 400)

    def test_absurd_ranges_are_harmless(self):
        ranges = ("bytes=" + "0-0," * 1000 + "0-0", "bytes=" + "0-," * 1000 + "0-", "bytes=99999999999999999999-", "bytes=-0", "bytes=--", "bytes=5-2", "bytes=-99999999999999999999",
                  "lines=1", "bytes=0-18446744073709551615,1-2", "bytes=" + "," * 7000)  # fmt: skip
        with self.watched():
            requests = [wire.head("GET", path, f"Range: {given}", *more) for given in ranges for path in ("/api/openapi.json", "/api/map")
                        for more in ((), ("If-Range: x",))]  # fmt: skip
            for _, answers in wire.ask_all(self.server.port, requests):
                for reply in answers:
                    self.assertIn(reply.status, (200, 206, 400, 416, 431))
                    self.assertLess(len(reply.body), 1 << 18)
