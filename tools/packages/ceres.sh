#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Builds Ceres, of the version that this Debian has and from its source, without SuiteSparse, parts of which are under the GPL: packages are linked
# with this one instead. Leaves it in FOLDER/prefix. Usage: ceres.sh FOLDER
set -euo pipefail
FOLDER="$(realpath -m "$1")"
VERSION="$(dpkg-query -W -f '${source:Version}' libceres-dev)"
[ ! -e "$FOLDER/built-$VERSION" ] || exit 0
SCRATCH="$FOLDER"
source "$(dirname "${BASH_SOURCE[0]}")/../private_apt.sh"
rm -rf "$FOLDER"
mkdir -p "$FOLDER"
cd "$FOLDER"

release="$(. /etc/os-release && echo "$VERSION_CODENAME")"
package_sources | sort -u | while read -r uri key; do echo "deb-src ${key:+[signed-by=$key] }$uri $release main"; done > sources.list
private_apt update || true  # some mirrors of the list may lack the release
private_apt source "ceres-solver=$VERSION"

cmake -G Ninja -S ceres-solver-*/ -B build -DCMAKE_BUILD_TYPE=Release -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_SHARED_LIBS=OFF -DSUITESPARSE=OFF -DCXSPARSE=OFF \
  -DLAPACK=OFF -DEIGENSPARSE=ON -DSCHUR_SPECIALIZATIONS=OFF -DBUILD_TESTING=OFF -DBUILD_EXAMPLES=OFF -DBUILD_BENCHMARKS=OFF
cmake --build build
cmake --install build --prefix prefix
touch "built-$VERSION"
