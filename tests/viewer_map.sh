#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# The maps that the tests of server and viewer look at: a small rendered room, and beside it coarse.ovimap of the same and home.ovimap of two visits. Usage: viewer_map.sh PROGRAM MAP
set -eu
ovimap=$1 map=$2
folder=$(dirname "$map")
rm -rf "$folder/room" "$map" "$folder/coarse.ovimap"
mkdir -p "$folder"
"$ovimap" models list | grep -q default-encoder || { echo "the default encoder is missing; run tools/setup.sh"; exit 77; }
"$ovimap" synth "$folder/room" --room tiny
map_room() { "$ovimap" run "$folder/room/room" --masks gt --encoder default --frames ::2 "$@"; }
map_room -o "$map"
# For the browser at 2 cm: one that draws without a GPU is as slow as the surface is fine.
map_room --set map.voxel_size_m=0.02 -o "$folder/coarse.ovimap"
# The same place on two days; of this seed a thing is carried off in between, and found to be.
home=$folder/home.ovimap
rm -rf "$folder/visits" "$home"
"$ovimap" synth "$folder/visits" --room tiny --visits 2 --seed 2
options="--masks gt --encoder default --recognizer none"
"$ovimap" run "$folder/visits/visit1" $options --recorded 2026-03-14T19:30 -o "$home"
"$ovimap" run "$folder/visits/visit2" $options --recorded 2026-03-16T08:12 --continue "$home"
