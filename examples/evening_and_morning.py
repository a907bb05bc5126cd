# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What changed overnight? Renders a room as the evening leaves it and as the morning finds it, maps it, goes on with that map, asks it,
and draws both from above beside what changed. Usage: evening_and_morning.py FOLDER [--room ROOM] [--seed N] [--masks MASKS]"""
import argparse
import pathlib
import subprocess
import sys

try:
    from PIL import Image
except ImportError:
    sys.exit("the picture needs Pillow: pip install pillow")

QUESTIONS = ["what moved", "where was the mug", "what is gone"]
PICTURE_WIDTH = 1200


class Place:
    def __init__(self, options):
        self.options, self.folder = options, options.folder
        self.evening, self.morning = self.folder / "evening.ovimap", self.folder / "morning.ovimap"

    def run(self, *command):
        """Its answer may be no (1): nothing moved, there was no mug."""
        done = subprocess.run([self.options.program, *map(str, command)], stdout=subprocess.PIPE, text=True)
        if done.returncode not in (0, 1):
            sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}")
        return done.stdout

    def render(self):
        size = ["--size", self.options.size] if self.options.size else []
        self.run("synth", self.folder / "room", "--room", self.options.room, "--seed", self.options.seed, "--noise", "--visits", 2, *size)

    def map_visits(self):
        """The morning's recording goes on with the evening's map, into a map of its own."""
        masks = ["--masks", self.options.masks]
        self.run("run", self.folder / "room/visit1", *masks, "--recorded", "2026-03-14T21:00", "-o", self.evening)
        self.run("run", self.folder / "room/visit2", *masks, "--recorded", "2026-03-15T08:00", "--continue", self.evening, "-o", self.morning)

    def draw(self):
        """Evening, morning, and what changed: new things green, gone ones red, moved ones blue and light blue where they were."""
        parts = [self.folder / f"{name}.png" for name in ("evening", "morning", "changes")]
        self.run("export", self.evening, parts[0])
        self.run("export", self.morning, parts[1])
        self.run("diff", self.morning, "--since", "visit 1", "-o", parts[2])
        width = PICTURE_WIDTH // len(parts)
        views = [Image.open(part).convert("RGB") for part in parts]
        views = [view.resize((width, view.height * width // view.width), Image.LANCZOS) for view in views]
        picture = Image.new("RGB", (width * len(views), max(view.height for view in views)), "white")
        for column, view in enumerate(views):
            picture.paste(view, (column * width, 0))
        picture.save(self.folder / "overnight.jpg", quality=85)


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--room", default="tiny")
    parser.add_argument("--seed", default=2, type=int)
    parser.add_argument("--size", help="of the pictures, as 320x240")
    parser.add_argument("--masks", default="gt", help="gt: the room's true ones; sam: a network's")
    parser.add_argument("--program", default="ovimap")
    return parser.parse_args()


def main():
    place = Place(parse_options())
    place.render()
    place.map_visits()
    print(place.run("info", place.morning, "--history"))
    for question in QUESTIONS:
        print(f"> {question}\n{place.run('query', place.morning, question)}")
    place.draw()
    print(place.folder / "overnight.jpg")


if __name__ == "__main__":
    main()
