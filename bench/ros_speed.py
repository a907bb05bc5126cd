#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Processor time of ovimap-ros for each frame of a camera, 640x480 at 30 frames a second, and how many of them arrive.

Usage: bench/ros_speed.py RECORDING [--seconds 20] [--compressed] [--best-effort]

This process is camera and server: it publishes the recording's pictures, scaled to 640x480, and counts the frames that come back
by HTTP, unread. --compressed: JPEG and PNG, as image_transport sends them, in place of raw pixels.
"""
import argparse
import contextlib
import http.server
import io
import json
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import ovimap
from ovimap.ros import types
from ovimap.ros.node import SENSOR_DATA, TRANSFORMS, Node, Quality
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "python/tests"))
from ros_fixture import compressed, image, info, transforms  # noqa: E402

DOMAIN = 1 + os.getpid() % 100
FPS = 30
TICKS_S = os.sysconf("SC_CLK_TCK")


class Server(http.server.BaseHTTPRequestHandler):
    """Takes everything."""

    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True
    frames = 0

    def do_POST(self):
        length = int(self.headers["Content-Length"])
        while length > 0:
            length -= len(self.rfile.read(min(length, 1 << 20)))
        Server.frames += self.path == "/api/frames"
        self.answer({})

    def do_GET(self):
        self.answer({"live": False})

    def answer(self, value):
        body = json.dumps(value).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        pass


def shots(recording, packed):
    """(colour, depth) as messages without time, and the camera."""
    made = []
    for frame in ovimap.open_source(recording).frames(":20"):
        color = Image.fromarray(np.array(frame.color)).resize((640, 480))
        depth = Image.fromarray(np.rint(np.array(frame.depth) * 1000).astype(np.uint16)).resize((640, 480), Image.Resampling.NEAREST)
        if packed:
            out = io.BytesIO()
            color.save(out, "JPEG", quality=90)
            png = ovimap.encode_png(np.array(depth, np.uint16))
            made.append((compressed(0, out.getvalue(), "rgb8; jpeg compressed bgr8"), compressed(0, bytes(12) + png, "16UC1; compressedDepth png")))
        else:
            made.append((image(0, np.array(color), "rgb8"), image(0, np.array(depth, np.uint16), "16UC1")))
    return made


def processor_s(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_S


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording")
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--compressed", action="store_true")
    parser.add_argument("--best-effort", action="store_true")
    options = parser.parse_args()
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Server)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    node, kind = Node(DOMAIN), "sensor_msgs/msg/CompressedImage" if options.compressed else "sensor_msgs/msg/Image"
    quality = SENSOR_DATA if options.best_effort else Quality(depth=30)
    color, depth = (node.publisher(kind, f"/speed/{name}/image", quality) for name in ("color", "depth"))
    infos = [node.publisher("sensor_msgs/msg/CameraInfo", f"/speed/{name}/camera_info", SENSOR_DATA) for name in ("color", "depth")]
    tf = node.publisher("tf2_msgs/msg/TFMessage", "/tf", TRANSFORMS)
    pictures, camera = shots(options.recording, options.compressed), ovimap.PinholeCamera(640, 480, 525, 525, 319.5, 239.5)
    command = [sys.executable, "-m", "ovimap.ros.command", f"http://127.0.0.1:{server.server_port}", "--domain", str(DOMAIN), "--no-publish",
               "--color", "/speed/color/image", "--depth", "/speed/depth/image", *([] if options.best_effort else ["--reliable"])]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as bridge:
        while not all(one.subscribers for one in (color, depth, tf, *infos)):
            time.sleep(0.05)
        time.sleep(1)
        before, begin, sent = processor_s(bridge), time.monotonic(), 0
        late = 0.0
        while time.monotonic() - begin < options.seconds:
            time_ns = 10**18 + sent * 10**9 // FPS
            for out in infos:
                out.publish(info(camera))
            tf.publish(transforms(("map", "optical", time_ns, np.eye(4))))
            for out, message in zip((color, depth), pictures[sent % len(pictures)]):
                message.header.stamp.sec, message.header.stamp.nanosec = divmod(time_ns, 10**9)
                out.publish(message)
            sent += 1
            wait = begin + sent / FPS - time.monotonic()
            late = max(late, -wait)
            time.sleep(max(wait, 0))
        time.sleep(1)
        used = processor_s(bridge) - before
        bridge.send_signal(signal.SIGINT)
        with contextlib.suppress(ProcessLookupError):
            said = bridge.stderr.read()
    print(f"{sent} frames published at {sent / options.seconds:.1f} a second (at most {late * 1e3:.0f} ms late), {Server.frames} arrived")
    print(f"ovimap-ros: {used / max(Server.frames, 1) * 1e3:.1f} ms of processor time a frame, {used / (options.seconds + 1) * 100:.0f} % of a core")
    print(said.strip())


main()
