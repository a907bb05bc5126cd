# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A map behind `ovimap serve`, finished or being made (docs/http-api.md)."""

from __future__ import annotations

import functools
import http.client
import json
import ssl
import threading
import time
import urllib.parse
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple, ParamSpec, TypeVar

from ..sender import _address
from .backend import (
    MapBackend, MapFault, NoAnswer, RequestRefused, Robot,
    checked_text, checked_time, closest_first, extent, largest_first, middle, moment, point, room_list, rounded, share, spread, title,
)  # fmt: skip
from .facts import (
    Answer, Change, ChangeList, ColorShare, Description, MapObject, MapSummary, Match, Relation, RoomList, StandingPlace, StandingPlaces, Visit,
)  # fmt: skip

TIMEOUT_S = 20.0
QUIET_S = 15.0  # the server says something on the event stream every 5 seconds
NOT_UNDERSTOOD = "the server's answer is not understood; is it `ovimap serve` of this version?"
NEVER = (400, 413)  # the request itself is wrong
BUSY = (429, 503)  # the request was not looked at
TRIES = 4
MOST_PAUSE_S = 2
Given = ParamSpec("Given")
Result = TypeVar("Result")


class _Listed(NamedTuple):
    etag: str
    objects: dict[int, MapObject]


class StandingEvent(NamedTuple):
    """What a server says to standing queries."""

    mark: str  # where the client is then
    kind: str  # "hello", "found", "gone", "fault"
    said: dict[str, Any]


def _understood(method: Callable[Given, Result]) -> Callable[Given, Result]:
    """What another program at that port answers is a fault like any other."""

    @functools.wraps(method)
    def asked(*arguments: Given.args, **options: Given.kwargs) -> Result:
        try:
            return method(*arguments, **options)
        except (KeyError, IndexError, TypeError, AttributeError):
            raise MapFault(NOT_UNDERSTOOD) from None

    return asked


