# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Many recordings, a map each: one job a scene, which goes on from the scene's checkpoint when it is run again."""

from __future__ import annotations

import os
import pathlib
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from .._ovimap import Error
from ..files import exclusive
from ..map_facts import MapFacts, map_facts
from .jobs import Job
from .program import Crash, run_program
from .records import checkpoint_of, claim, finished, lock_of, write_record

KEPT = ("frames", "frames_skipped", "instances", "seconds")  # of what the program reports


def scene_jobs(
    sources: Sequence[str], folder: pathlib.Path, *, frames: str = ":", options: Sequence[str] = (), cpus: int = 1, program: str = ""
) -> list[Job]:
    """A job for each recording, which makes FOLDER/NAME.ovimap. options: of `ovimap run`."""
    paths = [os.path.abspath(source) for source in sources]
    repeated = [path for path, count in Counter(paths).items() if count > 1]
    if repeated:
        raise Error(f"{repeated[0]} is named twice; give each scene once")
    return [
        map_job(name, path, folder / f"{name}.ovimap", frames=frames, options=options, cpus=cpus, program=program)
        for name, path in zip(scene_names(paths), paths, strict=True)
    ]


def map_job(
    name: str, source: str, map: pathlib.Path, *, frames: str = ":", options: Sequence[str] = (), cpus: int = 1, program: str = ""
) -> Job:
    """A job that makes one map of the frames "FIRST:LAST:STEP" of a recording."""
    made_by = {"source": os.path.abspath(source), "frames": frames, "options": list(options)}
    order = {"made_by": made_by, "map": os.path.abspath(map), "cpus": cpus, "program": program, "cwd": os.getcwd()}
    return Job(name, map_scene, order, cpus=cpus)


def map_scene(order: dict[str, Any], tell: Callable[[int, int], None]) -> dict[str, Any]:
    """Maps a scene, or what is missing of it. Runs on a worker."""
    map, made_by = pathlib.Path(order["map"]), order["made_by"]
    with exclusive(lock_of(map)) as lock:
        report = finished(map, made_by)
        if report is not None:
            return report | {"there": True}
        begun = _begun(map)
        _refuse_anothers(map, begun, made_by["source"])
        claim(map, made_by)  # the program cannot tell whose frames it goes on with
        command = ["run", made_by["source"], "-o", str(map), "--frames", made_by["frames"], "--resume"]
        command += ["--threads", str(order["cpus"]), *made_by["options"]]
        said = run_program(command, program=order["program"], lock=lock, cwd=order["cwd"], tell=tell)
        if said["interrupted"]:
            raise Crash("the program was asked to stop")
        report = {"map": str(map), "resumed_from": begun.frames if begun else 0} | {key: said[key] for key in KEPT}
        write_record(map, made_by, report)
    return report


def scene_names(paths: Sequence[str]) -> list[str]:
    """The last parts of the paths, as many as tell them apart: a/room and b/room become a-room and b-room."""
    parts = [pathlib.Path(path).parts[1:] for path in paths]
    for count in range(1, max(map(len, parts), default=1) + 1):
        names = ["-".join(each[-count:]) for each in parts]
        if len(set(names)) == len(names):
            return names
    raise Error("the scenes' paths cannot be told apart; rename one of them")


def _begun(map: pathlib.Path) -> MapFacts | None:
    """What a lost worker left; None where there is no checkpoint, or none was ever completed."""
    try:
        return map_facts(checkpoint_of(map))
    except Error:
        return None


def _refuse_anothers(map: pathlib.Path, begun: MapFacts | None, source: str) -> None:
    """The program goes on with any map of the same settings; it must be one of this recording, too."""
    there = begun or (map_facts(map) if map.exists() else None)
    if there is not None and not (there.recording and os.path.abspath(there.recording) == source):
        raise Error(f"{map} is a map of {there.recording or 'pushed frames'}, not of {source}; "
                    "give another output, or delete it with what lies beside it")
