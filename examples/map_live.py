# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""How do I map from a camera, while it runs? Usage: map_live.py RECORDING MAP; the recording stands for the camera here."""
import sys

import ovimap

mapper = ovimap.LiveMapper()
for frame in ovimap.open_source(sys.argv[1]):  # your driver: ovimap.Frame(color, depth, world_from_camera, camera)
    mapper.push_and_wait(frame)  # a camera cannot wait: push() drops instead
mapper.drain()
done = mapper.statistics()
objects = mapper.save(sys.argv[2])
print(f"{objects} objects from {done.frames_fused} frames, each in the map after {done.geometry_lag.p50_ms:.0f} ms")
