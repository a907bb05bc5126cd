# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What a map server says over HTTP (docs/http-api.md), as arrays and plain values."""

from __future__ import annotations

import json
import ssl
import struct
import urllib.error
import urllib.parse
import urllib.request
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from .._ovimap import Error
from ..files import parse_json
from ..sender import _address

CHUNK_HEAD = struct.Struct("<4sHH3i3ff3IQ")
PATCH_BYTES = 28
TIMEOUT_S = 30.0


@dataclass
class Cloud:
    """The surface of objects: points [n, 3] in metres, colors [n, 3] red first, ids [n] of the object."""

    points: npt.NDArray[np.float32]
    colors: npt.NDArray[np.uint8]
    ids: npt.NDArray[np.uint32]


@dataclass
class _Chunk:
    version: int
    points: npt.NDArray[np.float32]
    colors: npt.NDArray[np.uint8]
    labels: npt.NDArray[np.uint32]


@dataclass
class MapServer:
    """A client. Raises Error with the server's sentence for what it refuses, and for a server that does not answer."""

    url: str
    cafile: str | None = None
    _chunks: dict[tuple[int, int, int], _Chunk] = field(default_factory=dict)
    _identity: object = None

    def __post_init__(self) -> None:
        try:
            parts = _address(self.url)
        except ValueError as fault:
            raise Error(str(fault)) from None
        tokens = urllib.parse.parse_qs(parts.query).get("token")
        self._headers = {"Authorization": f"Bearer {tokens[0]}"} if tokens else {}
        self._base = f"{parts.scheme}://{parts.netloc}"
        self._trust = ssl.create_default_context(cafile=self.cafile) if parts.scheme == "https" else None

    def about(self) -> dict[str, Any]:
        said = self._json("/api/map")
        identity = said["live"] or (said["title"], said["content_hash"])
        if identity != self._identity:  # another map is served at the same address
            self._chunks, self._identity = {}, identity
        return said

    def objects(self) -> list[dict[str, Any]]:
        """Of each: id, name, label, box, centroid, color and more."""
        found: list[dict[str, Any]] = self._json("/api/instances")["instances"]
        return found

    def query(self, text: str) -> dict[str, Any]:
        return self._json("/api/query", json.dumps({"text": text}).encode())

    def approach(self, instance: int, start: list[float] | None, robot: dict[str, float]) -> dict[str, Any]:
        """Where to stand to see an object: poses, or the reason why there are none. start: where the robot is, a point of the world, for
        a way from there. robot: settings as POST /api/approach takes them."""
        asked = {"instance": instance, **robot, **({} if start is None else {"from": start})}
        return self._json("/api/approach", json.dumps(asked).encode())

    def cloud(self, most_points: int) -> Cloud:
        """The objects' surface; only what changed is fetched. Where it has more points, every n-th."""
        listed = self._json("/api/mesh?level=0&since=0")
        places = {(chunk["x"], chunk["y"], chunk["z"]): chunk["version"] for chunk in listed["chunks"]}
        kept = {place: chunk for place, chunk in self._chunks.items() if places.get(place) == chunk.version}
        self._chunks = {place: kept.get(place) or self._fetched(place, version) for place, version in places.items()}
        return self._objects_surface(most_points)

    def _fetched(self, place: tuple[int, int, int], version: int) -> _Chunk:
        return _chunk_of(self._bytes("/api/mesh/0/{}/{}/{}?since=0".format(*place)), version)

    def _objects_surface(self, most_points: int) -> Cloud:
        labels = self._json("/api/labels")
        object_of = np.array([0, *labels["instances"][1:]], np.uint32)
        object_of[np.isin(object_of, labels["hidden"])] = 0
        chunks = [self._chunks[place] for place in sorted(self._chunks)]
        ids = np.concatenate([_objects_of(chunk.labels, object_of) for chunk in chunks] or [np.zeros(0, np.uint32)])
        step = max(1, -(-int(np.count_nonzero(ids)) // most_points))
        shown = np.flatnonzero(ids)[::step]
        points = np.concatenate([chunk.points for chunk in chunks] or [np.zeros((0, 3), np.float32)])
        colors = np.concatenate([chunk.colors for chunk in chunks] or [np.zeros((0, 3), np.uint8)])
        return Cloud(points[shown], colors[shown], ids[shown])

    def _json(self, path: str, body: bytes | None = None) -> dict[str, Any]:
        try:
            return parse_json(self._bytes(path, body))
        except ValueError as fault:
            raise Error(f"{self._base} is no map server ({fault}); give what `ovimap serve` printed") from None

    def _bytes(self, path: str, body: bytes | None = None) -> bytes:
        headers = self._headers | ({"Content-Type": "application/json"} if body is not None else {})
        request = urllib.request.Request(self._base + path, body, headers)
        try:
            with urllib.request.urlopen(request, timeout=TIMEOUT_S, context=self._trust) as reply:
                return bytes(reply.read())
        except urllib.error.HTTPError as fault:
            raise Error(_sentence(fault)) from None
        except OSError as fault:  # URLError too
            self._identity = None  # who answers next may have another map
            raise Error(f"the map server {self._base} does not answer ({getattr(fault, 'reason', fault)}); is `ovimap serve` running?") from None


def _sentence(fault: urllib.error.HTTPError) -> str:
    try:
        return str(parse_json(fault.read())["error"])
    except (ValueError, KeyError, OSError):
        return f"the map server answered {fault.code}"


def _objects_of(labels: npt.NDArray[np.uint32], object_of: npt.NDArray[np.uint32]) -> npt.NDArray[np.uint32]:
    """0 for labels that came after the table: their chunk is newer."""
    known = labels < len(object_of)
    return np.where(known, object_of[np.where(known, labels, 0)], 0).astype(np.uint32)


def _chunk_of(data: bytes, listed: int) -> _Chunk:
    """Decodes a chunk (docs/http-api.md, "A chunk in bytes"). Raises Error for another format."""
    if len(data) < CHUNK_HEAD.size or data[:4] != b"OVMC":
        raise Error("the map server sent a surface that is none; use a server of the same version")
    head = CHUNK_HEAD.unpack_from(data)
    version, origin, edge, (patches, vertices, _) = head[1], np.array(head[6:9]), head[9], head[10:13]
    if version != 2:
        raise Error(f"the map server sends surfaces in version {version}, this program reads 2; use one version of ovimap")
    at = CHUNK_HEAD.size + patches * PATCH_BYTES
    steps = np.frombuffer(data, "<u2", vertices * 4, at).reshape(-1, 4)
    colors = np.frombuffer(data, np.uint8, vertices * 4, at + vertices * 8).reshape(-1, 4)
    labels = np.frombuffer(data, "<u4", vertices, at + vertices * 12)
    points = (origin + steps[:, :3] * (edge / 65535)).astype(np.float32)
    return _Chunk(listed, points, colors[:, :3].copy(), labels.astype(np.uint32))
