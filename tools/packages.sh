#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Makes the packages out of a build folder: a wheel with the Python package and the native program, and a Debian package. They
# are left in build/packages/out; tools/packages_test.sh tries them in bare systems. Usage: tools/packages.sh [BUILD]
set -euo pipefail
ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
BUILD="$(realpath "${1:-$ROOT/build/release}")"
WORK="$ROOT/build/packages"
OUT="$WORK/out"
rm -rf "$WORK/stage" "$WORK/plain" "$OUT"
mkdir -p "$OUT" "$WORK/plain"

[ -x "$WORK/env/bin/auditwheel" ] || {
  python3 -m venv "$WORK/env"
  "$WORK/env/bin/pip" install -q --disable-pip-version-check -r "$ROOT/tools/requirements-packages.txt"
}
PATH="$WORK/env/bin:$PATH"

"$ROOT/tools/packages/ceres.sh" "$WORK/ceres" > "$WORK/log" 2>&1 || { tail -n 20 "$WORK/log"; exit 1; }
export LD_LIBRARY_PATH="$WORK/ceres/lib:$ROOT/.deps/onnxruntime/lib"  # what the wheel carries

python "$ROOT/tools/packages/wheel.py" "$BUILD" "$WORK/stage" > "$WORK/log" 2>&1 || { tail -n 20 "$WORK/log"; exit 1; }
wheel pack -d "$WORK/plain" "$WORK/stage" > "$WORK/log"
# The tag is that of the C library here: the wheel runs on this distribution and newer ones.
glibc="$(getconf GNU_LIBC_VERSION | sed -e 's/glibc //' -e 's/\./_/')"
auditwheel repair --plat "manylinux_${glibc}_$(uname -m)" -w "$OUT" "$WORK"/plain/*.whl \
  > "$WORK/log" 2>&1 || { tail -n 20 "$WORK/log"; exit 1; }

unset LD_LIBRARY_PATH
(cd "$BUILD" && cpack -G DEB -B "$WORK/cpack") > "$WORK/log" 2>&1 || { tail -n 20 "$WORK/log"; exit 1; }
mv "$WORK"/cpack/*.deb "$OUT"
rm -rf "$WORK/stage" "$WORK/plain" "$WORK/cpack"
du -h "$OUT"/*
