#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writing on things, from frames to answers: a wall with two signs is mapped, read and searched, with the real model.

Usage: writing_test.py PROGRAM
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from PIL import Image, ImageDraw, ImageFont

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
WIDTH, HEIGHT, FOCAL = 640, 480, 525.0
# Boards in front of a wall: left, top, right, bottom in pixels, and what stands on them.
SIGNS = {1: ((60, 150, 290, 300), "EXIT"), 2: ((350, 150, 600, 300), "LIBRARY")}
WALL_M, BOARD_M = 2.0, 1.8


def picture():
    image = Image.new("RGB", (WIDTH, HEIGHT), (150, 160, 150))
    draw = ImageDraw.Draw(image)
    for box, text in SIGNS.values():
        draw.rectangle(box, fill=(245, 245, 240))
        draw.text(((box[0] + box[2]) / 2, (box[1] + box[3]) / 2), text, fill=(20, 20, 30), anchor="mm", font=ImageFont.load_default(size=48))
    return image


def write_recording(folder):
    """A camera that stands still, in the layout of 7-Scenes with masks beside it."""
    depth = np.full((HEIGHT, WIDTH), 1000 * WALL_M, np.uint16)
    masks = np.full((HEIGHT, WIDTH), 3, np.uint16)
    for number, (box, _) in SIGNS.items():
        where = np.s_[box[1] : box[3] + 1, box[0] : box[2] + 1]
        depth[where], masks[where] = 1000 * BOARD_M, number
    (folder / "masks").mkdir(parents=True)
    (folder / "room").mkdir()
    (folder / "room" / "calibration.yaml").write_text(
        f"camera: {{width: {WIDTH}, height: {HEIGHT}, fx: {FOCAL}, fy: {FOCAL}, cx: {(WIDTH - 1) / 2}, cy: {(HEIGHT - 1) / 2}, "
        "depth_scale: 1000}\n")
    for frame in range(12):
        stem = folder / "room" / f"frame-{frame:06d}"
        picture().save(f"{stem}.color.png")
        Image.fromarray(depth).save(f"{stem}.depth.png")
        pathlib.Path(f"{stem}.pose.txt").write_text("1 0 0 0\n0 0 1 0\n0 -1 0 1\n0 0 0 1\n")
        Image.fromarray(masks).save(folder / "masks" / f"frame-{frame:06d}.png")


class Writing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.scratch.name)
        write_recording(folder)
        cls.map = folder / "signs.ovimap"
        cls.mapping = ["run", folder / "room", "--masks", folder / "masks", "--encoder", "default", "-o", cls.map,
                       "--set", "view_interval=1", "--set", "mask_interval=1", "--set", "allow_still_camera=true"]
        cls.run_program(*cls.mapping, "--frames", ":9")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @staticmethod
    def run_program(*command, accepted=(0,)):
        made = subprocess.run([PROGRAM, *map(str, command)], capture_output=True, text=True)
        if made.returncode not in accepted:
            raise AssertionError(f"{command} gave {made.returncode}: {made.stderr}")
        return made.stdout if made.returncode != 2 else made.stderr

    def answer(self, text):
        return json.loads(self.run_program("query", self.map, text, "--json", accepted=(0, 1)))["results"][0]

    def test_1_text_is_refused_before_it_was_read(self):
        self.assertIn("ovimap read", self.run_program("query", self.map, 'text:"exit"', accepted=(2,)))

    def test_2_signs_are_read_and_found(self):
        read = json.loads(self.run_program("read", self.map, "--json"))
        texts = {line["text"].upper() for thing in read["instances"] for line in thing["writing"]}
        self.assertEqual(texts, {"EXIT", "LIBRARY"})
        found = {}
        for text in ("exit", "library"):
            answer = self.answer(f'text:"{text}"')
            self.assertEqual(answer["verdict"], "found")
            self.assertEqual(len(answer["instances"]), 1)
            self.assertIn(text.upper(), answer["instances"][0]["evidence"])
            found[text] = answer["instances"][0]["id"]
            # Words alone find it as well.
            self.assertEqual(self.answer(f"the {text} sign")["instances"][0]["id"], found[text])
        self.assertNotEqual(found["exit"], found["library"])
        self.assertNotEqual(self.answer('text:"kitchen"')["verdict"], "found")

    def test_3_reading_again_changes_nothing(self):
        before = self.map.read_bytes()
        self.run_program("read", self.map)
        self.assertEqual(self.map.read_bytes(), before)

    def test_4_info_tells_it(self):
        info = json.loads(self.run_program("info", self.map, "--json"))
        self.assertEqual(info["writing"]["reader"], "PP-OCRv6 small")
        self.assertEqual(len(info["writing"]["objects"]), 2)

    def test_5_more_frames_keep_what_was_read(self):
        before = json.loads(self.run_program("info", self.map, "--json"))
        made = subprocess.run([PROGRAM, *map(str, self.mapping), "--resume"], capture_output=True, text=True)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertIn("`ovimap read` reads what the new frames show", made.stderr)
        info = json.loads(self.run_program("info", self.map, "--json"))
        self.assertEqual((before["frames"], info["frames"]), (9, 12))
        self.assertEqual(info["writing"], before["writing"])
        self.assertEqual(self.answer('text:"library"')["verdict"], "found")

    def test_6_frames_are_embedded_as_the_map_is(self):
        mapping = ["none" if word == "default" else str(word) for word in self.mapping]
        refused = subprocess.run([PROGRAM, *mapping, "--resume"], capture_output=True, text=True)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("this run has no encoder; give that model to --encoder", refused.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
