#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Builds this commit in a bare Debian with its own compiler, warnings being errors, and runs every test there (`make test`). Other
# compilers of that release then read every source, with warnings as errors as well and without making code.
# Needs root, debootstrap and the network. Usage: tools/bare_test.sh [SUITE [COMPILER PACKAGE...]]   (trixie g++-12 g++-13 clang-19)
set -euo pipefail
ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
source "$ROOT/tools/bare_system.sh"
SUITE="${1:-trixie}"
COMPILERS=("${@:2}")
[ "$#" -gt 0 ] || COMPILERS=(g++-12 g++-13 clang-19)

bare_open "$SUITE"
bare_checkout
bare_ccache "$SUITE"

# Stands before a compiler: reads the source and leaves an empty object.
cat > "$ROOT_FOLDER/opt/read-only" << 'LAUNCHER'
#!/bin/bash
"$@" -fsyntax-only || exit 1
while [ "$1" != -o ]; do shift; done
touch "$2"
LAUNCHER
chmod +x "$ROOT_FOLDER/opt/read-only"

bare_timed "$SUITE, make and git" "apt-get update -q; apt-get install -y -q --no-install-recommends make git"
bare_timed "$SUITE, set-up" "make -C ovimap test-setup"
bare_timed "$SUITE, build" "cd ovimap; cmake --preset release -DOVIMAP_WERROR=ON; cmake --build --preset release"
for package in "${COMPILERS[@]}"; do
  program="${package/clang-/clang++-}"
  bare_timed "$SUITE, $program reads all sources" "apt-get install -y -q --no-install-recommends $package
    cd ovimap; rm -rf build/other; export CCACHE_DISABLE=1
    cmake -G Ninja -B build/other -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=$program -DOVIMAP_WERROR=ON -DOVIMAP_PCH=OFF \
      -DCMAKE_UNITY_BUILD=ON -DCMAKE_CXX_COMPILER_LAUNCHER=/opt/read-only
    ninja -k 0 -C build/other \$(ninja -C build/other -t targets all | sed -n 's/^\(.*\.cpp\.o\|.*\.cxx\.o\): .*/\1/p')"
done
bare_run "make -C ovimap test" | tail -n 40
