#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Makes the Debian package of another release than this machine's in a bare system of it (`make packages` there), and leaves it in
# build/packages/out, where tools/packages_test.sh looks for it. Needs root, debootstrap and the network.
# Usage: tools/bare_packages.sh [SUITE]   (trixie)
set -euo pipefail
ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
source "$ROOT/tools/bare_system.sh"
SUITE="${1:-trixie}"
OUT="$ROOT/build/packages/out"

bare_open "$SUITE"
bare_checkout
bare_ccache "$SUITE"
bare_make_and_git "$SUITE, make and git"
bare_timed "$SUITE, make packages" "make -C ovimap packages"
mkdir -p "$OUT"
cp "$ROOT_FOLDER"/root/ovimap/build/packages/out/ovimap_*~"$SUITE"_*.deb "$OUT"
du -h "$OUT"/ovimap_*~"$SUITE"_*.deb
