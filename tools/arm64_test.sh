#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Builds this commit for 64-bit ARM with Debian 12's cross compiler in a bare system, runs the tests of what maps are made of by qemu, and
# holds maps that the ARM program makes against those of this machine's. Needs root, debootstrap, the network, and
# tools/setup.sh --tests to have run. Usage: tools/arm64_test.sh [PROGRAM]   (build/release/bin/ovimap)
set -euo pipefail
ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
source "$ROOT/tools/bare_system.sh"
PROGRAM="${1:-$ROOT/build/release/bin/ovimap}"
TESTED=(ovimap_{base,geometry,image,frames,segment,map,instance,io}_test)  # modules that make a map and its file

bare_open bookworm
bare_checkout
bare_ccache arm64

# Libraries of the other architecture; programs, and packages that are alike on all, of this one.
install_packages() {
  bare_run "dpkg --add-architecture arm64; apt-get update -q
    names='g++-aarch64-linux-gnu make qemu-user'
    for name in \$(sed 's/#.*//' ovimap/tools/debian-packages.txt) libgtest-dev zlib1g-dev; do
      case \$name in
        build-essential | mold | libopenni2-dev) ;;
        lib* | zlib1g-dev) apt-cache show -q \$name:arm64 > /dev/null 2>&1 && names+=\" \$name:arm64\" || names+=\" \$name\" ;;
        *) names+=\" \$name\" ;;
      esac
    done
    apt-get install -y -q --no-install-recommends \$names"
}

# The library is in the wheel of that architecture; headers are alike.
install_runtime() {
  bare_run 'cd ovimap; python3 -m venv .venv; version=$(sed -n "s/^ORT_VERSION=\([0-9.]*\).*/\1/p" tools/setup.sh)
    .venv/bin/pip download -q --disable-pip-version-check --no-deps --only-binary=:all: --python-version 3.12 \
      --platform manylinux_2_28_aarch64 --platform manylinux_2_27_aarch64 -d wheel "onnxruntime==$version"
    .venv/bin/python -m zipfile -e wheel/*.whl wheel
    mkdir -p .deps/onnxruntime/lib
    cp wheel/onnxruntime/capi/libonnxruntime.so.$version .deps/onnxruntime/lib/libonnxruntime.so.1
    ln -s libonnxruntime.so.1 .deps/onnxruntime/lib/libonnxruntime.so'
  local headers
  headers="$(dirname "$(find "$ROOT/.deps/onnxruntime/include" /usr/include -name onnxruntime_cxx_api.h 2> /dev/null | head -n 1)")"
  cp -r "$headers" "$ROOT_FOLDER/root/ovimap/.deps/onnxruntime/include"
}

build() {
  bare_run "cd ovimap; cmake -G Ninja -B build/arm64 --toolchain cmake/Arm64.cmake -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
      -DOVIMAP_BENCH=OFF -DOVIMAP_EXAMPLES=OFF -DOVIMAP_VIEWER=OFF
    ninja -C build/arm64 ovimap ${TESTED[*]}"
}

# same_map TITLE OPTIONS...: made by both, the same up to the rounding of distances (docs/install.md, "64-bit ARM").
same_map() {
  local title="$1" room="$ROOT_FOLDER/root/room" here="$ROOT_FOLDER/root/here.ovimap"
  shift
  "$PROGRAM" run "$room/room" --encoder none "$@" -o "$here" > /dev/null
  bare_timed "$title, on ARM" "rm -f arm.ovimap; qemu-aarch64 ovimap/build/arm64/bin/ovimap run room/room --encoder none $* -o arm.ovimap"
  "$ROOT/.venv/bin/python" "$ROOT/tests/compare_maps.py" "$title" "$here" "$ROOT_FOLDER/root/arm.ovimap"
}

install_packages > "$BARE/arm64.log" 2>&1 || { tail -n 20 "$BARE/arm64.log"; bare_fail "the libraries are not to be had"; }
install_runtime
build > "$BARE/arm64.log" 2>&1 || { grep -E 'error|FAILED' "$BARE/arm64.log" | head -n 30; bare_fail "it does not build; see $BARE/arm64.log"; }
for test in "${TESTED[@]}"; do
  bare_run "qemu-aarch64 ovimap/build/arm64/bin/$test --gtest_brief=1" | tail -n 5
done
"$PROGRAM" synth "$ROOT_FOLDER/root/room" --room tiny --frames 6 --size 320x240 --noise > /dev/null
same_map "depth alone" --masks none
same_map "true masks" --masks gt
