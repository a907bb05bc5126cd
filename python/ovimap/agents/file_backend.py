# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A map file, read through the Python package and read again whenever it changes."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import threading
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from .._ovimap import Error, Map
from .backend import (
    MapBackend, MapFault, Robot, Verdict,
    checked_text, checked_time, closest_first, extent, largest_first, middle, moment, point, room_list, rounded, share, spread, title,
)  # fmt: skip
from .facts import (
    Answer, Change, ChangeList, ColorShare, Description, MapObject, MapSummary, Match, Relation, RoomList, StandingPlace, StandingPlaces, Visit,
)  # fmt: skip

Stamp = tuple[int, int, int]


class _Opened(NamedTuple):
    """The map as one state of the file has it."""

    stamp: Stamp
    map: Map
    objects: dict[int, MapObject]
    relations: list[Relation]
    digest: str  # of what queries depend on


class FileBackend(MapBackend):
    def __init__(self, path: str, *, name: str = "") -> None:
        super().__init__(name or os.path.splitext(os.path.basename(path))[0])
        self._path = path
        self._lock = threading.Lock()  # guards what follows
        self._opened: _Opened | None = None

    def summary(self) -> MapSummary:
        with self._faults():
            opened = self._now()
            things = list(opened.objects.values())
            low, high = extent(things)
            embedded = opened.map.encoder != ""
            return MapSummary(
                self.name, False, len(things), opened.map.frames, embedded,
                "" if embedded else "the map has no embeddings; `ovimap reembed` gives it some",
                point(opened.map.up) or (0.0, 0.0, 1.0), low, high,
            )  # fmt: skip

    def objects(self) -> list[MapObject]:
        with self._faults():
            return largest_first(list(self._now().objects.values()))

    def find(self, text: str, exclude: Sequence[str] = ()) -> Answer:
        checked_text(text)
        with self._faults():
            opened = self._now()
            answer = opened.map.query(text, negatives=list(exclude))
            matches = []
            for match in answer.matches:
                if match.id not in opened.objects:  # a question about the past may find what is gone
                    continue
                thing = opened.objects[match.id]
                matches.append(Match(**vars(thing), probability=share(match.probability), score=rounded(match.standard_score), evidence=match.evidence))
            return Answer(self.name, answer.query, answer.found, answer.reading, answer.reason, answer.count, matches)

    def describe(self, id: int) -> Description:
        with self._faults():
            opened = self._now()
            thing = self._known(opened, id)
            facts = opened.map.describe(id)
            colors = [ColorShare(name, rounded(part)) for name, part in facts.colors]
            views = int(opened.map.instances.views[opened.map.instances.ids.tolist().index(id)])
            return Description(
                **vars(thing), map=self.name, looks_like=facts.label, colors=colors, height_m=rounded(facts.height_m),
                footprint_m2=rounded(facts.footprint_m2), views=views, pictures=len(opened.map.crops(id)),
                relations=_of(opened.relations, id),
            )  # fmt: skip

    def relations(self, id: int) -> list[Relation]:
        with self._faults():
            opened = self._now()
            self._known(opened, id)
            return _of(opened.relations, id)

    def rooms(self) -> RoomList:
        with self._faults():
            return room_list(self.name, json.loads(self._now().map.scene_graph()))

    def what_changed(self, since: str = "", until: str = "") -> ChangeList:
        with self._faults():
            opened = self._now()
            visits = [Visit(said.visit, moment(said.begin_s), moment(said.end_s)) for said in opened.map.visits]
            changes = [
                Change(
                    said.id, title(said.name, said.label), bool(said.name), said.event, said.text, said.visit, moment(said.time_s),
                    middle(*said.before) if said.before else None, middle(*said.after) if said.after else None, said.may_be,
                )
                for said in opened.map.changes(since=checked_time(since), until=checked_time(until))
            ]  # fmt: skip
            return ChangeList(self.name, visits, changes)

    def where_to_stand(self, id: int, robot: Robot) -> StandingPlaces:
        with self._faults():
            opened = self._now()
            self._known(opened, id)
            found = opened.map.approach(
                id, start=robot.start, radius_m=robot.radius_m, camera_height_m=robot.camera_height_m, fov_deg=robot.fov_deg, range_m=robot.range_m
            )
            places = [
                StandingPlace(
                    rounded(pose.x), rounded(pose.y), rounded(pose.yaw), rounded(pose.tilt), rounded(pose.seen), rounded(pose.distance_m),
                    rounded(pose.way_m), [(rounded(x), rounded(y)) for x, y in pose.way],
                )
                for pose in found.poses
            ]  # fmt: skip
            return StandingPlaces(self.name, id, places, found.reason)

    def crops(self, id: int, most: int) -> list[bytes]:
        with self._faults():
            opened = self._now()
            self._known(opened, id)
            files = opened.map.crops(id)
            return [files[i] for i in spread(len(files), most)]

    def place(self, id: int) -> bytes:
        with self._faults():
            opened = self._now()
            self._known(opened, id)
            return opened.map.place(id)

    def rename(self, id: int, name: str) -> int:
        with self._faults():
            opened = self._now()
            self._known(opened, id)
            return opened.map.rename(id, name)

    def merge(self, id: int, into: int) -> int:
        with self._faults():
            opened = self._now()
            self._known(opened, id)
            self._known(opened, into)
            return opened.map.merge(id, into)

    def undo(self, correction: int) -> int:
        with self._faults():
            return self._now().map.undo(correction)

    # What standing queries need.

    def state(self) -> str:
        """What changes whenever an object does, apart from its name."""
        with self._faults():
            return self._now().digest

    def verdicts(self, texts: Sequence[str]) -> list[Verdict]:
        """Of each text, by the map as it is now."""
        with self._faults():
            opened = self._now()
        return [self._verdict(opened, text) for text in texts]

    def _verdict(self, opened: _Opened, text: str) -> Verdict:
        try:
            answer = opened.map.query(text)
        except Error as fault:
            return Verdict(False, None, fault=str(fault))
        if not answer.found:
            return Verdict(False, None)
        best = answer.matches[0]
        return Verdict(True, opened.objects.get(best.id), share(best.probability))

    @contextlib.contextmanager
    def _faults(self) -> Iterator[None]:
        try:
            yield
        except Error as fault:
            raise MapFault(" ".join(str(fault).split())) from None
        except OSError as fault:
            raise MapFault(f"the map '{self._path}' cannot be read: {fault.strerror or fault}") from None

    def _now(self) -> _Opened:
        """The map as its file is; somebody may have corrected or replaced it."""
        with self._lock:
            stamp = _stamp(self._path)
            if self._opened is None:
                self._opened = _open(stamp, Map.open(self._path))
            elif self._opened.stamp != stamp:
                self._opened = _open(stamp, self._opened.map.reopened())
            return self._opened

    def _known(self, opened: _Opened, id: int) -> MapObject:
        if id not in opened.objects:
            raise MapFault(f"map '{self.name}' has no object {id}; objects() lists those it has")
        return opened.objects[id]


