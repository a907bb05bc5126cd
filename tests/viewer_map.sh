#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# The map that the tests of server and viewer look at: a small rendered room. Usage: viewer_map.sh PROGRAM MAP
set -eu
ovimap=$1 map=$2
folder=$(dirname "$map")
rm -rf "$folder/room" "$map"
mkdir -p "$folder"
"$ovimap" models list | grep -q default-encoder || { echo "the default encoder is missing; run tools/setup.sh"; exit 77; }
"$ovimap" synth "$folder/room" --room tiny
"$ovimap" run "$folder/room/room" --masks gt --encoder default --frames ::2 -o "$map"
