#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Where a command's processor time goes, drawn: tools/flame_graph.sh OUT.svg COMMAND...
# Needs perf (Debian's linux-perf) and inferno (cargo install inferno).
set -euo pipefail
out=$1
shift
for tool in perf inferno-collapse-perf inferno-flamegraph; do
  command -v $tool > /dev/null || { echo "flame_graph.sh: $tool is missing; see the head of this file" >&2; exit 2; }
done
data=$(mktemp)
trap 'rm -f "$data"' EXIT
perf record --quiet --freq 149 --call-graph dwarf,8192 --output "$data" "$@" > /dev/null
perf script --input "$data" 2> /dev/null | inferno-collapse-perf | sed 's/(anonymous namespace)::\?//g' |
  inferno-flamegraph --title "$(basename "$1") ${*:2}" --minwidth 0.4 --hash > "$out"