class HttpBackend(MapBackend):
    def __init__(self, url: str, *, name: str = "", token: str = "", cafile: str | None = None) -> None:
        try:
            self._parts = _address(url)
        except ValueError as fault:
            raise MapFault(str(fault)) from None
        super().__init__(name or self._parts.netloc)
        given = urllib.parse.parse_qs(self._parts.query).get("token")
        shown = token or (given[0] if given else "")
        self._headers = {"Authorization": f"Bearer {shown}"} if shown else {}
        self._trust = ssl.create_default_context(cafile=cafile) if self._parts.scheme == "https" else None
        self._lock = threading.Lock()  # guards what follows
        self._listed: _Listed | None = None

    @_understood
    def summary(self) -> MapSummary:
        about = self._get("/api/map")
        things = list(self._objects().values())
        low, high = extent(things)
        search = about["search"]
        return MapSummary(
            self.name, about["live"], len(things), about["frames"], search["state"] != "unavailable", search["reason"],
            point(about["up"]) or (0.0, 0.0, 1.0), low, high,
        )  # fmt: skip

    @_understood
    def objects(self) -> list[MapObject]:
        return largest_first(list(self._objects().values()))

    @_understood
    def find(self, text: str, exclude: Sequence[str] = ()) -> Answer:
        checked_text(text)
        said = self._post("/api/query", {"text": text, "not": list(exclude)})
        objects = self._objects()
        matches = [
            Match(**vars(objects[match["id"]]), probability=share(match["probability"]), score=rounded(match["standard_score"]), evidence=match["evidence"])
            for match in said["matches"]
            if match["id"] in objects  # a map that is being made may have lost one since
        ]
        count = said["count"]["found"] if said["count"] else None
        return Answer(self.name, said["query"], said["verdict"] == "found", said["reading"], said["reason"], count, matches)

    @_understood
    def describe(self, id: int) -> Description:
        said = self._get(f"/api/instances/{id}")
        thing = _object(said)
        return Description(
            **vars(thing), map=self.name, looks_like=(said["label"] or {}).get("name", ""),
            colors=[ColorShare(color["name"], rounded(color["share"])) for color in said["colors"]],
            height_m=said["height_m"], footprint_m2=said["footprint_m2"], views=said["views"], pictures=len(said["crops"]),
            relations=self.relations(id),
        )  # fmt: skip

    @_understood
    def relations(self, id: int) -> list[Relation]:
        objects = self._objects()
        if id not in objects:
            raise MapFault(f"map '{self.name}' has no object {id}; objects() lists those it has")
        found = []
        for said in self._get("/api/relations")["relations"]:
            object, anchor = said["object"], said["anchor"]
            if id in (object, anchor) and object in objects and anchor in objects:
                found.append(Relation(object, objects[object].title, said["relation"], anchor, objects[anchor].title, said["evidence"]))
        return closest_first(found)

    @_understood
    def rooms(self) -> RoomList:
        return room_list(self.name, self._get("/api/rooms"))

    @_understood
    def what_changed(self, since: str = "", until: str = "") -> ChangeList:
        times = {"since": checked_time(since), "until": checked_time(until)}
        said = self._get("/api/changes?" + urllib.parse.urlencode({name: time for name, time in times.items() if time}))
        visits = [Visit(visit["visit"], moment(visit["begin_s"]), moment(visit["end_s"])) for visit in said["visits"]]
        return ChangeList(self.name, visits, [_change(change) for change in said["changes"]])

    @_understood
    def where_to_stand(self, id: int, robot: Robot) -> StandingPlaces:
        asked = {"instance": id, **{name: value for name, value in vars(robot).items() if name != "start"}}
        said = self._post("/api/approach", asked | ({"from": list(robot.start)} if robot.start else {}))
        numbers = ("x", "y", "yaw", "tilt", "seen", "distance_m", "way_m")
        places = [StandingPlace(**{name: rounded(pose[name]) for name in numbers}, way=[(rounded(x), rounded(y)) for x, y in pose["way"]]) for pose in said["poses"]]
        return StandingPlaces(self.name, id, places, said["reason"])

    @_understood
    def crops(self, id: int, most: int) -> list[bytes]:
        ordinals = self._get(f"/api/instances/{id}")["crops"]
        return [self._ask("GET", f"/api/instances/{id}/crops/{ordinals[i]}")[1] for i in spread(len(ordinals), most)]

    def place(self, id: int) -> bytes:
        return self._ask("GET", f"/api/instances/{id}/place")[1]

    def rename(self, id: int, name: str) -> int:
        return self._correct({"kind": "rename", "instance": id, "name": name})

    def merge(self, id: int, into: int) -> int:
        return self._correct({"kind": "merge", "instance": id, "into": into})

    def undo(self, correction: int) -> int:
        return self._correct({"kind": "undo", "edit": correction})

    def watch(self, queries: Sequence[str], hold_s: float, mark: str = "") -> Iterator[StandingEvent]:
        """What becomes of standing queries, until the connection ends, which raises NoAnswer. mark: of the last event that came, so
        that it goes on from there. Raises RequestRefused for what the server will never take."""
        body = json.dumps({"queries": list(queries), "hold_s": hold_s}).encode()
        headers = {"Content-Type": "application/json", **({"Last-Event-ID": mark} if mark else {}), **self._headers}
        connection = self._connection(QUIET_S)
        try:
            connection.request("POST", "/api/watch", body, headers)
            reply = connection.getresponse()
            if reply.status != 200:
                kind = RequestRefused if reply.status in NEVER else MapFault
                raise kind(_refusal(reply.status, reply.read()))
            if not reply.headers.get("Content-Type", "").startswith("text/event-stream"):
                raise MapFault(NOT_UNDERSTOOD)
            yield from _events_of(reply)
        except (OSError, http.client.HTTPException) as fault:
            raise self._silence(fault) from None
        finally:
            connection.close()
        raise self._silence("the connection ended")

    @_understood
    def _objects(self) -> dict[int, MapObject]:
        """Asked for again only where they changed."""
        with self._lock:
            known = self._listed
        etag, body = self._ask("GET", "/api/instances", headers={"If-None-Match": known.etag} if known else {})
        if known and not body:
            return known.objects
        entries = _parsed(body)["instances"]
        listed = _Listed(etag, {entry["id"]: _object(entry) for entry in entries})
        with self._lock:
            self._listed = listed
        return listed.objects

    @_understood
    def _correct(self, edit: dict[str, Any]) -> int:
        number: int = self._post("/api/corrections", edit)["edit"]
        return number

    def _get(self, path: str) -> dict[str, Any]:
        return _parsed(self._ask("GET", path)[1])

    def _post(self, path: str, value: Any) -> dict[str, Any]:
        body = json.dumps(value).encode()
        return _parsed(self._ask("POST", path, body, {"Content-Type": "application/json"})[1])

    def _connection(self, timeout_s: float) -> http.client.HTTPConnection:
        host = self._parts.hostname or "localhost"
        if self._trust is not None:
            return http.client.HTTPSConnection(host, self._parts.port, timeout=timeout_s, context=self._trust)
        return http.client.HTTPConnection(host, self._parts.port, timeout=timeout_s)

    def _ask(self, method: str, path: str, body: bytes | None = None, headers: dict[str, str] | None = None) -> tuple[str, bytes]:
        """ETag and body of the answer; no body where nothing changed (304). A server that has too much to do is asked again."""
        for _ in range(TRIES):
            status, head, text = self._once(method, path, body, headers)
            if status not in BUSY:
                break
            said = head.get("Retry-After", "")
            time.sleep(min(int(said), MOST_PAUSE_S) if said.isdigit() else 1)
        if status >= 400:
            raise MapFault(_refusal(status, text))
        return head.get("ETag", ""), text

    def _silence(self, fault: Exception | str) -> NoAnswer:
        return NoAnswer(f"the server {self._parts.netloc} does not answer ({fault or type(fault).__name__}); is `ovimap serve` running there?")

    def _once(self, method: str, path: str, body: bytes | None, headers: dict[str, str] | None) -> tuple[int, http.client.HTTPMessage, bytes]:
        connection = self._connection(TIMEOUT_S)
        try:
            connection.request(method, path, body, {**self._headers, **(headers or {})})
            reply = connection.getresponse()
            text = reply.read()
        except (OSError, http.client.HTTPException) as fault:
            raise self._silence(fault) from None
        finally:
            connection.close()
        return reply.status, reply.headers, text


