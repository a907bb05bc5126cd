# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""One way to ask a map, whether it is a finished file or one that a server is making."""

from __future__ import annotations

import abc
import datetime
import math
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from .facts import Answer, ChangeList, Description, Door, MapObject, MapSummary, Point, Relation, Room, RoomList, StandingPlaces

MOST_TEXT_CHARS = 2000  # of a query; docs/query.md


class MapFault(RuntimeError):
    """One line that says what is wrong with a request, a map or a server, and what to do."""


class RequestRefused(MapFault):
    """A request that a server will not take, however often it is sent."""


class NoAnswer(MapFault):
    """A server that is not there, or went away in the middle of its answer."""


@dataclass(frozen=True)
class Robot:
    """A round robot with a camera above its middle."""

    start: tuple[float, float] | None = None
    radius_m: float = 0.25
    camera_height_m: float = 1.2
    fov_deg: float = 60.0
    range_m: float = 2.0  # from an object to the robot's middle, at most


@dataclass(frozen=True)
class Verdict:
    """What a map says to a standing query."""

    found: bool
    object: MapObject | None  # the best, where it is found
    probability: float | None = None
    fault: str = ""  # why it could not be asked


class MapBackend(abc.ABC):
    """A map that can be asked. Thread-safe. Everything raises MapFault, with one line; what is asked afterwards is answered
    as if that had not been."""

    def __init__(self, name: str) -> None:
        self.name = name

    @abc.abstractmethod
    def summary(self) -> MapSummary: ...

    @abc.abstractmethod
    def objects(self) -> list[MapObject]:
        """All of them, largest box first."""

    @abc.abstractmethod
    def find(self, text: str, exclude: Sequence[str] = ()) -> Answer:
        """What fits the text, in the grammar of docs/query.md; exclude: what it must not be."""

    @abc.abstractmethod
    def describe(self, id: int) -> Description: ...

    @abc.abstractmethod
    def relations(self, id: int) -> list[Relation]: ...

    @abc.abstractmethod
    def rooms(self) -> RoomList:
        """Of finished maps alone."""

    @abc.abstractmethod
    def what_changed(self, since: str = "", until: str = "") -> ChangeList:
        """Between two times as people write them (docs/query.md, "Times"); empty: the beginning, and the last visit."""

    @abc.abstractmethod
    def where_to_stand(self, id: int, robot: Robot) -> StandingPlaces:
        """Of finished maps alone."""

    @abc.abstractmethod
    def crops(self, id: int, most: int) -> list[bytes]:
        """JPEG files that show the object, spread over the frames that it was seen in."""

    @abc.abstractmethod
    def place(self, id: int) -> bytes:
        """A JPEG file: the map from above with the object in red."""

    @abc.abstractmethod
    def rename(self, id: int, name: str) -> int:
        """Returns the number of the correction, as merge and undo do."""

    @abc.abstractmethod
    def merge(self, id: int, into: int) -> int: ...

    @abc.abstractmethod
    def undo(self, correction: int) -> int: ...

    def close(self) -> None:
        """Lets go of what is open."""


def open_map(spec: str | os.PathLike[str], *, name: str = "", token: str = "", cafile: str | None = None) -> MapBackend:
    """A map file, or the address of a server ("http://localhost:8080/"). Nothing is read yet.

    token: what the server asks for (`ovimap serve --token-file`). cafile: the certificates to trust, PEM."""
    text = os.fspath(spec)
    if "://" in text:
        from .http_backend import HttpBackend

        return HttpBackend(text, name=name, token=token, cafile=cafile)
    from .file_backend import FileBackend

    return FileBackend(text, name=name)


def checked_text(text: str) -> str:
    """Raises MapFault for what no map could be asked."""
    if not text.strip():
        raise MapFault('the text is empty; say what to look for, as "mug on the table"')
    if len(text) > MOST_TEXT_CHARS:
        raise MapFault(f"the text has {len(text)} characters, at most {MOST_TEXT_CHARS} are taken")
    return text


def checked_time(text: str) -> str:
    """Raises MapFault for what is far too long to be a time; the map says of the rest whether it is one."""
    if len(text) > MOST_TEXT_CHARS:
        raise MapFault(f"a time of {len(text)} characters; write it as \"yesterday\", \"visit 2\" or \"2026-03-14 09:30\"")
    return text.strip()


def spread(count: int, most: int) -> list[int]:
    """At most so many of the positions 0 ... count - 1, the first and the last among them."""
    if count <= most:
        return list(range(count))
    if most == 1:
        return [count // 2]
    return [round(i * (count - 1) / (most - 1)) for i in range(most)]


def point(values: Iterable[float | None]) -> Point | None:
    """None where a number is missing or not finite."""
    x, y, z = (value if value is not None and math.isfinite(value) else None for value in values)
    return None if x is None or y is None or z is None else (rounded(x), rounded(y), rounded(z))


def rounded(value: float) -> float:
    """To a millimetre: more digits are noise, and words to an agent."""
    return round(float(value), 3)


def share(value: float | None) -> float | None:
    return None if value is None else rounded(value)


def title(name: str, guess: str) -> str:
    """What an object is called: as a person named it, else as it looks."""
    return name or guess or "object"


def moment(time_s: float | None) -> str | None:
    """ISO 8601, with the offset of this machine's time zone; None also for what no calendar has."""
    try:
        return None if time_s is None else datetime.datetime.fromtimestamp(time_s).astimezone().isoformat(timespec="seconds")
    except (OverflowError, ValueError, OSError):
        return None


def middle(low: Sequence[float | None], high: Sequence[float | None]) -> Point | None:
    """Of a box; None where a corner is not known."""
    if None in low or None in high:
        return None
    return point((a + b) / 2 for a, b in zip(low, high) if a is not None and b is not None)


def room_list(name: str, graph: dict[str, Any]) -> RoomList:
    """What an agent reads of a scene graph (docs/export.md)."""
    rooms = [Room(said["id"], said["name"], rounded(said["area_m2"]), _here(said["center"]), said["objects"]) for said in graph["rooms"]]
    doors = [Door((said["rooms"][0], said["rooms"][1]), _here(said["place"]), rounded(said["width_m"])) for said in graph["doors"]]
    return RoomList(name, rooms, doors)


def _here(values: Sequence[float]) -> Point:
    return rounded(values[0]), rounded(values[1]), rounded(values[2])


def extent(objects: Sequence[MapObject]) -> tuple[Point | None, Point | None]:
    """The corners of the box around all objects."""
    boxes = [(thing.center, thing.size) for thing in objects if thing.center and thing.size]
    if not boxes:
        return None, None
    low = point(min(center[axis] - size[axis] / 2 for center, size in boxes) for axis in range(3))
    high = point(max(center[axis] + size[axis] / 2 for center, size in boxes) for axis in range(3))
    return low, high


def closest_first(relations: list[Relation]) -> list[Relation]:
    """What carries or holds an object says more of it than what is near."""
    order = ("on", "inside", "above", "beside", "near")
    return sorted(relations, key=lambda said: order.index(said.relation) if said.relation in order else len(order))


def largest_first(objects: list[MapObject]) -> list[MapObject]:
    return sorted(objects, key=lambda thing: (-math.prod(thing.size) if thing.size else 0.0, thing.id))
