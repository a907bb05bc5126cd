# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What is said of maps and their objects. Lengths are metres in the map's world frame; None: not known.

The texts below the fields are what an agent reads of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

Point = tuple[float, float, float]
_DOCUMENTED: dict[str, bool] = {"use_attribute_docstrings": True}


@dataclass(frozen=True)
class MapSummary:
    """A map at this moment."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    map: str
    """what to call it in the other tools"""
    being_made: bool
    """a camera still moves through it: objects come, change and merge"""
    objects: int
    frames: int
    """pictures with depth that it is made of"""
    searchable: bool
    """find() works"""
    why_not_searchable: str
    """a sentence; empty where it is"""
    up: Point
    """direction away from the floor"""
    lowest: Point | None
    """corner of the box around all objects"""
    highest: Point | None
    """the opposite corner"""


@dataclass(frozen=True)
class MapObject:
    """An object of a map."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    id: int
    title: str
    """the name that a person gave it, else what it looks like, else "object\""""
    named: bool
    """a person gave the name"""
    center: Point | None
    size: Point | None
    """of its box along the axes of the world"""


@dataclass(frozen=True)
class Match(MapObject):
    """An object that may be what was asked for."""

    probability: float | None
    """that it is what was asked for"""
    score: float
    """standard deviations above unrelated things"""
    evidence: str
    """why a relation holds"""


@dataclass(frozen=True)
class Answer:
    """What a map says to a question."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    map: str
    text: str
    found: bool
    """False: it is not in the map, and the matches are only what comes nearest"""
    reading: str
    """how a phrase was understood, as "[mug] on [table]"; empty: as a plain name"""
    reason: str
    """why a phrase was not found"""
    count: int | None
    """of "how many" and "two ...": of how many objects it is true"""
    matches: list[Match]
    """best first"""


@dataclass(frozen=True)
class Relation:
    """How one object stands to another: "object RELATION anchor"."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    object: int
    object_title: str
    relation: str
    """on, inside, above, beside or near; beside and near hold both ways"""
    anchor: int
    anchor_title: str
    evidence: str


@dataclass(frozen=True)
class Relations:
    """All relations of one object."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    map: str
    of: int
    relations: list[Relation]


@dataclass(frozen=True)
class ColorShare:
    """A colour of an object."""

    name: str
    share: float


@dataclass(frozen=True)
class Description(MapObject):
    """What a map knows of one object."""

    map: str
    looks_like: str
    """what it clearly is by looks and size, else "object"; empty: not known yet"""
    colors: list[ColorShare]
    """of its surface, largest share first"""
    height_m: float | None
    footprint_m2: float | None
    """seen from above"""
    views: int
    """frames in which it was seen"""
    pictures: int
    """that the map keeps of it; look() shows them"""
    relations: list[Relation]


@dataclass(frozen=True)
class Room:
    """A part of the floor within walls and doors."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    id: int
    name: str
    """what it is by the things in it ("kitchen"), else "room 2\""""
    area_m2: float
    center: Point
    objects: list[int]
    """ids of what is in it"""


@dataclass(frozen=True)
class Door:
    """Where one goes from a room into another."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    rooms: tuple[int, int]
    place: Point
    width_m: float


@dataclass(frozen=True)
class RoomList:
    """All rooms of a map, largest first, and the doors between them."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    map: str
    rooms: list[Room]
    doors: list[Door]


@dataclass(frozen=True)
class Visit:
    """A time that a camera came by."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    visit: int
    """from 1"""
    began: str | None
    """date and time (ISO 8601) of the first frame, where that is known"""
    ended: str | None


@dataclass(frozen=True)
class Change:
    """What became of an object. What is gone has an id as well, but no other tool knows it."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    id: int
    title: str
    """the name that a person gave it, else what it looks like, else "object\""""
    named: bool
    """a person gave the name"""
    event: str
    """appeared, gone or moved"""
    told: str
    """the same in a sentence"""
    visit: int
    """that found it; it happened some time since the visit before"""
    time: str | None
    """when that was noticed (ISO 8601), where that is known"""
    before: Point | None
    """centre of its box where it was; None: it was not there"""
    after: Point | None
    """where it is; None: it is gone"""
    may_be: int | None
    """of what appeared: a gone object that it resembles and may be"""


@dataclass(frozen=True)
class ChangeList:
    """What changed in a map."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    map: str
    visits: list[Visit]
    """all that the map is made of, oldest first; of one visit nothing can be told"""
    changes: list[Change]
    """one an object, by id"""


@dataclass(frozen=True)
class StandingPlace:
    """A place from which an object is seen. x, y and yaw are in a frame whose z is up: the world's, where z is up there."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    x: float
    y: float
    yaw: float
    """direction of the gaze, radians from x towards y"""
    tilt: float
    """of the gaze, radians upwards from level"""
    seen: float
    """share of the object's visible surface that is seen from here"""
    distance_m: float
    """from the camera to the object's middle"""
    way_m: float
    """length of the way there; 0 where no start was given"""
    way: list[tuple[float, float]]
    """corners (x, y) of the way, from the start to here"""


@dataclass(frozen=True)
class StandingPlaces:
    """Where a robot can stand to see an object."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    map: str
    object: int
    places: list[StandingPlace]
    """best first; empty: it cannot be seen or reached"""
    reason: str
    """why there are none"""


@dataclass(frozen=True)
class ObjectList:
    """Objects of a map, largest first."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    map: str
    total: int
    """objects that the map has"""
    objects: list[MapObject]


@dataclass(frozen=True)
class Correction:
    """A line of a map's log of corrections."""

    __pydantic_config__: ClassVar[dict[str, bool]] = _DOCUMENTED
    map: str
    correction: int
    """its number, by which undo() takes it back"""
    done: str
