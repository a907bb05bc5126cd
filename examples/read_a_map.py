# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What is in my map? Usage: read_a_map.py MAP"""
import sys

import ovimap

objects = ovimap.Map.open(sys.argv[1]).instances  # without the voxels; Map.mesh() reads them
for number, box, views in zip(objects.ids, objects.boxes, objects.views):
    x, y, z = box.mean(axis=0)
    print(f"object {number} at {x:.2f} {y:.2f} {z:.2f}, seen in {views} frames")
