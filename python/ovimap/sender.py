# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Sends a camera's frames to `ovimap serve --live http -o MAP` (docs/live.md). Needs NumPy alone, and Pillow for
colour that comes as arrays: this file may be copied to the machine that has the camera."""

from __future__ import annotations

import http.client
import io
import json
import selectors
import ssl
import struct
import time
import urllib.parse
import uuid
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

RETRY_S = 0.02  # between tries of a frame that the mapper had no room for
REST_S = 2.0  # the server lets connections go that rest for 5 seconds
DEFAULT_PORT = 8080  # of `ovimap serve`
CAMERAS = ("camera", "depth_camera", "color_camera")
FIGURES = ("width", "height", "fx", "fy", "cx", "cy")
MOST_NODES = 150  # of a pose graph in one request of at most 64 KiB
MOST_BYTES = 32 << 20  # of a frame; the server refuses more


class SendError(RuntimeError):
    """The server refused; its sentence says why."""

    def __init__(self, status: int, sentence: str) -> None:
        super().__init__(sentence)
        self.status = status


class FrameSender:
    """One camera's connection to a mapper.

    url: what `ovimap serve` printed, "http://host:8080/", with ?token= where it asks for one; "host:8080" will do.
    camera: width, height, fx, fy, cx and cy in pixels and depth_scale (units a metre, 1000 if left out) for colour and depth
        alike, as a dict or a PinholeCamera; or what camera.yaml may hold: {"camera": {...}}, or "depth_camera", "color_camera",
        "color_from_depth", "poses".
    jpeg_quality: of colour that comes as an array.
    compress_depth: of depth that comes as an array; None: unless the server is on this machine, where it would cost more than it saves.
    cafile: PEM file of the certificates to trust, for a server with one of its own ("https://..."); else the system's.

    Raises ValueError for an address or camera that is not whole, SendError when the server refuses the camera, OSError when it
    cannot be reached.
    """

    def __init__(self, url: str, camera: Mapping[str, Any] | object, *, jpeg_quality: int = 92, timeout_s: float = 20,
                 cafile: str | None = None, compress_depth: bool | None = None) -> None:  # fmt: skip
        parts = _address(url)
        tokens = urllib.parse.parse_qs(parts.query).get("token")
        self._headers = {"Authorization": f"Bearer {tokens[0]}"} if tokens else {}
        host = parts.hostname or "localhost"
        self._connection: http.client.HTTPConnection
        if parts.scheme == "https":
            trust = ssl.create_default_context(cafile=cafile)
            self._connection = http.client.HTTPSConnection(host, parts.port, timeout=timeout_s, context=trust)
        else:
            self._connection = http.client.HTTPConnection(host, parts.port, timeout=timeout_s)
        rig = _rig(camera)
        both: dict[str, Any] = rig.get("camera", {})
        self._units_per_m = float({**both, **rig.get("depth_camera", {})}.get("depth_scale", 1000))
        self._jpeg_quality = jpeg_quality
        self._compress_depth = not _is_this_machine(host) if compress_depth is None else compress_depth
        self.taken = self.skipped = 0
        self._heard = 0.0  # when the last answer came
        try:
            self._post_json("/api/camera", rig)
        except ssl.SSLError:
            raise
        except OSError as fault:
            raise ConnectionError(f"no server answers at {host}:{self._connection.port} ({fault}); start `ovimap serve --live http -o MAP` there") from None

    def send(self, color: npt.NDArray[np.uint8] | bytes, depth: npt.NDArray[Any] | bytes, pose: npt.ArrayLike | None, timestamp: float = 0.0, *,
             orientation: npt.ArrayLike | None = None, name: str = "", patience_s: float = 0.0) -> bool:  # fmt: skip
        """Sends one frame; False when the mapper had no room for it, also not within patience_s.

        color: uint8 [height, width, 3], or the bytes of a JPEG or PNG.
        depth: uint16 [height, width] in the camera's units, floats in metres, or the bytes of a PNG. Floats that are not finite
            or do not fit into 16 bits of the camera's units are sent as 0, which is none.
        pose: [4, 4], world_from_camera of the depth camera, unless the camera's "poses" says otherwise. None: not known, where the
            server tracks the camera (ovimap serve --live http --poses track).
        orientation: [4], how the depth camera is turned as its gyroscope adds turns up (ovimap.gyroscope does): unit quaternion x, y, z, w of the
            rotation into the world where it began, which may drift. Helps a server that tracks the camera.

        Raises TypeError and ValueError for another type or shape, for a pose that is not finite and an orientation that is no
        rotation, of which nothing is sent.
        Raises SendError when the frame is wrong or the map is finished, and when the answer was lost: the frame may have been
        taken, and is not sent twice."""
        about: dict[str, Any] = {"timestamp_s": _time(timestamp)}
        if pose is not None:
            about["pose"] = _pose(pose)
        if orientation is not None:
            about["orientation"] = _quaternion(orientation)
        if name:
            about["name"] = name
        body, kind = _multipart({"color": self._color(color), "depth": self._depth(depth), "frame": json.dumps(about).encode()})
        if len(body) > MOST_BYTES:
            raise SendError(413, f"the frame has {len(body) / 2**20:.1f} MiB, the server takes {MOST_BYTES >> 20}; send smaller or "
                            "compressed pictures")
        headers, end = {"Content-Type": kind}, time.monotonic() + patience_s
        while not self._offer(body, headers):
            if time.monotonic() >= end:
                self.skipped += 1
                return False
            time.sleep(RETRY_S)
            headers["Ovimap-Retry"] = "1"  # the server has counted this frame as left out
        self.taken += 1
        return True

    def correct_poses(self, poses: Mapping[float, npt.ArrayLike]) -> None:
        """Says where the camera was at these times, by now: a pose graph whose loop was closed. What was sent so far moves there,
        and the map with it.

        poses: of the depth camera as send() takes them, by time in seconds; of frames between two nothing need be said. Of more
            than MOST_NODES every so manieth is sent.

        Raises SendError where the server keeps no frames (docs/http-api.md), or finds poses itself."""
        times = sorted(poses)
        chosen = times[:: -(-len(times) // MOST_NODES)] if times else []
        if times and chosen[-1] != times[-1]:
            chosen.append(times[-1])
        self._post_json("/api/poses", {"poses": [{"timestamp_s": _time(time), "pose": _pose(poses[time])} for time in chosen]})

    def finish(self, wait_s: float = 600.0) -> None:
        """Says that no more frames come and waits until the map is saved. Raises SendError when it is not by then, or when
        the server has ended."""
        end = time.monotonic() + wait_s
        try:
            self._post_json("/api/finish", {})
            while not self._saved():
                if time.monotonic() >= end:
                    raise SendError(0, f"the map was not saved within {wait_s:g} s; the server goes on with it")
                time.sleep(0.2)
        except (OSError, http.client.HTTPException) as fault:
            raise SendError(0, f"the server ended before it said that the map is saved ({fault!r}); what it printed says why") from None

    def close(self) -> None:
        self._connection.close()

    def _color(self, color: npt.NDArray[np.uint8] | bytes) -> bytes:
        if isinstance(color, bytes):
            return color
        if _type_of(color) != "uint8":
            raise TypeError(f"color must be uint8 or the bytes of a JPEG or PNG; it is {_type_of(color)}")
        if color.ndim != 3 or color.shape[2] != 3:
            raise ValueError(f"color must be [height, width, 3], red first; its shape is {list(color.shape)}")
        return _jpeg(color, self._jpeg_quality)

    def _depth(self, depth: npt.NDArray[Any] | bytes) -> bytes:
        if isinstance(depth, bytes):
            return depth
        if _type_of(depth) not in ("uint16", "float16", "float32", "float64"):
            raise TypeError(f"depth must be uint16 in the camera's units, floats in metres, or the bytes of a PNG; it is {_type_of(depth)}")
        if depth.ndim != 2:
            raise ValueError(f"depth must be [height, width]; its shape is {list(depth.shape)}")
        if depth.dtype.kind == "f":
            units = depth.astype(np.float64) * self._units_per_m
            depth = np.where((units > 0) & (units < 65535), np.rint(units), 0)
        return _gray_png(depth.astype(np.uint16), compress=self._compress_depth)

    def _offer(self, body: bytes, headers: dict[str, str]) -> bool:
        status, reply = self._ask("POST", "/api/frames", body, headers, again=False)
        if status in (429, 503):
            return False
        _require(status, reply)
        return True

    def _post_json(self, path: str, value: Any) -> None:
        _require(*self._ask("POST", path, json.dumps(value).encode(), {"Content-Type": "application/json"}))

    def _saved(self) -> bool:
        status, reply = self._ask("GET", "/api/map", None, {})
        if status in (429, 503):
            return False
        _require(status, reply)
        return not reply.get("live", False)

    def _ask(self, method: str, path: str, body: bytes | None, headers: dict[str, str], *, again: bool = True) -> tuple[int, dict[str, Any]]:
        """again: it does no harm to ask a second time when the answer was lost."""
        self._connect()
        try:
            return self._once(method, path, body, headers)
        except (OSError, http.client.HTTPException) as fault:
            self._connection.close()
            if not again:
                raise SendError(0, f"the answer to a frame was lost ({fault!r}): it may have been taken, so it was not sent "
                                "again; go on with the next") from None
            if isinstance(fault, TimeoutError):
                raise
        self._connect()
        return self._once(method, path, body, headers)

    def _connect(self) -> None:
        """Opens the connection anew where the server has let it go, or is about to: what is sent then would be lost."""
        if self._connection.sock is not None:
            with selectors.DefaultSelector() as closed:
                closed.register(self._connection.sock, selectors.EVENT_READ)
                if time.monotonic() - self._heard > REST_S or closed.select(0):
                    self._connection.close()
        if self._connection.sock is None:
            self._connection.connect()

    def _once(self, method: str, path: str, body: bytes | None, headers: dict[str, str]) -> tuple[int, dict[str, Any]]:
        try:
            self._connection.request(method, path, body, {**self._headers, **headers})
        except (BrokenPipeError, ConnectionResetError):
            pass  # a server that refuses a body by its head may have answered before it closed
        reply = self._connection.getresponse()
        text = reply.read()
        self._heard = time.monotonic()
        try:
            value = json.loads(text)
        except (ValueError, RecursionError):  # the latter: nested very deep
            value = {}
        return reply.status, value if isinstance(value, dict) else {}


def _require(status: int, reply: dict[str, Any]) -> None:
    if status >= 400:
        raise SendError(status, reply.get("error", f"the server answered {status}"))


def _address(url: str) -> urllib.parse.SplitResult:
    accepted = 'give what `ovimap serve` printed, as "http://localhost:8080/" or "localhost:8080"'
    try:
        parts = urllib.parse.urlsplit(url if "://" in url else f"http://{url}")
        sound = parts.scheme in ("http", "https") and bool(parts.hostname) and parts.port != 0
    except ValueError:  # of the port
        sound = False
    if not sound:
        raise ValueError(f"'{url}' is no address of a server; {accepted}")
    if "://" not in url and parts.port is None:
        parts = parts._replace(netloc=f"{parts.netloc}:{DEFAULT_PORT}")
    return parts


def _rig(camera: Mapping[str, Any] | object) -> dict[str, Any]:
    """As camera.yaml has it, whichever way it was given."""
    if not isinstance(camera, Mapping):
        camera = {name: getattr(camera, name) for name in (*FIGURES, "depth_scale") if hasattr(camera, name)}
    rig = dict(camera) if any(name in camera for name in CAMERAS) else {"camera": dict(camera)}
    for name in CAMERAS:
        if name in rig:
            given = rig[name] if isinstance(rig[name], Mapping) else {}
            missing = [figure for figure in FIGURES if figure not in given]
            if missing:
                raise ValueError(f"'{name}' lacks {', '.join(missing)}; a camera has {', '.join(FIGURES)} in pixels, and depth_scale, "
                                 "the units of its depth in a metre, where that is not 1000")
    return rig


def _pose(pose: npt.ArrayLike) -> list[float]:
    matrix = np.asarray(pose, np.float64)
    if matrix.shape != (4, 4):
        raise ValueError(f"pose must be [4, 4]; its shape is {list(matrix.shape)}")
    if not np.isfinite(matrix).all():
        raise ValueError("the pose has numbers that are not finite; leave frames out whose pose is not known")
    numbers: list[float] = matrix.reshape(16).tolist()
    return numbers


def _quaternion(orientation: npt.ArrayLike) -> list[float]:
    xyzw = np.asarray(orientation, np.float64)
    if xyzw.shape != (4,):
        raise ValueError(f"orientation must be [4], a quaternion x, y, z, w; its shape is {list(xyzw.shape)}")
    length = float(np.linalg.norm(xyzw))
    if not abs(length - 1) < 1e-3:
        raise ValueError(f"orientation must be a unit quaternion; its length is {length:g}")
    numbers: list[float] = (xyzw / length).tolist()
    return numbers


def _time(timestamp: float) -> float:
    if not np.isfinite(timestamp):
        raise ValueError(f"timestamp must be seconds; it is {timestamp}")
    return float(timestamp)


def _type_of(picture: Any) -> str:
    return picture.dtype.name if isinstance(picture, np.ndarray) else type(picture).__name__


def _jpeg(picture: npt.NDArray[np.uint8], quality: int) -> bytes:
    try:
        from PIL import Image
    except ModuleNotFoundError as fault:
        message = "sending colour as an array needs Pillow; run `pip install pillow`, or send the bytes of JPEG and PNG files"
        raise ModuleNotFoundError(message, name=fault.name) from None
    out = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(picture)).save(out, "JPEG", quality=quality, subsampling=0)
    return out.getvalue()


def _is_this_machine(host: str) -> bool:
    return host in ("localhost", "::1") or host.startswith("127.")


def _gray_png(picture: npt.NDArray[np.uint16], *, compress: bool) -> bytes:
    """Compressed as small as what libraries make at their fastest, in less than half the time: rows are filtered at once (each less the
    one above), and as depth is too noisy for repetitions none are looked for."""
    height, width = picture.shape
    stored = picture.astype(">u2").view(np.uint8).reshape(height, 2 * width)
    rows = np.empty((height, 1 + 2 * width), np.uint8)
    rows[:, 0] = 2 if compress else 0  # the filter's number
    rows[:, 1:] = stored
    if compress:
        rows[1:, 1:] -= stored[:-1]
    deflate = zlib.compressobj(1 if compress else 0, zlib.DEFLATED, zlib.MAX_WBITS, zlib.DEF_MEM_LEVEL, zlib.Z_HUFFMAN_ONLY)
    header = struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", deflate.compress(rows.tobytes()) + deflate.flush()), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(name, content) for name, content in chunks)


def _chunk(name: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(content, zlib.crc32(name)))


def _multipart(parts: dict[str, bytes]) -> tuple[bytes, str]:
    """The body of a form with these parts, and its content type."""
    border = uuid.uuid4().hex
    pieces = []
    for name, content in parts.items():
        file = f'; filename="{name}"' if name != "frame" else ""
        kind = "application/json" if name == "frame" else "application/octet-stream"
        pieces += [f'--{border}\r\nContent-Disposition: form-data; name="{name}"{file}\r\nContent-Type: {kind}\r\n\r\n'.encode(), content, b"\r\n"]
    return b"".join([*pieces, f"--{border}--\r\n".encode()]), f"multipart/form-data; boundary={border}"
