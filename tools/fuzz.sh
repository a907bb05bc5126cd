#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Searches for inputs on which a reader crashes, hangs or takes too much memory, and closes with "N passed, N failed".
# New inputs that reach new code are kept in BUILD/corpus; one that fails is left in BUILD as TARGET-crash-*,
# TARGET-timeout-* or TARGET-oom-*.
# Usage: tools/fuzz.sh BUILD SECONDS JOBS [TARGET...]
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
build=$(realpath "$1")
seconds=$2
jobs=$3
shift 3
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(frame image json map_file ply request tile yaml)

seeds_of() {
  if [ "$1" = map_file ]; then echo "$root/tests/maps"; else echo "$root/fuzz/corpus/$1"; fi
}

fuzz() {
  local target=$1 found="$build/corpus/$1" log="$build/fuzz-$1.log"
  mkdir -p "$found"
  if "$build/bin/ovimap_fuzz_$target" "$found" "$(seeds_of "$target")" -max_total_time="$seconds" \
    -rss_limit_mb=2048 -timeout=10 -max_len=300000 -artifact_prefix="$build/$target-" >"$log" 2>&1; then
    printf 'PASSED fuzz_%s: %s\n' "$target" "$(grep -E '^Done ' "$log" || tail -n 1 "$log")"
  else
    printf 'FAILED fuzz_%s: %s\n' "$target" "$(grep -m 1 -E 'ERROR|SUMMARY' "$log" || tail -n 1 "$log")"
  fi
}
export -f fuzz seeds_of
export root build seconds

report=$(printf '%s\n' "${targets[@]}" | xargs -P "$jobs" -I{} bash -c 'fuzz {}' | tee /dev/stderr)
failed=$(grep -c '^FAILED' <<<"$report" || true)
echo "$((${#targets[@]} - failed)) passed, $failed failed"
[ "$failed" = 0 ]