def _stamp(path: str) -> Stamp:
    """Of the file; another one in its place has another."""
    status = os.stat(path)
    return status.st_ino, status.st_size, status.st_mtime_ns


def _open(stamp: Stamp, opened: Map) -> _Opened:
    objects: dict[int, MapObject] = {}
    rows = opened.instances
    guesses = opened.guess_names() or [("", 0.0)] * len(opened)
    for id, box, name, (guess, _) in zip(rows.ids.tolist(), rows.boxes.tolist(), rows.names, guesses, strict=True):
        low, high = box
        center, size = middle(low, high), point(b - a for a, b in zip(low, high))
        objects[id] = MapObject(id, title(name, guess), bool(name), center, size)
    relations = [
        Relation(said.object, objects[said.object].title, said.relation, said.anchor, objects[said.anchor].title, said.evidence)
        for said in opened.relations()
    ]
    arrays = (rows.ids, rows.boxes, rows.centroids, rows.points, rows.views, opened.embeddings)
    digest = hashlib.blake2b(b"".join(array.tobytes() for array in arrays), digest_size=16).hexdigest()
    return _Opened(stamp, opened, objects, relations, digest)


def _of(relations: list[Relation], id: int) -> list[Relation]:
    return closest_first([said for said in relations if id in (said.object, said.anchor)])
