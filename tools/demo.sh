#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# From nothing to a map one can look at: renders a small furnished room, maps it with real 2D masks,
# writes pictures and a mesh, and says how to go on. Usage: tools/demo.sh PROGRAM
set -eu
ovimap=$1
echo "== rendering a furnished room into demo/tiny"
"$ovimap" synth demo/tiny --room tiny
echo "== mapping it: MobileSAM masks on every second frame"
"$ovimap" run demo/tiny/room --masks sam --set mask_interval=2 -o demo/tiny.ovimap --pictures demo/pictures
"$ovimap" export demo/tiny.ovimap demo/tiny.ply --what instances
"$ovimap" export demo/tiny.ovimap demo/tiny.json
echo "== objects in the map"
"$ovimap" info demo/tiny.ovimap
echo "== finding objects by name"
"$ovimap" query demo/tiny.ovimap "sofa" "lamp" "chair" "elephant" --top 1 || true
"$ovimap" report demo/tiny.ovimap demo/report.html
echo "== how good it is (exact truth comes with the rendered room)"
"$ovimap" eval demo/tiny.ovimap --gt demo/tiny/room
cat <<EOT

Look at   demo/report.html in a browser; demo/pictures/top_view.png, demo/pictures/contact_sheet.png
See       $ovimap serve demo/tiny.ovimap                 in a browser; or make demo VIEW=1
Ask       $ovimap query demo/tiny.ovimap "something to sit on" "largest cabinet"
Open      demo/tiny.ply in any mesh viewer; demo/tiny.json in any editor
Go on     $ovimap run YOUR_RECORDING -o my.ovimap        depth alone, real time
          $ovimap run YOUR_RECORDING --masks sam -o my.ovimap --pictures pictures
          $ovimap check YOUR_RECORDING                   what is wrong with a recording
EOT
better="$("$ovimap" models hub --set hub.connect_timeout_s=3 --set hub.stall_timeout_s=3 2>/dev/null)" &&
  echo "Better    ${better#*better words: }"
[ "${VIEW:-0}" != 1 ] || exec "$ovimap" serve demo/tiny.ovimap
