#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# What a map outlives: half a recording is mapped, killed half-way and resumed, the other half mapped apart, the two maps
# compared and merged, and the result exported and opened by a program that knows nothing of ovimap.
# Usage: tools/demo_lasting.sh PROGRAM RECORDING OUTPUT_FOLDER [options of `ovimap run`]
set -eu
ovimap=$(realpath "$1") recording=$2 out=$3
shift 3
python="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/.venv/bin/python"
mkdir -p "$out"
rm -f "$out"/*.ovimap "$out"/*.ovimap.partial*

frames=$("$ovimap" check "$recording" --json | python3 -c 'import json, sys; print(json.load(sys.stdin)["frames"])' || true)
half=$((frames / 2))
first=(run "$recording" --frames ":$half" "$@" --set checkpoint.frames=5 -o "$out/first.ovimap")

echo "== mapping the first $half frames, and killing it when it has stored some of them"
"$ovimap" "${first[@]}" &
run=$!
log="$out/first.ovimap.partial-wal"
until [ "$(stat -c %s "$log" 2>/dev/null || echo 0)" -gt 8000000 ] || ! kill -0 $run 2>/dev/null; do sleep 0.05; done
kill -KILL $run 2>/dev/null || true
wait $run 2>/dev/null || true
"$ovimap" info "$out/first.ovimap.partial" | head -n 2

echo "== resuming"
"$ovimap" "${first[@]}" --resume

echo "== mapping the other half apart"
"$ovimap" run "$recording" --frames "$half:" "$@" -o "$out/second.ovimap"

echo "== what changed from one half to the other"
"$ovimap" diff "$out/first.ovimap" "$out/second.ovimap" -o "$out/changes.png" || [ $? = 1 ]

echo "== one map of both"
"$ovimap" merge "$out/first.ovimap" "$out/second.ovimap" -o "$out/whole.ovimap"
"$ovimap" info "$out/whole.ovimap" --check
"$ovimap" export "$out/whole.ovimap" "$out/whole.glb"

echo "== the GLB as trimesh sees it"
"$python" - "$out/whole.glb" <<'PYTHON'
import sys
import trimesh

scene = trimesh.load(sys.argv[1])
sizes = {node: len(scene.geometry[scene.graph[node][1]].faces) for node in scene.graph.nodes_geometry}
largest = sorted(sizes, key=sizes.get, reverse=True)[:5]
print(f"{len(sizes)} nodes, {sum(sizes.values())} triangles; largest: {', '.join(largest)}")
PYTHON
