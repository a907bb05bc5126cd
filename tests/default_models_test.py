#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""An installed program finds what was installed with it, and gets the default encoder by what a wheel brings.

The building itself needs the network: tools/packages_test.sh tries it. Usage: default_models_test.py PROGRAM
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

FETCHER = pathlib.Path(__file__).resolve().parents[1] / "tools/models/fetch_default_encoder.py"
BUILDS = """import pathlib, sys
folder = pathlib.Path(sys.argv[1])
folder.mkdir(parents=True)
(folder / "model.yaml").write_text("kind: dual_encoder")
print("building")
"""
FAILS = "import sys; sys.exit('ovimap: no network')"


class InstalledProgram(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.prefix = pathlib.Path(self.scratch.name).resolve()
        (self.prefix / "bin").mkdir()
        self.program = self.prefix / "bin/ovimap"
        shutil.copy(PROGRAM, self.program)
        self.models = self.prefix / ".local/share/ovimap/models"

    def builder(self, text):
        folder = self.prefix / "share/ovimap/encoder"
        folder.mkdir(parents=True)
        (folder / "fetch_default_encoder.py").write_text(text)

    def run_program(self, *words):
        environment = {"HOME": str(self.prefix), "PATH": os.environ["PATH"], "OVIMAP_PYTHON": sys.executable}
        return subprocess.run([self.program, "models", *words], cwd=self.prefix, env=environment, capture_output=True, text=True)

    def test_models_that_a_package_brought_are_found_last(self):
        brought = self.prefix / "share/ovimap/models"
        brought.mkdir(parents=True)
        self.models.mkdir(parents=True)
        self.assertEqual(self.run_program("path").stdout.splitlines(), [str(self.models), str(brought)])

    def test_without_a_builder_the_remedy_is_named(self):
        ended = self.run_program("fetch", "default")
        self.assertEqual(ended.returncode, 2)
        self.assertIn("tools/setup.sh", ended.stderr)

    def test_the_encoder_is_built_once_where_the_user_may_write(self):
        (self.prefix / "share/ovimap/models").mkdir(parents=True)
        self.builder(BUILDS)
        ended = self.run_program("fetch", "default")
        self.assertEqual((ended.returncode, ended.stdout), (0, f"{self.models}/default-encoder: made\n"), ended.stderr)
        self.assertIn("building", ended.stderr)
        again = self.run_program("fetch", "default", "--json")
        self.assertIn('"was_there": true', again.stdout)

    def test_a_failed_build_says_why(self):
        self.builder(FAILS)
        ended = self.run_program("fetch", "default")
        self.assertEqual((ended.returncode, ended.stdout), (2, ""))
        self.assertIn("no network", ended.stderr)


class Fetcher(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name) / "models/default-encoder"

    def test_no_index_leaves_nothing_behind(self):
        nowhere = {**os.environ, "PIP_INDEX_URL": "http://127.0.0.1:9/simple", "PIP_RETRIES": "0", "PIP_CONFIG_FILE": os.devnull}
        ended = subprocess.run([sys.executable, FETCHER, self.folder], env=nowhere, capture_output=True, text=True)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("check the network, pip and its index", ended.stderr)
        self.assertEqual(list(self.folder.parent.iterdir()), [])

    def test_a_python_without_pip_is_told_the_remedy(self):
        bare = pathlib.Path(self.scratch.name) / "bare"
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", bare], check=True)
        ended = subprocess.run([bare / "bin/python", FETCHER, self.folder], capture_output=True, text=True)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("-m ensurepip", ended.stderr)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
