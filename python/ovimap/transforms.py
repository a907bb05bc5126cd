# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Transforms between named frames over time, as ROS publishes them."""

from __future__ import annotations

import bisect

import numpy as np
import numpy.typing as npt

from ._ovimap import Error

Matrix = npt.NDArray[np.float64]
MAX_GAP_S = 0.5  # poses farther apart say nothing of the time between them


def matrix_of(position: tuple[float, float, float], quaternion: tuple[float, float, float, float]) -> Matrix:
    """[4, 4] of a position in metres and a quaternion (x, y, z, w) of any length above 0."""
    length = float(np.linalg.norm(quaternion))
    if not length > 1e-6 or not np.isfinite(length):
        raise Error(f"a transform has the quaternion {quaternion}, which is no rotation; mend what publishes it")
    x, y, z, w = (value / length for value in quaternion)
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, 3] = position
    return matrix


def quaternion_of(matrix: Matrix) -> npt.NDArray[np.float64]:
    """(x, y, z, w) of a rotation; the method of the largest component, which is exact for all of them."""
    r = matrix[:3, :3]
    squares = np.array([1 + r[0, 0] - r[1, 1] - r[2, 2], 1 - r[0, 0] + r[1, 1] - r[2, 2], 1 - r[0, 0] - r[1, 1] + r[2, 2], 1 + np.trace(r)])
    skew = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    i = int(np.argmax(squares))
    q = np.empty(4)
    q[i] = squares[i]
    if i == 3:
        q[:3] = skew
    else:
        q[3] = skew[i]
        for j in {0, 1, 2} - {i}:
            q[j] = r[i, j] + r[j, i]
    return np.asarray(q / np.linalg.norm(q))


def rotation_vector_of(matrix: Matrix) -> npt.NDArray[np.float64]:
    """[3]: the axis times the angle in radians, which is at most pi."""
    q = quaternion_of(matrix)
    angle = 2 * np.arctan2(np.linalg.norm(q[:3]), q[3])
    axis = q[:3] / max(float(np.linalg.norm(q[:3])), 1e-300)
    return np.asarray(axis * (angle - 2 * np.pi if angle > np.pi else angle))


def between(first: Matrix, second: Matrix, share: float) -> Matrix:
    """The transform that far from the first to the second: linear, and along the arc of the rotation (slerp)."""
    a, b = quaternion_of(first), quaternion_of(second)
    if a @ b < 0:
        b = -b
    angle = float(np.arccos(min(1.0, float(a @ b))))
    weights = (1 - share, share) if angle < 1e-4 else (np.sin((1 - share) * angle), np.sin(share * angle))
    q = weights[0] * a + weights[1] * b
    position = (1 - share) * first[:3, 3] + share * second[:3, 3]
    return matrix_of(tuple(position), tuple(q))


class Link:
    """parent_from_child over time."""

    def __init__(self, parent: str, static: bool) -> None:
        self.parent, self.static = parent, static
        self.times_ns: list[int] = []
        self.matrices: list[Matrix] = []

    def add(self, time_ns: int, matrix: Matrix) -> None:
        at = len(self.times_ns)
        if self.times_ns and time_ns <= self.times_ns[-1]:  # several publishers, or one late
            at = bisect.bisect_left(self.times_ns, time_ns)
            if at < len(self.times_ns) and self.times_ns[at] == time_ns:
                return
        self.times_ns.insert(at, time_ns)
        self.matrices.insert(at, matrix)

    def forget(self, before_ns: int) -> None:
        """What is older, but for the newest of it: between that and the next may lie what is asked for."""
        keep = max(bisect.bisect_left(self.times_ns, before_ns) - 1, 0)
        if not self.static:
            del self.times_ns[:keep], self.matrices[:keep]

    def at(self, time_ns: int) -> Matrix | None:
        """None where no pose is near enough in time on both sides."""
        if self.static:
            return self.matrices[-1]
        after = bisect.bisect_left(self.times_ns, time_ns)
        if after < len(self.times_ns) and self.times_ns[after] == time_ns:
            return self.matrices[after]
        if after == 0 or after == len(self.times_ns):
            return None
        start, end = self.times_ns[after - 1], self.times_ns[after]
        if end - start > MAX_GAP_S * 1e9:
            return None
        return between(self.matrices[after - 1], self.matrices[after], (time_ns - start) / (end - start))


class TransformTree:
    """Links by child; every frame has one parent."""

    def __init__(self) -> None:
        self.links: dict[str, Link] = {}

    def add(self, parent: str, child: str, time_ns: int, matrix: Matrix, *, static: bool = False) -> None:
        parent, child = parent.lstrip("/"), child.lstrip("/")
        link = self.links.setdefault(child, Link(parent, static))
        if link.parent == parent:
            link.add(time_ns, matrix)

    def forget(self, before_ns: int) -> None:
        for link in self.links.values():
            link.forget(before_ns)

    def chain(self, frame: str) -> list[str]:
        """The frame, its parent and so on up to the root."""
        names = [frame.lstrip("/")]
        while names[-1] in self.links:
            parent = self.links[names[-1]].parent
            if parent in names:
                raise Error(f"the transforms form a circle at frame '{parent}'; mend what publishes them")
            names.append(parent)
        return names

    def target_from(self, target: str, source: str, time_ns: int) -> Matrix | None:
        """target_from_source at a time; None where a pose is missing then. Raises Error for unconnected frames."""
        up, down = self.chain(source), self.chain(target)
        common = next((name for name in up if name in down), None)
        if common is None:
            raise Error(
                f"the transforms do not connect the frames '{source}' and '{target}' (known: "
                f"{', '.join(sorted(self.links)) or 'none'}); record or publish /tf and /tf_static"
            )
        first = self._ancestor_from(common, source, time_ns)
        second = self._ancestor_from(common, target, time_ns)
        return None if first is None or second is None else np.asarray(np.linalg.inv(second) @ first)

    def known_until_ns(self, target: str, source: str) -> int | None:
        """The latest time for which there are transforms between both, 0 for no time; None where nothing moves between them."""
        up, down = self.chain(source), self.chain(target)
        moving = [self.links[name] for name in set(up) ^ set(down) if name in self.links and not self.links[name].static]
        return min((link.times_ns[-1] if link.times_ns else 0 for link in moving), default=None)

    def _ancestor_from(self, ancestor: str, frame: str, time_ns: int) -> Matrix | None:
        result = np.eye(4)
        for name in self.chain(frame):
            if name == ancestor:
                return result
            step = self.links[name].at(time_ns)
            if step is None:
                return None
            result = step @ result
        return result
