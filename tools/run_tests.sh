#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Runs every test of a build folder, says how far it is now and then, and closes with "N passed, N failed, N skipped".
# Usage: tools/run_tests.sh BUILD_FOLDER [ctest options]
set -u
build=$1
shift
report="$build/test-report.xml"
log="$build/test-output.log"
rm -f "$report"  # one of an earlier run would be counted
export TSAN_OPTIONS="suppressions=$(realpath tests/thread_sanitizer.txt) ${TSAN_OPTIONS:-}"  # read under ThreadSanitizer alone

# Of ctest's lines: each failure as it happens, every 100th test, and one a minute. No awk: Debian's own reads ahead.
show_progress() {
  local line told=$SECONDS
  while IFS= read -r line; do
    [[ "$line" =~ ^\ *([0-9]+)/([0-9]+)\ Test\ +#[0-9]+:\ ([^ ]+) ]] || continue
    if [[ "$line" == *"***Failed"* || "$line" == *"***Timeout"* || "$line" == *"***Exception"* ]]; then
      echo "tests: ${BASH_REMATCH[1]}/${BASH_REMATCH[2]} ${BASH_REMATCH[3]} failed"
    elif ((BASH_REMATCH[1] % 100 == 0 || SECONDS - told >= 60)); then
      echo "tests: ${BASH_REMATCH[1]}/${BASH_REMATCH[2]}"
      told=$SECONDS
    fi
  done
}

ctest --test-dir "$build" -j "$(($(nproc) + 1))" --output-on-failure --output-junit "$(realpath "$build")/test-report.xml" "$@" 2>&1 | tee "$log" | show_progress
status=${PIPESTATUS[0]}
if [ ! -s "$report" ]; then
  cat "$log"
  echo "0 passed, 1 failed"
  exit 1
fi
python3 - "$report" "$status" <<'PYTHON'
import sys
import xml.etree.ElementTree as tree

suite = tree.parse(sys.argv[1]).getroot()
failed = skipped = passed = 0
for case in suite.iter("testcase"):
    output = (case.findtext("system-out") or "").strip()
    if case.find("failure") is not None or case.get("status") == "fail":
        failed += 1
        print(f"FAILED {case.get('name')}\n{output}\n")
    elif case.find("skipped") is not None or case.get("status") in ("notrun", "disabled"):
        skipped += 1
        reason = [line.strip() for line in output.splitlines() if line.strip()][-1:] or ["no reason given"]
        print(f"SKIPPED {case.get('name')}: {reason[0]}")
    else:
        passed += 1
if passed + failed == 0 or (int(sys.argv[2]) != 0 and failed == 0):
    failed += 1
    print("ctest itself failed; see the build folder's test-output.log")
print(f"{passed} passed, {failed} failed, {skipped} skipped")
sys.exit(1 if failed else 0)
PYTHON
