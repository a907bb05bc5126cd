#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Attacks `ovimap serve` in the ways that servers are attacked, and sees it keep what docs/security.md promises.

Everything happens on this machine's loopback: attackers come from 127.0.0.2 and up, the normal client from 127.0.0.1.

Usage: attack_test.py PROGRAM [unittest's options]
"""
import contextlib
import functools
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import unittest

from bodies import Bodies
from camera import Camera
from crowds import Crowds
from framing import Framing
from handshakes import Handshakes, write_certificate
from served import TRIES, KeptWaiting, Server
from strangers import Strangers
import wire

NOT_AVAILABLE = 77
PROGRAM = None
FRAMES = 8


def ovimap(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def tried_again(case):
    """The case, which may keep the normal client waiting now and then, but not each time."""

    @functools.wraps(case)
    def run(self):
        for left in reversed(range(TRIES)):
            try:
                return case(self)
            except KeptWaiting as fault:
                if not left:
                    raise
                print(f"{case.__name__}: {fault}; tried again", file=sys.stderr)
                self.setUp()

    return run


class Attacked:
    """Cases are run against a server, which is started anew after one that it did not survive."""

    is_live = False

    def __init_subclass__(cls):
        super().__init_subclass__()  # unittest's
        for name in unittest.TestLoader().getTestCaseNames(cls):
            setattr(cls, name, tried_again(getattr(cls, name)))

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        ovimap("synth", cls.folder / "synth", "--room", "tiny", "--frames", FRAMES)
        cls.room = cls.folder / "synth/room"
        cls.server = None

    @classmethod
    def tearDownClass(cls):
        code = cls.server.stop()[0] if cls.server else 0
        cls.scratch.cleanup()
        assert code == 0, f"the server ended with {code}"  # a sanitizer's report alone shows here

    def setUp(self):
        cls = type(self)
        if cls.server is None:
            cls.server = self.start()
        with contextlib.suppress(OSError):
            pathlib.Path(f"/proc/{cls.server.process.pid}/clear_refs").write_text("5")  # the peak of memory is that of a case

    def rename(self, *lines, **options):
        return wire.rename(self.server.instances[0] if self.server.instances else 1, *lines, **options)

    def assert_refused(self, requests, statuses=range(400, 600), patience_s=0.5):
        """Each is answered by a refusal, or not at all: where a request has no sound end the connection is closed."""
        for request, answers in wire.ask_all(self.server.port, list(requests), patience_s):
            for reply in answers:
                self.assertIn(reply.status, statuses, f"{request[:300]!r} ... was answered {reply}")

    @contextlib.contextmanager
    def watched(self, bounded_memory=True):
        server = self.server
        try:
            with server.watched(bounded_memory and not self.is_live, self.is_live):
                yield
            assert self.is_live or server.named() == server.names, "an object was renamed"
        except Exception:
            type(self).server = None  # the next case gets a sound one
            server.process.kill()
            server.stop()
            raise


class WithStillMap(Attacked):
    @classmethod
    def served_map(cls):
        made, served = cls.folder / "made.ovimap", cls.folder / "served.ovimap"
        if not made.exists():
            ovimap("run", cls.room, "--masks", "gt", "--encoder", "none", "-o", made, "--set", "map.voxel_size_m=0.03")
        shutil.copy(made, served)  # an attack may have changed the last one
        return served


class StillMap(Framing, Strangers, Bodies, Crowds, WithStillMap, unittest.TestCase):
    """A map that stays as it is. How requests are cut apart is the same with any map, so it is tried here alone."""

    @classmethod
    def start(cls):
        return Server(PROGRAM, cls.served_map())


class EncryptedMap(Handshakes, WithStillMap, unittest.TestCase):
    """The same behind TLS: what happens before a request is one."""

    @classmethod
    def start(cls):
        certificate, key = write_certificate(cls.folder)
        return Server(PROGRAM, cls.served_map(), "--tls-cert", certificate, "--tls-key", key, certificate=certificate)


class LiveMap(Strangers, Bodies, Crowds, Attacked, unittest.TestCase):
    """A map that is made of a camera's frames meanwhile."""

    is_live = True

    @classmethod
    def start(cls):
        cls.map = cls.folder / "live.ovimap"
        for left in cls.folder.glob("live.ovimap*"):  # by a server that did not survive
            left.unlink()
        server = Server(PROGRAM, "http", "--live", "-o", cls.map, "--encoder", "none", "--set", "map.voxel_size_m=0.03")
        cls.camera = Camera(server.port, cls.room)
        return server

    def test_zz_the_map_was_made(self):
        """Last: it ends the mapping."""
        self.camera.stop()
        self.assertEqual(self.camera.faults, [])
        self.assertEqual(self.server.ask("POST", "/api/finish")[0], 202)
        code, said = self.server.stop()
        type(self).server = None
        self.assertEqual(code, 0)
        self.assertEqual(json.loads(said)["saved"]["frames"], self.camera.taken)
        self.assertEqual(json.loads(ovimap("info", self.map, "--json"))["frames"], self.camera.taken)


def attack_all(classes):
    """Attackers mostly wait, so each class of servers is attacked by a process of its own at the same time."""
    begun = [subprocess.Popen([sys.executable, __file__, PROGRAM, case.__name__], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) for case in classes]
    for case, process in zip(classes, begun):
        print(f"{case.__name__}:\n{process.communicate()[0]}", flush=True)
    return int(any(process.returncode for process in begun))


def main():
    global PROGRAM
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard < 2000:
        print(f"a process may open {hard} files, the attacks need 2000; raise it: ulimit -n")
        return NOT_AVAILABLE
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, 2000), hard))
    return unittest.main() if sys.argv[1:] else attack_all([StillMap, EncryptedMap, LiveMap])


if __name__ == "__main__":
    sys.exit(main())
