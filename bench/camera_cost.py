#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What ovimap-camera costs of a core: images of 640x480 at 30 a second from RealSense's software device to a server that takes all of them.

Usage: camera_cost.py RECORDING [--seconds 20] [--compress]
The recording's images are brought to 640x480, its depth gets a sensor's noise. --compress: depth as for a server on
another machine. Counted is the processor time of this process, which
also draws and hands out the images; a camera's own library has them from USB instead. PYTHONPATH must lead to the package."""
import argparse
import http.server
import json
import multiprocessing
import pathlib
import sys
import threading
import time

import numpy as np
import ovimap
from ovimap.camera_command import Session
from ovimap.cameras import Relay, Wanted
from ovimap.cameras.realsense import open_realsense
from ovimap.sender import FrameSender
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python" / "tests"))
from realsense_fixture import UNIT_M, Sockets, SoftwareCamera  # noqa: E402

SIZE, FPS = (640, 480), 30
NOISE = 0.0012  # standard deviation of depth at a metre; it grows with the square


class Taker(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def do_POST(self):
        self.rfile.read(int(self.headers["Content-Length"]))
        self.send_response(200)
        self.send_header("Content-Length", "2")
        self.end_headers()
        self.wfile.write(b"{}")

    def log_message(self, *_):
        pass


def serve(port):
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Taker) as server:
        port.put(server.server_port)
        server.serve_forever()


def images_of(recording, count=30):
    random, images = np.random.default_rng(1), []
    for frame in ovimap.open_source(recording).frames(f":{count}"):
        color = np.asarray(Image.fromarray(np.array(frame.color)).resize(SIZE))
        depth = np.asarray(Image.fromarray(np.array(frame.depth)).resize(SIZE, Image.Resampling.NEAREST))
        depth = depth + random.normal(size=depth.shape) * NOISE * depth**2
        images.append((color, np.rint(depth.clip(0, 16) / UNIT_M).astype(np.uint16)))
    return images


def show(camera, images, end):
    """At the camera's pace."""
    start = time.monotonic()
    for i in range(10**9):
        color, depth = images[i % len(images)]
        for kind, pixels in (("depth", depth), ("color", color)):
            camera.show(kind, pixels, 1000 / FPS * i)
        time.sleep(max(0.0, start + (i + 1) / FPS - time.monotonic()))
        if time.monotonic() > end:
            return


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--compress", action="store_true")
    options = parser.parse_args()
    told: list[str] = []  # that a recording of few frames flickers
    images, camera = images_of(options.recording), SoftwareCamera(size=SIZE)
    port = multiprocessing.Queue()
    server = multiprocessing.Process(target=serve, args=(port,), daemon=True)
    server.start()
    source = open_realsense(Wanted(), Sockets(camera))
    sender = FrameSender(f"http://127.0.0.1:{port.get()}/", source.rig, compress_depth=options.compress)
    session = Session(source, None, Relay(sender, told.append, waits=False), told.append, seconds=options.seconds)
    showing = threading.Thread(target=show, args=(camera, images, time.monotonic() + options.seconds + 1))
    start, used = time.monotonic(), time.process_time()
    showing.start()
    session.run()
    used, took = time.process_time() - used, time.monotonic() - start
    showing.join()
    server.terminate()
    print(json.dumps({"frames": sender.taken, "dropped": session.dropped, "frames_per_s": round(sender.taken / took, 1), "core_percent": round(100 * used / took, 1),
                      "ms_a_frame": round(1000 * used / sender.taken, 2), "version": f"{ovimap.version()} ({ovimap.commit()})"}))  # fmt: skip


if __name__ == "__main__":
    main()
