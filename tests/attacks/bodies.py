# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Bodies that cost the server more than the attacker: bombs, deep nesting, parts that a parser chews on."""
import base64
import gzip
import json
import struct
import time
import zlib

import wire

POSTS = ("/api/query", "/api/corrections", "/api/camera", "/api/frames", "/api/map")  # not finish: that is for everybody
LEVELS = 500_000
FRAME = b'--b\r\nContent-Disposition: form-data; name="color"\r\n\r\n1\r\n--b\r\nContent-Disposition: form-data; name="depth"\r\n\r\n2\r\n'


def zeros_by_gzip():
    """32 MiB in 32 kB; gzip packs no better."""
    return gzip.compress(bytes(1 << 25))


def zeros_by_zstd(blocks=8000):
    """A gigabyte: blocks that repeat one byte 131,072 times, in four bytes each (RFC 8878)."""
    block = (131072 << 3) | (1 << 1)
    return b"\x28\xb5\x2f\xfd\x00\x58" + (struct.pack("<I", block)[:3] + b"\0") * blocks + struct.pack("<I", block | 1)[:3] + b"\0"


def zeros_by_brotli():
    """A gigabyte in 809 bytes."""
    return zlib.decompress(base64.b64decode(
        "eNo7//9/PYMKw6ONDkXv///8/5+/gcVBRqzh3V/7////M05g6DjMdGHv/+f//9szCDEURjDs+v7/z///7A5MCnzcDt//zQeqYvBg"
        "OJLI+OLe/8///8szcDZY6DDc/V3/7/9/ZgVGgXbWBdX/z0Mt2cBQMmrJqCVDxBKwKpgl/AD4Ra8w"))  # fmt: skip


BOMBS = {"gzip": zeros_by_gzip, "deflate": lambda: zlib.compress(bytes(1 << 25)), "br": zeros_by_brotli, "zstd": zeros_by_zstd,
         "gzip, gzip": lambda: gzip.compress(gzip.compress(bytes(1 << 27))), "x-gzip": zeros_by_gzip, "br, br": zeros_by_brotli}  # fmt: skip


def part(name, content):
    return f'--b\r\nContent-Disposition: form-data; name="{name}"\r\n\r\n'.encode() + content + b"\r\n"


def chewed_parts():
    """Lines of 8 kB that backtracking patterns take seconds over, each as a body with its Content-Type."""
    long = 8000
    lines = ('name="' + '"; filename="' * (long // 13) + "x", 'name="a"; filename="' + '"; filename*=a' * (long // 14) + " x", 'name="a"' + " " * long + "x",
             "; " * (long // 2), 'name="' + "\\" * long, 'name="' + 'a"' * (long // 2), ("; a=" + "b" * 10) * (long // 14), " \t" * (long // 2),
             'filename*=UTF-8\'\'' + "%" * long, '"' * long, "a=" * (long // 2))  # fmt: skip
    for line in lines:
        content = f"--b\r\nContent-Disposition: form-data; {line}\r\n\r\n1\r\n".encode()
        yield content * 7 + b"--b--\r\n", "multipart/form-data; boundary=b"
    for boundary in ("-" * long, '"' + "\\" * long, "b" * long + "; " * 30, ";" * long):
        yield (boundary[:60].encode() + b"\r\n") * 500, f"multipart/form-data; boundary={boundary}"
    yield b"--b\r\n" * 12000, "multipart/form-data; boundary=b"
    yield b"--b" * 21000, "multipart/form-data; boundary=b"
    yield b"-" * 65000, "multipart/form-data; boundary=" + "-" * 70
    yield b"--b\r\n" + b"a:b\r\n" * 12000, "multipart/form-data; boundary=b"
    yield b"\r\n--" * 16000, "multipart/form-data; boundary=b"


class Bodies:
    """Cases for any server."""

    def test_packed_bodies_are_refused_before_they_come(self):
        requests = []
        for encoding, bomb in BOMBS.items():
            packed = bomb()
            for path in POSTS:
                kind = "multipart/form-data; boundary=b" if path == "/api/frames" else "application/json"
                requests.append(wire.post(path, packed, f"Content-Encoding: {encoding}", kind=kind))
        with self.watched():
            self.assert_refused(requests, [415])
            for request, answers in wire.ask_all(self.server.port, [request[: request.index(b"\r\n\r\n") + 14] for request in requests]):
                self.assertEqual([reply.status for reply in answers], [415], f"{request!r}, of which ten bytes came")

    def test_deep_json_is_refused(self):
        wraps = (("", ""), ('{"a":', "}"), ('{"camera":[', "]}"), ('{"text":', "}"), ('{"instances":', "}"))
        deep = [opening + "[" * levels + "]" * levels + closing for opening, closing in wraps for levels in (100, 30_000, LEVELS)]
        deep += [(opening or "[") * count for opening, _ in wraps for count in (5_000, LEVELS)]
        with self.watched():
            self.assert_refused(wire.post(path, body) for path in POSTS for body in deep)

    def test_deep_json_in_a_frame_is_refused(self):
        deep = [f"{opening}{'[' * levels}{']' * levels}{closing}".encode() for opening, closing in (("", ""), ('{"pose":', "}"), ('{"name":', "}"))
                for levels in (100, 100_000, LEVELS)]  # fmt: skip
        deep += [b"[" * LEVELS, b'{"pose":' * LEVELS]
        with self.watched():
            self.assert_refused(wire.post("/api/frames", FRAME + part("frame", content) + b"--b--\r\n", kind="multipart/form-data; boundary=b")
                                for content in deep)  # fmt: skip

    def test_parts_cost_no_more_than_their_bytes(self):
        requests = [wire.post(path, body, kind=kind) for path in ("/api/frames", "/api/query", "/api/map") for body, kind in chewed_parts()]
        with self.watched():
            before = self.server.cpu_s()
            self.assert_refused(requests, patience_s=20)
            cpu_s = self.server.cpu_s() - before
        if not self.is_live:  # 20 ms for a body of 64 kB; the rest is for the normal client
            self.assertLess(cpu_s, 0.5 + 0.02 * len(requests), f"CPU seconds for {len(requests)} bodies")

    def test_odd_json_is_answered(self):
        bodies = (b"\xff\xfe{\0}\0", b'{"text": "\xff"}', b'{"text": "\\ud800"}', b'{"text": NaN}', b'{"text": 1e999}', b"{" * 60_000, b'"' * 60_000,
                  b'{"text": "a", "text": "b"}', b'{"kind": "rename", "instance": 1e300, "name": "owned"}', b'{"instance": -1, "kind": "hide"}',
                  b'{"kind": "undo", "edit": 99999999999999999999}', b"1" * 60_000, b'{"camera": {"width": 1e308}}', json.dumps({"text": "a" * 60_000}).encode(),
                  b"[" + b"{}," * 20_000 + b"{}]", b"\0" * 60_000)  # fmt: skip
        with self.watched():
            self.assert_refused(wire.post(path, body) for path in POSTS for body in bodies)
