#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Gathers the licences of what a package carries beside ovimap's own code.

FOLDER gets `third-party.md`, which names every part with its version and source, and the texts. Parts are libraries that are
compiled in; the web page's packages; the networks; and, unless --built-in is given, the shared libraries that PROGRAM and what it
loads are linked with, which a wheel takes along. Usage: licenses.py PROGRAM FOLDER [--built-in]
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Debian packages of what leaves no trace but code in the program: headers, and libraries that exist as archives alone.
COMPILED_IN = (
    "libeigen3-dev", "libceres-dev", "robin-map-dev", "nlohmann-json3-dev", "libcli11-dev", "libsqlitecpp-dev",
)  # fmt: skip
# What every Linux has, as auditwheel's policies say; these are not carried.
OF_THE_SYSTEM = re.compile(r"(ld-linux|libc|libm|libdl|librt|libpthread|libresolv|libstdc\+\+|libgcc_s|libz)[-.]")
RUNTIME = "libonnxruntime.so"


def output(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def shared_libraries(program: str) -> list:
    found = re.findall(r"=> (/\S+)", output("ldd", program))
    return sorted(pathlib.Path(path).resolve() for path in found if not OF_THE_SYSTEM.match(pathlib.Path(path).name))


def package_of(library: pathlib.Path) -> str:
    """The Debian package that brought it. dpkg knows a file by the name it was packed with, before /lib moved to /usr/lib."""
    for name in (str(library), str(library).removeprefix("/usr")):
        asked = subprocess.run(["dpkg-query", "-S", name], capture_output=True, text=True)
        if asked.returncode == 0:
            return asked.stdout.split(":")[0]
    sys.exit(f"licenses.py: no Debian package has {library}, so its licence is not known; use the system's library")


def facts(package: str) -> dict:
    form = "${Package}\t${Version}\t${source:Package}\t${source:Version}\n"
    name, version, source, source_version = output("dpkg-query", "-W", "-f", form, package).splitlines()[0].split("\t")
    return {"name": name, "version": version, "source": source, "source_version": source_version}


def boost() -> str:
    """Its headers are in a package that is named after their version."""
    known = output("dpkg-query", "-W", "-f", "${Package} ${db:Status-Status}\n", "libboost1*-dev")
    return re.search(r"^(libboost1\.\d+-dev) installed$", known, re.MULTILINE)[1]


def add_debian_packages(packages: set, folder: pathlib.Path) -> list:
    lines = []
    for package in sorted(packages):
        shutil.copyfile(pathlib.Path("/usr/share/doc") / package / "copyright", folder / f"{package}.txt")
        fact = facts(package)
        lines.append(
            f"- {fact['name']} {fact['version']}, Debian's source package {fact['source']} {fact['source_version']}: {package}.txt"
        )
    return lines


def add_runtime(folder: pathlib.Path) -> list:
    """ONNX Runtime's own texts, from the Python wheel that its library was taken from (tools/setup.sh)."""
    library = next((ROOT / ".deps/onnxruntime/lib").glob(f"{RUNTIME}.*.*"), None)
    if library is None:
        return []  # the system's: among the packages
    version = library.name.removeprefix(f"{RUNTIME}.")
    with tempfile.TemporaryDirectory() as scratch:
        output(
            str(ROOT / ".venv/bin/pip"), "download", "-q", "--disable-pip-version-check", "--no-deps", "--only-binary=:all:",
            "--python-version", "3.12", "-d", scratch, f"onnxruntime=={version}",
        )  # fmt: skip
        with zipfile.ZipFile(next(pathlib.Path(scratch).glob("*.whl"))) as wheel:
            for name in ("LICENSE", "ThirdPartyNotices.txt"):
                (folder / f"onnxruntime-{name}").write_bytes(wheel.read(f"onnxruntime/{name}"))
    return [f"- ONNX Runtime {version}, MIT: onnxruntime-LICENSE, onnxruntime-ThirdPartyNotices.txt"]


def add_page(folder: pathlib.Path) -> list:
    lines = []
    wanted = json.loads((ROOT / "viewer/package.json").read_text()).get("dependencies", {})
    for name in sorted(wanted):
        package = ROOT / "viewer/node_modules" / name
        about = json.loads((package / "package.json").read_text())
        text = next((file for file in package.iterdir() if file.name.upper().startswith("LICEN")), None)
        place = f"page-{name.replace('/', '-').lstrip('@')}.txt"
        if text:
            shutil.copyfile(text, folder / place)
        lines.append(f"- {name} {about['version']}, {about['license']}" + (f": {place}" if text else ""))
    return lines


def add_models(folder: pathlib.Path) -> list:
    lines = []
    for name in ("mobilesam", "default-encoder"):
        text = (ROOT / f"tools/models/{name}.yaml").read_text()
        said = dict(re.findall(r"^(name|license|source): (.*)$", text, re.MULTILINE))
        lines.append(f"- {said['name']}: {said['license']}; {said['source']}")
    shutil.copyfile(ROOT / "docs/NOTICE-default-encoder.md", folder / "NOTICE-default-encoder.md")
    return lines


SHARED_NOTE = """The shared libraries are Debian's, unchanged but for the paths they look in; their sources are to be had from Debian under the
names and versions given. Some are under the LGPL: who passes this package on passes those on under these terms. Ceres is compiled in from
Debian's source, without SuiteSparse, parts of which are under the GPL.
"""


def main(program: str, folder: pathlib.Path, built_in: bool):
    folder.mkdir(parents=True, exist_ok=True)
    text = ["# What this package carries beside ovimap's own code\n"]
    libraries = [] if built_in else [file for file in shared_libraries(program) if not file.name.startswith(RUNTIME)]
    if libraries:
        text += ["## Shared libraries\n", SHARED_NOTE]
        text += [*add_debian_packages({package_of(file) for file in libraries}, folder), ""]
    text += ["## Compiled in\n", *add_debian_packages({*COMPILED_IN, boost()}, folder), *add_runtime(folder), ""]
    text += ["## The web page\n", *add_page(folder), "", "## Networks\n", *add_models(folder), ""]
    text += ["## Furniture of the demo's room\n", "Its makers and licences: NOTICE.md beside the models.", ""]
    (folder / "third-party.md").write_text("\n".join(text))
    shutil.copyfile(ROOT / "LICENSE", folder / "copyright")


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]), "--built-in" in sys.argv[3:])
