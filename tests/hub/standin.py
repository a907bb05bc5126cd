# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A model hub that answers as the real one does, as far as `ovimap models fetch` asks, and fails where a test wants it.

Small files come from the hub itself; large ones (LFS) are redirected to a second server, on another port and so another
origin, as the real hub redirects to its content network."""
import hashlib
import http.server
import json
import re
import threading
import urllib.parse

COMMIT = "0123456789abcdef0123456789abcdef01234567"
API = re.compile(r"^/api/models/(?P<repo>[^/]+/[^/]+)/(?P<what>revision|tree)/(?P<revision>[^/?]+)$")
RESOLVE = re.compile(r"^/(?P<repo>[^/]+/[^/]+)/resolve/(?P<revision>[^/]+)/(?P<path>.+)$")


def git_blob(content):
    return hashlib.sha1(b"blob %d\0" % len(content) + content).hexdigest()


class Repository:
    def __init__(self, files, commit=COMMIT):
        self.files, self.commit = files, commit
        self.listed_bytes = {}  # path: another size than the file has

    @staticmethod
    def is_large(path):
        return path.endswith((".onnx", ".onnx_data", ".model")) or path == "tokenizer.json"

    def entry(self, path):
        content = self.files[path]
        size = self.listed_bytes.get(path, len(content))
        entry = {"type": "file", "oid": git_blob(content), "size": size, "path": path}
        if self.is_large(path):
            pointer = b"version https://git-lfs.github.com/spec/v1"
            entry["oid"] = git_blob(pointer)
            entry["lfs"] = {"oid": hashlib.sha256(content).hexdigest(), "size": size, "pointerSize": 134}
            entry["xetHash"] = "0" * 64
        return entry


class Faults:
    """What goes wrong, for requests whose path holds `where`."""

    def __init__(self):
        self.token = None  # the one that is accepted; None: any, and none
        self.statuses = []  # of the next answers, one each; then all is well
        self.retry_after = None
        self.cut_after = []  # bytes after which the next transfers break
        self.no_ranges = False
        self.other_content = {}  # path: what comes instead
        self.loop = False
        self.page = 1000  # files on a page of the list
        self.where = ""


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def do_GET(self):
        url = urllib.parse.urlsplit(self.path)  # a proxy is asked for whole addresses
        hub = self.server.hub
        hub.requests.append((self.server.name, url.path, dict(self.headers), self.path))
        faults = hub.faults
        if faults.statuses and faults.where in url.path:
            return self.refuse(faults.statuses.pop(0))
        if self.server.name == "content":
            return self.blob(urllib.parse.unquote(url.path.removeprefix("/blobs/")))
        if faults.token and self.headers.get("Authorization") != f"Bearer {faults.token}":
            return self.refuse(401)
        if found := API.match(url.path):
            return self.api(found, urllib.parse.parse_qs(url.query))
        if found := RESOLVE.match(url.path):
            return self.resolve(found)
        return self.answer(200, b"hub") if url.path == "/" else self.refuse(404)

    def api(self, found, query):
        repository = self.server.hub.repositories.get(found["repo"])
        if repository is None or found["revision"] not in ("main", repository.commit):
            return self.refuse(404)
        if found["what"] == "revision":
            return self.json({"id": found["repo"], "sha": repository.commit})
        assert query["recursive"] == ["true"]
        entries = [{"type": "directory", "oid": "0" * 40, "size": 0, "path": "onnx"}]
        entries += [repository.entry(path) for path in repository.files]
        page, start = self.server.hub.faults.page, int(query.get("cursor", ["0"])[0])
        head = {}
        if start + page < len(entries):
            address = f"{self.server.hub.address}{found[0]}?recursive=true&cursor={start + page}"
            head["Link"] = f'<{address}>; rel="next"'
        return self.json(entries[start : start + page], head)

    def resolve(self, found):
        hub = self.server.hub
        repository, path = hub.repositories.get(found["repo"]), urllib.parse.unquote(found["path"])
        if repository is None or found["revision"] != repository.commit or path not in repository.files:
            return self.refuse(404)
        if hub.faults.loop:
            return self.answer(302, b"", {"Location": self.path})
        if not repository.is_large(path):
            return self.content(path, repository.files[path])
        where = f"{hub.content_address}/blobs/{found['repo']}/{path}?X-Signature=1"
        return self.answer(302, b"Found. Redirecting", {"Location": where})

    def blob(self, path):
        owner, name, path = path.split("/", 2)
        return self.content(path, self.server.hub.repositories[f"{owner}/{name}"].files[path])

    def content(self, path, content):
        faults = self.server.hub.faults
        content = faults.other_content.get(path, content)
        status, head, start = 200, {"Accept-Ranges": "bytes"}, 0
        asked = re.fullmatch(r"bytes=(\d+)-", self.headers.get("Range", ""))
        if asked and not faults.no_ranges:
            start = int(asked[1])
            if start >= len(content):
                return self.answer(416, b"", {"Content-Range": f"bytes */{len(content)}"})
            status = 206
            head["Content-Range"] = f"bytes {start}-{len(content) - 1}/{len(content)}"
        if faults.cut_after and faults.where in path and len(content) - start > faults.cut_after[0]:
            return self.break_off(status, content[start:], head, faults.cut_after.pop(0))
        return self.answer(status, content[start:], head)

    def break_off(self, status, content, head, after):
        self.answer(status, content[:after], head | {"Content-Length": str(len(content))})
        self.wfile.flush()
        self.connection.shutdown(2)
        self.close_connection = True

    def refuse(self, status):
        wait = self.server.hub.faults.retry_after
        self.answer(status, b'{"error":"no"}', {"Retry-After": wait} if wait is not None else {})

    def json(self, value, head=None):
        self.answer(200, json.dumps(value).encode(), (head or {}) | {"Content-Type": "application/json"})

    def answer(self, status, body, head=None):
        self.send_response(status)
        for name, value in ({"Content-Length": str(len(body))} | (head or {})).items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)


class Hub:
    """Two servers on ports of the kernel's choice. `requests`: (server, path, headers, address) of each that came."""

    def __init__(self):
        self.repositories, self.faults, self.requests = {}, Faults(), []
        self.servers = [self.serve(name) for name in ("hub", "content")]
        self.address, self.content_address = (f"http://127.0.0.1:{s.server_address[1]}" for s in self.servers)

    def serve(self, name):
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        server.name, server.hub, server.daemon_threads = name, self, True
        threading.Thread(target=server.serve_forever, daemon=True).start()
        return server

    def asked(self, part):
        """The headers of the requests whose path holds `part`."""
        return [(server, headers) for server, path, headers, _ in self.requests if part in path]

    def close(self):
        for server in self.servers:
            server.shutdown()
            server.server_close()
