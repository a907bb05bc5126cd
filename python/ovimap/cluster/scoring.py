# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Many maps against their truths: each scored on its own, those that could be scored pooled."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any

from .._ovimap import Error
from ..commands import eval
from ..map_facts import map_facts
from .jobs import Job


def eval_jobs(maps: Sequence[str], truths: Sequence[str], *, classes: str = "auto", encoder: str = "auto", cpus: int = 1) -> list[Job]:
    """A job for each map. truths: in the maps' order; none: the recordings that the maps came from."""
    if truths and len(truths) != len(maps):
        raise Error(f"{len(maps)} maps and {len(truths)} truths; give one truth for each map, in the same order")
    choice = {"classes": classes, "encoder": encoder, "cwd": os.getcwd()}
    return [
        Job(map, score, {"maps": [os.path.abspath(map)], "truths": [truth], **choice}, cpus=cpus)
        for map, truth in zip(maps, truths or [""] * len(maps), strict=True)
    ]


def pool_job(scenes: Sequence[Job]) -> Job:
    """Pools the scenes that could be scored. Precision over scenes is no mean of theirs: it needs every object again."""
    scored = [job for job in scenes if job.state == "done"]
    if not scored:
        raise Error(f"no map could be scored; the first: {scenes[0].fault}" if scenes else "there is no map to score")
    order = {side: [path for job in scored for path in job.order[side]] for side in ("maps", "truths")}
    return Job("pooled", score, scored[0].order | order, cpus=scored[0].cpus)


def score(order: dict[str, Any], tell: Callable[[int, int], None]) -> dict[str, Any]:
    """Runs on a worker. A map is asked for its recording here, so that one that cannot be read fails alone."""
    truths = [os.path.join(order["cwd"], truth or _recording_of(map)) for map, truth in zip(order["maps"], order["truths"], strict=True)]
    return eval(order["maps"], truths, classes=order["classes"], encoder=order["encoder"])


def _recording_of(map: str) -> str:
    recording = map_facts(map).recording
    if not recording:
        raise Error(f"{map} was made of pushed frames; name its truth")
    return recording
