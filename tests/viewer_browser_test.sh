#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# The viewer in Chromium, on a served map. Usage: viewer_browser_test.sh MAP, in the folder viewer
set -eu
OVIMAP_MAP=$(dirname "$1")/coarse.ovimap
OVIMAP_ROOM=$(dirname "$1")/room/room  # what the map was made from
OVIMAP_HOME=$(dirname "$1")/home.ovimap  # of two visits
export OVIMAP_MAP OVIMAP_ROOM OVIMAP_HOME
export OVIMAP_CHROMIUM=${OVIMAP_CHROMIUM:-$(command -v chromium || true)}
[ -n "$OVIMAP_CHROMIUM" ] || { echo "Chromium is missing; run tools/setup.sh"; exit 77; }
[ -s "$OVIMAP_MAP" ] || { echo "there is no map to show: the encoder is missing; run tools/setup.sh"; exit 77; }
exec npx --no-install playwright test
