#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Checks every include against the module table of ARCHITECTURE.md; prints one line per offence."""
import pathlib
import re
import sys

ROW = re.compile(r"^\| (\d+) \| (\w+) \| [^|]* \| ([^|]*) \|$")
ROOM = re.compile(r"^\| (\w+)/(\w+) \| [^|]* \|$")
MOST_SOURCES = 24  # in one folder, tests and fixtures aside: what a newcomer can still look over
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[">]')
TYPE = re.compile(r"^(?:struct|class|enum class) (\w+)[^;]*\{", re.MULTILINE)
HEADERS = {"unzip": "minizip", "sentencepiece_processor": "sentencepiece", "OniCAPI": "openni2"}  # where it is not the library's name
TEST_LIBRARIES = {"gtest"}
FLAT = {"python"}  # one file per binding
SYSTEM = {"unistd.h", "dlfcn.h", "spawn.h", "sys", "fcntl.h", "dirent.h", "arpa", "netinet", "malloc.h"}  # POSIX, glibc


def read_table(text):
    rows = (ROW.match(line) for line in text.splitlines())
    return {r[2]: (int(r[1]), {name.strip() for name in r[3].split(",")}) for r in rows if r}


def read_rooms(text):
    """The rooms of each module, lowest first."""
    rooms = {}
    for row in filter(None, map(ROOM.match, text.splitlines())):
        rooms.setdefault(row[1], []).append(row[2])
    return rooms


def room_offence(module, room, include, rooms):
    """Why a file of `room` ("" for the module's own folder) must not include a file of its module; None when it may."""
    parts = include.split("/")
    if parts[0] != "ovimap" or parts[1] != module or not room:
        return None  # the module's own folder is its front: it may use every room
    other = parts[2] if len(parts) > 3 else ""
    order = rooms.get(module, [])
    if other == room or (other in order and order.index(other) < order.index(room)):
        return None
    return f"room {module}/{room} may not include {include}: it is listed later"


def folder_offences(root, module, folder, rooms):
    """Rooms without a row, and folders too full to find a thing in by walking."""
    found = []
    for place in [folder, *sorted(p for p in folder.iterdir() if p.is_dir())]:
        sources = [f for f in [*place.glob("*.h"), *place.glob("*.cpp")] if not is_test_source(f)]
        if place != folder and sources and place.name not in rooms.get(module, []):
            found.append(f"{place.relative_to(root)}: no row in ARCHITECTURE.md")
        if len(sources) > MOST_SOURCES:
            found.append(f"{place.relative_to(root)}: {len(sources)} sources; give them rooms of at most {MOST_SOURCES}")
    return found


def is_test_source(file):
    return bool(re.search(r"(_test\.cpp|_fixture\.h|_fixture\.cpp|test_support\.h)$", file.name))


def offence(module, include, table, is_test):
    """Why `module` must not include `include`; None when it may."""
    layer, libraries = table[module]
    parts = include.split("/")
    if parts[0] == "ovimap":
        other = parts[1]
        if other not in table:
            return f"module '{other}' is not in the table"
        if other != module and table[other][0] >= layer:
            return f"{module} (layer {layer}) may not include {other} (layer {table[other][0]})"
        return None
    name = parts[0].removesuffix(".h").removesuffix(".hpp")
    name = HEADERS.get(name, "onnxruntime" if name.startswith("onnxruntime") else name)
    known = libraries | (TEST_LIBRARIES if is_test else set())
    if "." not in parts[0] and len(parts) == 1 or parts[0] in SYSTEM or name in known:
        return None  # the standard library, POSIX, or listed
    return f"{module} may not use {include}; its row does not list it"


def name_offences(root):
    """Types of one name in two headers: all are of one namespace, so a program would have one of them for both."""
    headers = [file for file in sorted((root / "src/ovimap").rglob("*.h")) if not is_test_source(file)]
    first, found = {}, []
    for file in headers:
        for name in TYPE.findall(file.read_text()):
            other = first.setdefault(name, file)
            if other != file:
                found.append(f"{file.relative_to(root)}: {other.relative_to(root)} defines a '{name}' as well")
    return found


def check(root):
    text = (root / "ARCHITECTURE.md").read_text()
    table, rooms = read_table(text), read_rooms(text)
    if not table:
        return ["ARCHITECTURE.md has no module table"]
    found = []
    folders = [(p.name, p) for p in sorted((root / "src/ovimap").iterdir()) if p.is_dir()] + [("apps", root / "apps")]
    if (root / "python/bindings").is_dir():
        folders.append(("python", root / "python/bindings"))
    for module, folder in folders:
        if module not in table:
            found.append(f"{folder.relative_to(root)}: no row in ARCHITECTURE.md")
            continue
        if module not in FLAT:
            found += folder_offences(root, module, folder, rooms)
        for file in sorted(folder.rglob("*.h")) + sorted(folder.rglob("*.cpp")):
            is_test = is_test_source(file)
            room = "" if file.parent == folder else file.relative_to(folder).parts[0]
            for number, line in enumerate(file.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                if not match or (match[1] == '"' and "/" not in match[2]):
                    continue  # a quoted plain name is a header of the same folder
                include = f"ovimap/{match[2]}" if match[2].startswith("apps/") else match[2]  # outside src, but a module like any other
                reason = offence(module, include, table, is_test)
                if reason is None and not is_test:  # tests may look at whatever they hold theirs against
                    reason = room_offence(module, room, include, rooms)
                if reason:
                    found.append(f"{file.relative_to(root)}:{number}: {reason}")
    return found + name_offences(root)


if __name__ == "__main__":
    offences = check(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve())
    print("\n".join(offences) if offences else "every include respects the layers")
    sys.exit(1 if offences else 0)
