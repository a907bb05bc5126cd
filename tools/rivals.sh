#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Installs what `make bench` and `make benchmarks` compare with into build/rivals: Open3D and OpenCV from PyPI, for Python 3.8 to 3.12.
set -euo pipefail
cd "$(dirname "$0")/.."
VENV=build/rivals
PACKAGES="libegl1 libgl1 libgomp1 libusb-1.0-0 libx11-6"  # what its wheel links to

works() { "$VENV/bin/python" -c 'import cv2, open3d' 2>/dev/null; }

if works; then exit 0; fi
python3 -m venv "$VENV"
"$VENV/bin/pip" install -q --disable-pip-version-check open3d==0.20.0 opencv-python-headless==5.0.0.93 numpy
works || { echo "rivals: Open3D or OpenCV does not start; run: apt-get install $PACKAGES" >&2; exit 1; }
