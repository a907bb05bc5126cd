#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Times `make demo` of this commit in a bare Debian: download, build and demo told apart, and which sources cost most to compile
# (processor time, without ccache). Needs root, debootstrap and the network. Usage: tools/demo_bare.sh [SUITE]   (bookworm)
set -euo pipefail
ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
source "$ROOT/tools/bare_system.sh"
SUITE="${1:-bookworm}"
COSTS="$BARE/compile-costs.$SUITE"

bare_open "$SUITE"
bare_checkout
# Stands before every compiler call; the source is its last argument.
cat > "$ROOT_FOLDER/opt/timed" << 'LAUNCHER'
#!/bin/bash
TIMEFORMAT="%U %S ${*: -1}"
{ time "$@" 2>&3; } 3>&2 2>> /opt/costs
LAUNCHER
chmod +x "$ROOT_FOLDER/opt/timed"
touch "$ROOT_FOLDER/opt/costs"

bare_make_and_git "make and git"
bare_timed "set-up (download)" "make -C ovimap setup-program"
bare_timed "build" "export CMAKE_CXX_COMPILER_LAUNCHER=/opt/timed; make -C ovimap build-program"
bare_timed "demo" "make -C ovimap demo"
awk '{print $1 + $2, $3}' "$ROOT_FOLDER/opt/costs" | sort -rn > "$COSTS"
awk '{sum += $1} END {printf "%d sources, %.0f s of processor time; the dearest:\n", NR, sum}' "$COSTS"
head -n 20 "$COSTS"
