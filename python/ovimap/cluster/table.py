# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""How jobs get on: a table that is redrawn on a terminal, a line for each change anywhere else."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TextIO

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text

from .jobs import Audience, Job

COLOURS = {"done": "green", "failed": "red", "left out": "red", "running": "cyan"}


@contextmanager
def audience_of(jobs: Sequence[Job], stream: TextIO | None = None) -> Iterator[Audience]:
    """Shows jobs on a stream (stderr) while the block runs."""
    stream = stream or sys.stderr
    if not stream.isatty():
        yield Lines(stream)
        return
    with Live(console=Console(file=stream), auto_refresh=False) as live:
        drawing = Drawing(jobs, live)
        yield drawing
        drawing.refresh()


class Lines:
    """A line when a job begins, is lost and ends."""

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream

    def changed(self, job: Job) -> None:
        print(f"{job.name}: {state_of(job)}{_and(outcome_of(job))}", file=self.stream, flush=True)

    def refresh(self) -> None:
        pass


class Drawing:
    """The table. On many jobs those that are over leave it, but for what went wrong."""

    ROWS = 30

    def __init__(self, jobs: Sequence[Job], live: Live) -> None:
        self.jobs, self.live = jobs, live

    def changed(self, job: Job) -> None:
        pass

    def refresh(self) -> None:
        self.live.update(table_of(self.jobs, self.ROWS), refresh=True)


def table_of(jobs: Sequence[Job], rows: int) -> Table:
    """At most `rows` jobs: those under way and those that went wrong before those that wait or are done."""
    urgency = {"running": 0, "failed": 1, "left out": 1, "waiting": 2, "done": 3}
    shown = set(map(id, sorted(jobs, key=lambda job: urgency[job.state])[:rows]))
    over = sum(job.state == "done" for job in jobs)
    table = Table(title=f"{over} of {len(jobs)} done", title_justify="left", expand=False)
    for column in ("job", "state", "frames", "tries", "outcome"):
        table.add_column(column, justify="right" if column in ("frames", "tries") else "left", overflow="fold")
    for job in jobs:
        if id(job) in shown:
            frames = f"{job.done} of {job.total}" if job.total else ""
            state = Text(job.state, COLOURS.get(job.state, ""))
            table.add_row(Text(job.name), state, frames, str(job.tries) if job.tries > 1 else "", Text(outcome_of(job)))
    return table


def state_of(job: Job) -> str:
    return f"{job.state}, try {job.tries}" if job.state == "running" and job.tries > 1 else job.state


def outcome_of(job: Job) -> str:
    if job.fault:
        return job.fault if job.state != "waiting" else f"{job.fault}; trying again"
    if job.report.get("there"):
        return "was there already"
    told = [f"{job.report[key]} {word}" for key, word in (("instances", "objects"), ("frames", "frames")) if key in job.report]
    return ", ".join([*told, f"{job.seconds:.1f} s"]) if job.state == "done" else ""


def _and(text: str) -> str:
    return f": {text}" if text else ""
