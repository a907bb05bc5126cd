#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""How fast bags are turned into recordings: raw and compressed images, in each kind of bag.

Usage: bag_speed.py RECORDING [--frames 100]
The bags are made from the recording, at 30 frames a second. PYTHONPATH must lead to the package."""
import argparse
import io
import pathlib
import sys
import tempfile
import time

import numpy as np
import ovimap
from ovimap.bags import convert
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python" / "tests"))
from bag_fixture import Options, Shot, record  # noqa: E402


def shots_of(frames, compressed):
    for frame in frames:
        depth = np.rint(frame.depth * 1000).astype(np.uint16)
        color = jpeg(frame.color) if compressed else np.array(frame.color)
        yield Shot(color, depth, np.array(frame.world_from_camera))


def jpeg(pixels):
    out = io.BytesIO()
    Image.fromarray(np.array(pixels)).save(out, "JPEG", quality=90)
    return out.getvalue()


def frames_per_second(frames, kind, compressed):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        options = Options(kind=kind, compressed_depth=compressed)
        bag = record(path / ("made.bag" if kind == "ros1" else "made"), list(shots_of(frames, compressed)), frames[0].camera, options)
        start = time.perf_counter()
        convert(bag, path / "out")
        return len(frames) / (time.perf_counter() - start)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=100)
    options = parser.parse_args()
    frames = list(ovimap.open_source(options.recording).frames(f"0:{options.frames}"))
    camera = frames[0].camera
    print(f"{len(frames)} frames of {camera.width}x{camera.height}; ovimap {ovimap.version()} ({ovimap.commit()})\n")
    print("| bag | images | frames a second |\n| --- | --- | --- |")
    for kind in ("ros1", "sqlite3", "mcap"):
        for compressed in (False, True):
            images = "JPEG and PNG" if compressed else "raw"
            print(f"| {kind} | {images} | {frames_per_second(frames, kind, compressed):.0f} |", flush=True)


if __name__ == "__main__":
    main()
