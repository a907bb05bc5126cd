#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Makes the packages: a wheel with the Python package and the native program, and a Debian package, built with a Ceres of their own
# (packages/ceres.sh). They are left in build/packages/out; tools/packages_test.sh tries them in bare systems. Usage: tools/packages.sh
set -euo pipefail
ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
WORK="$ROOT/build/packages"
BUILD="$WORK/build"
OUT="$WORK/out"
rm -rf "$WORK/stage" "$WORK/plain" "$OUT"
mkdir -p "$OUT" "$WORK/plain"

[ -x "$WORK/env/bin/auditwheel" ] || {
  python3 -m venv "$WORK/env"
  "$WORK/env/bin/pip" install -q --disable-pip-version-check -r "$ROOT/tools/requirements-packages.txt"
}
PATH="$WORK/env/bin:$PATH"

build() {
  "$ROOT/tools/packages/ceres.sh" "$WORK/ceres"
  cmake -S "$ROOT" --preset program -B "$BUILD" -DOVIMAP_PYTHON=ON -DCeres_DIR="$WORK/ceres/prefix/lib/cmake/Ceres"
  cmake --build "$BUILD" --target ovimap ovimap_viewer _ovimap_stub
}
build > "$WORK/log" 2>&1 || { tail -n 20 "$WORK/log"; exit 1; }
python "$ROOT/tools/packages/wheel.py" "$BUILD" "$WORK/stage" > "$WORK/log" 2>&1 || { tail -n 20 "$WORK/log"; exit 1; }
wheel pack -d "$WORK/plain" "$WORK/stage" > "$WORK/log"
# The tag is that of the C library here: the wheel runs on this distribution and newer ones.
glibc="$(getconf GNU_LIBC_VERSION | sed -e 's/glibc //' -e 's/\./_/')"
LD_LIBRARY_PATH="$ROOT/.deps/onnxruntime/lib" auditwheel repair --plat "manylinux_${glibc}_$(uname -m)" -w "$OUT" "$WORK"/plain/*.whl \
  > "$WORK/log" 2>&1 || { tail -n 20 "$WORK/log"; exit 1; }

(cd "$BUILD" && cpack -G DEB -B "$WORK/cpack") > "$WORK/log" 2>&1 || { tail -n 20 "$WORK/log"; exit 1; }
mv "$WORK"/cpack/*.deb "$OUT"
rm -rf "$WORK/stage" "$WORK/plain" "$WORK/cpack"
du -h "$OUT"/*
