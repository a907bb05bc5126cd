#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Builds Ceres, of the version that this Debian has and from its source, without SuiteSparse, parts of which are under the GPL: packages are linked
# with this one instead. Leaves it in FOLDER/prefix. Usage: ceres.sh FOLDER
set -euo pipefail
FOLDER="$(realpath -m "$1")"
VERSION="$(dpkg-query -W -f '${source:Version}' libceres-dev)"
[ ! -e "$FOLDER/built-$VERSION" ] || exit 0
rm -rf "$FOLDER"
mkdir -p "$FOLDER"/apt/{lists/partial,cache/archives/partial,parts}
cd "$FOLDER"

# The host's own package sources, for sources; its lists stay as they are.
cat /etc/apt/sources.list.d/*.sources /etc/apt/sources.list 2> /dev/null > apt/known || true
sed -n -E -e 's/^URIs:[[:space:]]*(.*)/\1/p' -e 's/^deb[[:space:]]+(\[[^]]*\][[:space:]]+)?([^[ ]+).*/\2/p' apt/known | sort -u |
  sed "s,.*,deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] & $(. /etc/os-release && echo "$VERSION_CODENAME") main," > apt/sources.list
private_apt() {
  apt-get -q -o Dir::State="$PWD/apt" -o Dir::State::lists="$PWD/apt/lists" -o Dir::State::status=/var/lib/dpkg/status -o Dir::Cache="$PWD/apt/cache" \
    -o Dir::Etc::sourcelist="$PWD/apt/sources.list" -o Dir::Etc::sourceparts="$PWD/apt/parts" -o APT::Sandbox::User="$(id -un)" "$@"
}
private_apt update || true  # some mirrors of the list may lack the release
private_apt source "ceres-solver=$VERSION"

cmake -G Ninja -S ceres-solver-*/ -B build -DCMAKE_BUILD_TYPE=Release -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_SHARED_LIBS=OFF -DSUITESPARSE=OFF -DCXSPARSE=OFF \
  -DLAPACK=OFF -DEIGENSPARSE=ON -DSCHUR_SPECIALIZATIONS=OFF -DBUILD_TESTING=OFF -DBUILD_EXAMPLES=OFF -DBUILD_BENCHMARKS=OFF
cmake --build build
cmake --install build --prefix prefix
touch "built-$VERSION"
