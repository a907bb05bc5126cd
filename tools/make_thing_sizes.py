#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes src/ovimap/semantics/data/thing_sizes.txt: how large things of a name are, and where they stand.

Usage: tools/make_thing_sizes.py CROPS [FURNITURE]

CROPS is what `ovimap synth CROPS --catalog` wrote: models that rendered rooms draw from (its column room_class) are left
out, so that those rooms stay a test. FURNITURE is the folder of furniture catalogues. Common things that the catalogues
lack come from tools/data/common_sizes.txt, which goes before them.
"""
import collections
import csv
import pathlib
import re
import statistics
import sys
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tools/models"))
import furniture_names  # noqa: E402

COMMON = ROOT / "tools/data/common_sizes.txt"
OUT = ROOT / "src/ovimap/semantics/data/thing_sizes.txt"
LARGEST_M = 6.0  # whatever is larger is no thing in a room
HEAD = """# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Usual sizes of things: word;height;length;depth;bottom from;bottom to, in metres, the bottom above the
# floor. Written by tools/make_thing_sizes.py; do not edit.
"""


def catalogue_entries(folder):
    for path in sorted(folder.glob("*.sh3f")):
        with zipfile.ZipFile(path) as library:
            text = library.read("PluginFurnitureCatalog.properties").decode("unicode_escape")
        entries = collections.defaultdict(dict)
        for key, number, value in re.findall(r"^(\w+)#(\d+)=(.*)$", text, re.MULTILINE):
            entries[int(number)][key] = value.strip()
        for entry in entries.values():
            if "width" in entry:
                yield f"{path.stem}/{entry['id'].split('#')[-1]}", entry


def place_of(height, length, elevation):
    """Where the bottom is, from and to: as the catalogue says, else large things stand on the floor."""
    if elevation > 0.05:
        return max(0.0, elevation - 0.3), elevation + 0.3
    if height > 0.5 or length > 1.0:
        return 0.0, 0.1
    return (0.0, 0.9) if height > 0.35 or length > 0.7 else (0.2, 1.5)


def library_sizes(crops, furniture):
    with open(crops / "crops.csv", encoding="utf-8", newline="") as file:
        held_out = {row["model"] for row in csv.DictReader(file) if row["room_class"]}
    sizes = collections.defaultdict(list)
    for model, entry in catalogue_entries(furniture):
        height, width, depth = (float(entry[side]) / 100 for side in ("height", "width", "depth"))
        if model in held_out or max(height, width, depth) > LARGEST_M:
            continue
        for name in furniture_names.meanings(entry["name"]):
            sizes[name].append((height, max(width, depth), min(width, depth), float(entry.get("elevation", 0)) / 100))
    for name, rows in sizes.items():
        height, length, depth, elevation = (statistics.median(column) for column in zip(*rows))
        yield name, (height, length, depth, *place_of(height, length, elevation))


def common_sizes():
    for line in COMMON.read_text().splitlines():
        if line and not line.startswith("#"):
            name, *numbers = line.split(";")
            yield name, tuple(map(float, numbers))


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    furniture = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "/usr/share/sweethome3d/furniture")
    sizes = dict(library_sizes(pathlib.Path(sys.argv[1]), furniture)) | dict(common_sizes())
    lines = [";".join([name] + [f"{number:.3g}" for number in sizes[name]]) for name in sorted(sizes)]
    OUT.write_text(HEAD + "\n".join(lines) + "\n")
    print(f"{len(lines)} names")


if __name__ == "__main__":
    main()
