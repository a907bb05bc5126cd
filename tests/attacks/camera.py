# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A camera's client: sends a rendered room's frames to `ovimap serve --live http`, over and over."""
import http.client
import json
import pathlib
import threading
import uuid

PAUSE_S = 0.2


def multipart(parts):
    """The body of a frame, and its Content-Type; `parts`: name: bytes."""
    boundary = uuid.uuid4().hex
    pieces = [f'--{boundary}\r\nContent-Disposition: form-data; name="{name}"; filename="{name}"\r\n\r\n'.encode() + content + b"\r\n"
              for name, content in parts.items()]  # fmt: skip
    return b"".join(pieces) + f"--{boundary}--\r\n".encode(), f"multipart/form-data; boundary={boundary}"


def frames_of(room):
    """Bodies and types of the frames of a recording in Replica's layout."""
    poses = [[float(number) for number in line.split()] for line in (room / "traj.txt").read_text().splitlines()]
    colors, depths = (sorted((room / "results").glob(f"{kind}*")) for kind in ("frame", "depth"))
    return [multipart({"color": color.read_bytes(), "depth": depth.read_bytes(), "frame": json.dumps({"pose": pose}).encode()})
            for color, depth, pose in zip(colors, depths, poses)]  # fmt: skip


class Camera:
    """Sends frames from now on, as the normal client that it is; `taken` of them will be in the map."""

    def __init__(self, port, room):
        self.port, self.taken, self.faults = port, 0, []
        self.frames = frames_of(pathlib.Path(room))
        about = json.loads((pathlib.Path(room).parent / "cam_params.json").read_text())["camera"]
        names = {"w": "width", "h": "height", "scale": "depth_scale"}
        figures = {names.get(key, key): value for key, value in about.items()}
        status, said = self._post("/api/camera", json.dumps({"camera": figures}), "application/json")
        assert status == 200, said
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _post(self, path, body, kind):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        try:
            connection.request("POST", path, body, {"Content-Type": kind})
            reply = connection.getresponse()
            return reply.status, reply.read()
        finally:
            connection.close()

    def _run(self):
        number = 0
        while not self._ended.wait(PAUSE_S):
            try:
                status, said = self._post("/api/frames", *self.frames[number % len(self.frames)])
            except (OSError, http.client.HTTPException) as fault:
                self.faults.append((number, 0, repr(fault)))
                return
            self.taken += status == 200
            if status not in (200, 503):  # 503: the mapper is busy, the frame is skipped
                self.faults.append((number, status, said))
            number += 1

    def stop(self):
        self._ended.set()
        self._thread.join()
