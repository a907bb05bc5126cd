#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Tries the packages of tools/packages.sh in bare systems of Debian, without a compiler: each is installed by one command, shows
# its demo, serves its page, and has its manual. Needs root, debootstrap and the network.
# Usage: tools/packages_test.sh [--wheel | --deb] [SUITE...]   (bookworm trixie)
set -euo pipefail
ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
OUT="$ROOT/build/packages/out"
source "$ROOT/tools/bare_system.sh"
KINDS=(wheel deb)
case "${1:-}" in
  --wheel | --deb) KINDS=("${1#--}"); shift ;;
esac
SUITES=("$@")
[ "${#SUITES[@]}" -gt 0 ] || SUITES=(bookworm trixie)

# What the installed program $1 must do.
try_program() {
  bare_run '! command -v cc c++ gcc node npm' || bare_fail "the system is not bare"
  bare_timed "$TITLE, ovimap demo" "$1 demo"
  bare_run "$1 query demo/tiny.ovimap sofa > /dev/null" || bare_fail "$TITLE: the sofa is not found"
  ! bare_run "$1 query demo/tiny.ovimap elephant > /dev/null" || bare_fail "$TITLE: an elephant is found"
  bare_run "$1 serve demo/tiny.ovimap --port 8123 > served.log 2>&1 & server=\$!
    for try in \$(seq 50); do (: < /dev/tcp/127.0.0.1/8123) 2> /dev/null && break; sleep 0.2; done
    exec 3<> /dev/tcp/127.0.0.1/8123
    printf 'GET / HTTP/1.1\r\nHost: 127.0.0.1:8123\r\nConnection: close\r\n\r\n' >&3
    page=\"\$(cat <&3)\"; kill \$server; wait \$server || true
    grep -q '<script' <<< \"\$page\"" || bare_fail "$TITLE: the viewer's page is not served"
}

try_wheel() {
  cp "$OUT"/ovimap-*.whl "$ROOT_FOLDER/root"
  bare_timed "$TITLE, Debian's python3-venv" "apt-get update -q; apt-get install -y -q --no-install-recommends python3-venv; python3 -m venv env"
  bare_timed "$TITLE, pip install" "env/bin/pip install -q --disable-pip-version-check ovimap-*.whl"
  try_program env/bin/ovimap
  bare_run 'test -s env/share/man/man1/ovimap-query.1; test -s env/share/bash-completion/completions/ovimap'
  bare_run 'env/bin/python -c "
import ovimap
found = ovimap.Map.open(\"demo/tiny.ovimap\").query(\"sofa\")
assert found.matches, found
print(ovimap.version())"' || bare_fail "$TITLE: the Python package does not answer"
}

try_deb() {
  if ! compgen -G "$OUT/ovimap_*~${suite}_*.deb" > /dev/null; then
    echo "$TITLE: not tried; there is none for this release: run tools/bare_packages.sh $suite"
    return
  fi
  cp "$OUT"/ovimap_*~"${suite}"_*.deb "$ROOT_FOLDER/root"
  bare_timed "$TITLE, apt install" "apt-get update -q; apt-get install -y -q --no-install-recommends ./ovimap_*.deb"
  try_program ovimap
  bare_run 'test -s /usr/share/man/man1/ovimap-query.1.gz; test -s /usr/share/bash-completion/completions/ovimap'
  bare_run 'test -s /usr/share/zsh/vendor-completions/_ovimap; test -s /usr/share/doc/ovimap/copyright'
}

for suite in "${SUITES[@]}"; do
  for kind in "${KINDS[@]}"; do
    TITLE="$suite, $kind"
    bare_open "$suite"
    "try_$kind"
    bare_close
  done
done
echo "what was tried works"
