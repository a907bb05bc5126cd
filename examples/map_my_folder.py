# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""How do I map my recording? Usage: map_my_folder.py RECORDING MAP"""
import sys

import ovimap

source = ovimap.open_source(sys.argv[1])
mapper = ovimap.Mapper()  # no 2D masks: depth alone
frames = source.frames()
for frame in frames:
    mapper.process(frame)
print(f"{mapper.save(sys.argv[2])} objects from {len(frames) - len(frames.skipped)} frames")
