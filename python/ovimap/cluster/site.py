# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""One large site: mapped as overlapping ranges of frames side by side, and merged two by two."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Callable, Sequence
from typing import Any

from .._ovimap import Error, open_source
from ..files import exclusive
from ..map_facts import map_facts
from .jobs import Job
from .program import run_program
from .records import claim, finished, lock_of, write_record
from .scenes import map_job


def part_ranges(frames: int, parts: int, overlap: int) -> list[tuple[int, int]]:
    """Cuts frames 0 .. frames-1 into ranges [first, end) of like length; each but the last runs on into the next
    by `overlap` frames. Raises Error where a part would be no longer than the overlap."""
    if parts < 2:
        raise Error("a site has 2 parts or more; for one, use `ovimap run`")
    if frames // parts <= overlap:
        raise Error(f"{parts} parts of {frames} frames have {frames // parts} frames each, which must be more than the "
                    f"overlap of {overlap}; give fewer parts or a smaller overlap")
    cuts = [frames * part // parts for part in range(parts + 1)]
    return [(first, min(end + overlap, frames)) for first, end in zip(cuts, cuts[1:])]


def site_jobs(
    source: str, map: pathlib.Path, *, parts: int, overlap: int, options: Sequence[str] = (), cpus: int = 1, program: str = ""
) -> list[Job]:
    """The jobs that make one map of a recording; the last one writes it. The maps of the parts stay in MAP.parts/."""
    folder = map.with_name(f"{map.stem}.parts")
    jobs = []
    for number, (first, end) in enumerate(part_ranges(len(open_source(source)), parts, overlap)):
        name = f"part-{number}"
        jobs.append(map_job(name, source, folder / f"{name}.ovimap", frames=f"{first}:{end}", options=options, cpus=cpus, program=program))
    return jobs + _merges(jobs, folder, map, cpus, program)


def _merges(parts: list[Job], folder: pathlib.Path, map: pathlib.Path, cpus: int, program: str) -> list[Job]:
    # Neighbours first: they overlap. A balanced tree lets the merges of one level run side by side.
    merges: list[Job] = []
    level = [(job, job.order["map"], str(number), str(number)) for number, job in enumerate(parts)]
    while len(level) > 1:
        above = []
        for (a, a_map, first, _), (b, b_map, _, last) in zip(level[::2], level[1::2]):
            name = f"parts-{first}-{last}"
            target = map if len(level) == 2 else folder / f"{name}.ovimap"
            order = {"a": a_map, "b": b_map, "map": os.path.abspath(target), "cpus": cpus, "program": program, "cwd": os.getcwd()}
            job = Job(name, merge_maps, order, cpus=cpus, needs=(a, b))
            merges.append(job)
            above.append((job, order["map"], first, last))
        level = above + level[len(level) - len(level) % 2:]
    return merges


def merge_maps(order: dict[str, Any], tell: Callable[[int, int], None]) -> dict[str, Any]:
    """Merges two maps of one frame of reference, unless that is done. Runs on a worker."""
    map = pathlib.Path(order["map"])
    made_by = {side: [order[side], map_facts(order[side]).revision] for side in ("a", "b")}
    with exclusive(lock_of(map)) as lock:
        report = finished(map, made_by)
        if report is not None:
            return report | {"there": True}
        claim(map, made_by)
        said = run_program(["merge", order["a"], order["b"], "-o", str(map), "--threads", str(order["cpus"])],
                           program=order["program"], lock=lock, cwd=order["cwd"])
        report = {"map": str(map), "instances": said["instances"], "conflicts": said["conflicts"]}
        write_record(map, made_by, report)
    return report
