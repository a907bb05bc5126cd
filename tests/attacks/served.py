# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The program under attack, what it promises meanwhile, and the normal client that sees whether it holds.

A promise of time cannot be held by a busy machine. So the normal client also asks a server that nobody attacks, and the
server under attack may take longer by ten times what that one takes. And what an attack does it does again: a case that
kept the client waiting is tried anew, and fails the third time.
"""
import contextlib
import json
import os
import pathlib
import queue
import signal
import subprocess
import sys
import threading
import time

import witness

HERE = pathlib.Path(__file__).parent
MOST_GROWTH_BYTES = 64 << 20
USUAL_S, USUAL_SHARE = 0.2, 0.98  # this share of the normal client's requests is answered within that time,
SLOWEST_S = 2.0  # ... and each within this
BUSY_FACTOR = 10  # of the echo's time, on top
TRIES = 3
PATIENCE_S = 10.0  # more than the normal client has
SHORTEST_WATCH_S = 1.0  # that is about a hundred requests
# ThreadSanitizer keeps several bytes for each byte in use and makes the program many times slower: what is promised of memory and of
# time is promised of the program without it. That everybody is answered holds with it as well.
KEEPS_BOUNDS = os.environ.get("OVIMAP_SANITIZER") != "thread"


class KeptWaiting(AssertionError):
    """The normal client was not served in time."""


class Witness:
    """The normal client, in a process of its own from now on."""

    def __init__(self, port, certificate):
        self._echo = subprocess.Popen([sys.executable, HERE / "echo.py"], stdout=subprocess.PIPE, text=True)
        echo_port = self._echo.stdout.readline().strip()
        self._client = subprocess.Popen([sys.executable, HERE / "witness.py", str(port), echo_port, *([certificate] if certificate else [])], stdout=subprocess.PIPE, text=True)
        self._lines = queue.SimpleQueue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self._client.stdout:
            self._lines.put(tuple(map(float, line.split())))

    def requests(self):
        """(begin, seconds or -1, seconds of the echo) of each request since the last call, also of the one that waits now."""
        now, found = time.monotonic(), []
        with contextlib.suppress(queue.Empty):
            while not found or found[-1][0] < now:
                found.append(self._lines.get(timeout=PATIENCE_S))
        return found

    def stop(self):
        for process in (self._client, self._echo):
            process.kill()
            process.wait()
            process.stdout.close()


def fault_of(requests, mapping):
    """What the normal client has to complain of; empty: nothing. A mapping takes the processors, too: then only the
    slowest counts."""
    if not requests:
        return "the normal client got no answer at all"
    failed = [request for request in requests if request[1] < 0]
    if failed:
        return f"{len(failed)} of {len(requests)} requests of the normal client failed"
    if not KEEPS_BOUNDS:
        return ""
    took, echo = (sorted(column) for column in list(zip(*requests))[1:])
    usual = int(USUAL_SHARE * (len(took) - 1))
    allowed, slowest_allowed = USUAL_S + BUSY_FACTOR * echo[usual], SLOWEST_S + BUSY_FACTOR * echo[-1]
    if (took[usual] > allowed and not mapping) or took[-1] > slowest_allowed:
        return (f"{USUAL_SHARE:.0%} of {len(took)} requests took up to {took[usual]:.3f} s, the slowest {took[-1]:.3f} s; "
                f"promised are {allowed:.3f} and {slowest_allowed:.3f} s")  # fmt: skip
    return ""


class Server:
    """`ovimap serve ARGUMENTS`, and its normal client. `certificate`: that of a server of encrypted connections."""

    def __init__(self, program, *arguments, certificate=None):
        self.context = witness.trusting(certificate)
        # AddressSanitizer keeps what was freed for a while, up to 256 MB unless told otherwise; that is no growth.
        environment = os.environ | {"ASAN_OPTIONS": ":".join(filter(None, [os.environ.get("ASAN_OPTIONS"), "quarantine_size_mb=4"]))}
        self.process = subprocess.Popen([program, "serve", *map(str, arguments), "--port", "0", "--viewer", "none", "--json"],
                                        stdout=subprocess.PIPE, text=True, env=environment)  # fmt: skip
        self.port = json.loads(self.process.stdout.readline())["port"]
        self.instances = [entry["id"] for entry in self.get("/api/instances")["instances"]]
        self.names = self.named()
        self.witness = Witness(self.port, certificate)
        time.sleep(0.5)
        self.witness.requests()
        self.start_bytes = self.resident("VmRSS")

    def ask(self, method, path, body=None, headers=None):
        """As a normal client; (status, value)."""
        connection = witness.connection_to(self.port, self.context, timeout=20)
        try:
            connection.request(method, path, body, headers or {})
            reply = connection.getresponse()
            return reply.status, json.loads(reply.read())
        finally:
            connection.close()

    def get(self, path):
        status, value = self.ask("GET", path)
        assert status == 200, (path, status, value)
        return value

    def named(self):
        return {entry["id"]: entry["name"] for entry in self.get("/api/instances")["instances"]}

    def resident(self, key):
        """Bytes; VmRSS: now, VmHWM: at most so far."""
        lines = pathlib.Path(f"/proc/{self.process.pid}/status").read_text().splitlines()
        return 1024 * next(int(line.split()[1]) for line in lines if line.startswith(key))

    def cpu_s(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    @contextlib.contextmanager
    def watched(self, bounded_memory=True, mapping=False):
        """Raises AssertionError when, in this block, the server does not keep what it promises."""
        self.witness.requests()
        begin = time.monotonic()
        yield
        time.sleep(max(0.0, begin + SHORTEST_WATCH_S - time.monotonic()))
        assert self.process.poll() is None, f"the server ended with {self.process.poll()}"
        grown = self.resident("VmHWM") - self.start_bytes
        fault = fault_of(self.witness.requests(), mapping)
        if fault:
            raise KeptWaiting(fault)
        assert not (bounded_memory and KEEPS_BOUNDS) or grown < MOST_GROWTH_BYTES, f"resident memory grew by {grown >> 20} MiB"
        assert self.ask("GET", "/api/map")[0] == 200

    def stop(self):
        """How the program ended after Ctrl-C, and what it printed."""
        self.witness.stop()
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            said = self.process.communicate(timeout=60)[0]
        except subprocess.TimeoutExpired:
            self.process.kill()
            said = self.process.communicate()[0]
        return self.process.returncode, said
