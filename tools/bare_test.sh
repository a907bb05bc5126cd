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

bare_make_and_git "$SUITE, make and git"
bare_timed "$SUITE, set-up" "make -C ovimap test-setup"
bare_timed "$SUITE, build" "cd ovimap; cmake --preset release -DOVIMAP_WERROR=ON; cmake --build --preset release"
for package in "${COMPILERS[@]}"; do
  program="${package/clang-/clang++-}"
  bare_timed "$SUITE, $program reads all sources" "apt-get install -y -q --no-install-recommends $package
    cd ovimap; rm -rf build/other
    cmake -G Ninja -B build/other -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=$program -DOVIMAP_WERROR=ON -DOVIMAP_PCH=OFF -DCMAKE_UNITY_BUILD=ON
    python3 -c 'import json; print(*(entry[\"command\"] + \" -fsyntax-only\" for entry in json.load(open(\"build/other/compile_commands.json\"))), sep=\"\\n\")' |
      xargs -d '\n' -P \$(nproc) -n 1 sh -c"
done
bare_run "make -C ovimap test" | tail -n 40
