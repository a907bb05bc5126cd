#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Copies the furniture models that the room "tiny" shows, with their credits, out of Debian's sweethome3d-furniture.

Packages bring these (2.5 of 125 MB), so that `ovimap demo` renders its room anywhere. The room's own notice says which they are.
Usage: furniture.py PROGRAM FOLDER
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

LIBRARIES = pathlib.Path("/usr/share/sweethome3d/furniture")
PROPERTIES = "PluginFurnitureCatalog.properties"


def notice_of_the_room(program: str) -> str:
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run([program, "synth", scratch, "--room", "tiny", "--frames", "1", "--size", "64x48"], check=True, capture_output=True)
        return (pathlib.Path(scratch) / "room" / "NOTICE.md").read_text()


def models_in(properties: str) -> list:
    return [model.strip().lstrip("/") for model in re.findall(r"^model#\d+\s*=(.*)$", properties, re.MULTILINE)]


def without_other_models(properties: str, wanted: list) -> str:
    """The catalogue's lines of the models that are kept, and those of the library."""
    kept = {
        number
        for number, model in re.findall(r"^model(#\d+)\s*=(.*)$", properties, re.MULTILINE)
        if model.strip().lstrip("/") in wanted
    }
    lines = []
    for line in properties.splitlines():
        number = re.match(r"[A-Za-z]+(#\d+)\s*=", line)
        if number is None or number[1] in kept:
            lines.append(line)
    return "\n".join(lines) + "\n"


def copy_models(library: pathlib.Path, names: set, folder: pathlib.Path):
    with zipfile.ZipFile(library) as source:
        properties = source.read(PROPERTIES).decode("latin-1")
        wanted = [model for model in models_in(properties) if pathlib.PurePath(model).stem in names]
        if len(wanted) != len(names):
            sys.exit(f"furniture.py: {library} has not all of {', '.join(sorted(names))}; reinstall sweethome3d-furniture")
        parts = {str(pathlib.PurePath(model).parent) + "/" for model in wanted}
        with zipfile.ZipFile(folder / library.name, "w", zipfile.ZIP_DEFLATED) as made:
            made.writestr(PROPERTIES, without_other_models(properties, wanted).encode("latin-1"))
            for entry in source.infolist():
                if entry.filename == "LICENSE.TXT" or any(entry.filename.startswith(part) for part in parts):
                    made.writestr(entry.filename, source.read(entry))


def main(program: str, folder: pathlib.Path):
    notice = notice_of_the_room(program)
    folder.mkdir(parents=True, exist_ok=True)
    by_library: dict = {}
    for library, model in re.findall(r"\(([\w-]+)/([\w-]+)\) by", notice):
        by_library.setdefault(library, set()).add(model)
    for library, names in by_library.items():
        copy_models(LIBRARIES / f"{library}.sh3f", names, folder)
    (folder / "NOTICE.md").write_text(notice)


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]))