def _events_of(reply: http.client.HTTPResponse) -> Iterator[StandingEvent]:
    """Server-sent events (WHATWG HTML, section 9.2), as this server writes them."""
    fields: dict[str, str] = {}
    while line := reply.readline():
        name, colon, value = line.decode(errors="replace").rstrip("\n").partition(": ")
        if colon and name:
            fields[name] = value
        elif not name and not colon and "event" in fields:
            yield StandingEvent(fields.get("id", ""), fields["event"], _parsed(fields.get("data", "").encode()))
            fields = {}


def _change(said: dict[str, Any]) -> Change:
    before, after = said["before"], said["after"]
    return Change(
        said["instance"], title(said["name"], said["label"]), bool(said["name"]), said["event"], said["text"], said["visit"], moment(said["time_s"]),
        middle(before["min"], before["max"]) if before else None, middle(after["min"], after["max"]) if after else None, said["may_be"],
    )  # fmt: skip


def _object(said: dict[str, Any]) -> MapObject:
    low, high = said["box"]["min"], said["box"]["max"]
    center = middle(low, high)
    size = point(b - a for a, b in zip(low, high)) if center else None
    guess = (said["label"] or {}).get("name", "")
    return MapObject(said["id"], title(said["name"], guess), bool(said["name"]), center, size)


def _parsed(text: bytes) -> dict[str, Any]:
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        value = None
    if not isinstance(value, dict):
        raise MapFault("the server's answer is no JSON object; is it `ovimap serve`?")
    return value


def _refusal(status: int, text: bytes) -> str:
    try:
        said = _parsed(text).get("error")
    except MapFault:
        said = None
    return " ".join(said.split()) if isinstance(said, str) else f"the server answered {status}"
