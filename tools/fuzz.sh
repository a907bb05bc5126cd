#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Searches for inputs on which a reader crashes, hangs or takes too much memory. New inputs that reach new code are kept
# in BUILD/corpus; one that fails is left in BUILD as crash-*, timeout-* or oom-*.
# Usage: tools/fuzz.sh BUILD SECONDS [TARGET...]
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
build=$(realpath "$1")
seconds=$2
shift 2
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(image map_file ply tile yaml)

seeds_of() {
  if [ "$1" = map_file ]; then echo "$root/tests/maps"; else echo "$root/fuzz/corpus/$1"; fi
}

failed=0
for target in "${targets[@]}"; do
  found="$build/corpus/$target"
  mkdir -p "$found"
  log="$build/fuzz-$target.log"
  if "$build/bin/ovimap_fuzz_$target" "$found" "$(seeds_of "$target")" -max_total_time="$seconds" \
    -rss_limit_mb=2048 -timeout=10 -max_len=300000 -artifact_prefix="$build/" >"$log" 2>&1; then
    printf '%-9s %s\n' "$target" "$(grep -E '^Done ' "$log" || tail -n 1 "$log")"
  else
    printf '%-9s FAILED, see %s\n' "$target" "$log"
    failed=1
  fi
done
exit $failed
