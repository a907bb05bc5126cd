# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Web pages that try to reach the server by a name of their own (DNS rebinding), and paths that lead out of the viewer."""
import wire

FOREIGN = ("evil.example", "127.0.0.1.rebind.example", "127.0.0.1.rebind.example:8080", "localhost.evil.example", "[::1].evil", "[::1",
           "::1.evil", "[::1]:80.evil", "127.0.0.1@evil.example", "evil.example@127.0.0.1", "127.0.0.1:80@evil.example", "127.0.0.1:x",
           "127.0.0.1 evil.example", "localhost, evil.example", "localhost/evil.example", "localhost#.evil.example", "127.0.0.1\\evil.example",
           "127.evil", "127.0.0.1.", "127.0.0.256", "0x7f.evil", "localhostevil", "")  # fmt: skip


class Strangers:
    """Cases for any server."""

    def test_names_of_other_machines_are_refused(self):
        with self.watched():
            self.assert_refused(self.rename(host=f"Host: {name}") for name in FOREIGN)
            self.assert_refused(f"GET /api/map HTTP/1.1\r\nHost: {name}\r\n\r\n" for name in FOREIGN)

    def test_a_request_has_one_host(self):
        with self.watched():
            several = ("Host: localhost\r\nHost: evil.example", "Host: evil.example\r\nHost: localhost", "Host: localhost\r\nHost: localhost",
                       "Host: evil.example\r\nX-Forwarded-Host: localhost", "X-Host: localhost", "")  # fmt: skip
            self.assert_refused(self.rename(host=hosts) for hosts in several)
            self.assert_refused(["GET http://evil.example/api/map HTTP/1.1\r\nHost: localhost\r\n\r\n"])

    def test_other_pages_are_refused(self):
        with self.watched():
            origins = ("http://evil.example", "null", "http://localhost.evil.example", "http://localhost@evil.example", "https://localhost:1")
            self.assert_refused(self.rename(f"Origin: {origin}") for origin in origins)

    def test_paths_do_not_lead_out(self):
        with self.watched():
            paths = ("/../../../../etc/passwd", "/%2e%2e/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/..%2f..%2f..%2fetc%2fpasswd", "/%00",
                         "/..%5c..%5cetc", "/%zz", "/%", "/api/instances/%2e%2e", "/api/instances/99999999999999999999999", "/api/mesh/0/1/2/-")  # fmt: skip
            self.assert_refused(wire.head("GET", path) for path in paths)
