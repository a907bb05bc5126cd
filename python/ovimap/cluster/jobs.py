# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Jobs on a Ray cluster: what is ready runs, what was lost with its machine runs again, what is bad is told."""

from __future__ import annotations

import logging
import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Protocol

import ray
from ray.exceptions import GetTimeoutError, RayError, RayTaskError
from ray.util.scheduling_strategies import NodeAffinitySchedulingStrategy

from .._ovimap import Error
from ..command_line import line_of
from .program import Crash

WAIT_S = 1.0  # between looks at how far the jobs are
STORE_BYTES = 128 << 20  # jobs hand over paths and figures; Ray would take a third of the memory

Work = Callable[[dict[str, Any], Callable[[int, int], None]], dict[str, Any]]
"""A job's work, on some machine: its order and whom to tell (frames done, all frames) -> its report.

Raises Error for what the user can mend. It must be fit to run again after it was killed anywhere."""


@dataclass(eq=False)
class Job:
    """One piece of work and what became of it."""

    name: str
    work: Work
    order: dict[str, Any]
    cpus: float = 1
    needs: Sequence[Job] = ()
    state: str = "waiting"  # waiting, running, done, failed, left out
    tries: int = 0
    fault: str = ""
    done: int = 0  # frames
    total: int = 0
    seconds: float = 0
    report: dict[str, Any] = field(default_factory=dict)

    @property
    def over(self) -> bool:
        return self.state in ("done", "failed", "left out")


class Audience(Protocol):
    """Is told when something about a job has changed."""

    def changed(self, job: Job) -> None: ...
    def refresh(self) -> None: ...


@dataclass
class Outcome:
    """How work ended: with a report, with a fault, or so that it should be tried again."""

    report: dict[str, Any] | None = None
    fault: str = ""
    lost: bool = False
    seconds: float = 0


class Board:
    """Where workers say how far they are. An actor beside the driver."""

    def __init__(self) -> None:
        self.entries: dict[str, tuple[int, int]] = {}

    def tell(self, name: str, done: int, total: int) -> None:
        self.entries[name] = (done, total)

    def forget(self, name: str) -> None:
        self.entries.pop(name, None)

    def read(self) -> dict[str, tuple[int, int]]:
        return self.entries


def attempt(work: Work, order: dict[str, Any], name: str, board: Any) -> Outcome:
    """Runs on a worker."""
    board.tell.remote(name, 0, 0)
    begun = time.monotonic()
    try:
        report = work(order, lambda done, total: board.tell.remote(name, done, total))
        return Outcome(report, seconds=time.monotonic() - begun)
    except Error as fault:
        return Outcome(fault=str(fault))
    except OSError as fault:
        return Outcome(fault=line_of(fault))
    except Crash as fault:
        return Outcome(fault=str(fault), lost=True)


@contextmanager
def cluster(address: str = "") -> Iterator[None]:
    """Connects to the cluster at an address ("auto": the one on this machine), or starts one of this machine's cores.

    One that is connected already is used and left as it is. Raises Error when there is none at the address.
    """
    if ray.is_initialized():
        yield
        return
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    os.environ.setdefault("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")
    try:
        if address:
            ray.init(address=address, log_to_driver=False, logging_level=logging.ERROR)
        else:
            # "local": a cluster that runs here, or that RAY_ADDRESS names, is somebody's, and must not be joined unasked.
            ray.init(address="local", object_store_memory=STORE_BYTES, include_dashboard=False, log_to_driver=False, logging_level=logging.ERROR)
    except (OSError, RuntimeError, ValueError) as fault:
        reason = (str(fault).strip().splitlines() or ["no answer"])[0]
        raise Error(f"no Ray cluster answers at '{address or 'local'}' ({reason}); start one with `ray start --head` and give its address") from None
    try:
        yield
    finally:
        ray.shutdown()


def run_jobs(jobs: Sequence[Job], *, audience: Audience, retries: int = 3) -> None:
    """Runs jobs until all are over; what came of each stands in it.

    A job whose worker or machine is lost runs again, at most `retries` times. One job's fault stops no other but
    those that need it. Raises Error when no machine could ever run a job.
    """
    _require_room(max((job.cpus for job in jobs), default=0))
    board = ray.remote(Board).options(num_cpus=0, scheduling_strategy=_here()).remote()
    running: dict[Any, Job] = {}
    while not all(job.over for job in jobs):
        for job in jobs:
            if job.state == "waiting" and job.tries == 0 and _ready(job, audience):
                _submit(job, board, running)
        ended, _ = ray.wait(list(running), timeout=WAIT_S) if running else ([], [])
        for task in ended:
            job = running.pop(task)
            if _settle(job, _outcome(task), retries):
                _submit(job, board, running)
            audience.changed(job)
        _read_board(board, list(running.values()), audience)
        audience.refresh()


def _ready(job: Job, audience: Audience) -> bool:
    missing = [need for need in job.needs if need.state in ("failed", "left out")]
    if missing:
        job.state, job.fault = "left out", f"it needs {missing[0].name}"
        audience.changed(job)
    return all(need.state == "done" for need in job.needs)


def _submit(job: Job, board: Any, running: dict[Any, Job]) -> None:
    job.tries += 1
    board.forget.remote(job.name)  # what its last try told would show it running while it waits
    # Ray's own retries stay off: they would hide from the table that a worker was lost.
    task = ray.remote(attempt).options(num_cpus=job.cpus, max_retries=0, name=job.name)
    running[task.remote(job.work, job.order, job.name, board)] = job


def _outcome(task: Any) -> Outcome:
    try:
        outcome: Outcome = ray.get(task)
        return outcome
    except RayTaskError as fault:  # an exception that work should not raise: trying again would raise it again
        return Outcome(fault=(str(fault).strip().splitlines() or [repr(fault)])[-1])
    except RayError as fault:
        return Outcome(fault=f"its worker was lost ({type(fault).__name__})", lost=True)


def _settle(job: Job, outcome: Outcome, retries: int) -> bool:
    """Writes down how a try ended; whether there is to be another."""
    job.fault = outcome.fault
    if outcome.report is not None:
        job.state, job.report, job.seconds = "done", outcome.report, outcome.seconds
        job.done = job.total
    elif outcome.lost and job.tries <= retries:
        job.state = "waiting"
        return True
    else:
        job.state = "failed"
        if outcome.lost:
            job.fault += f" {job.tries} times; the same command goes on where it stopped"
    return False


def _read_board(board: Any, running: Sequence[Job], audience: Audience) -> None:
    try:
        entries = ray.get(board.read.remote(), timeout=WAIT_S)
    except (RayError, GetTimeoutError):
        return  # without it the jobs run all the same
    for job in running:
        if job.name not in entries:
            continue
        done, total = entries[job.name]
        begun = job.state == "waiting"
        job.state, job.done, job.total = "running", max(done, job.done), max(total, job.total)
        if begun:
            audience.changed(job)


def _here() -> NodeAffinitySchedulingStrategy:
    return NodeAffinitySchedulingStrategy(node_id=ray.get_runtime_context().get_node_id(), soft=True)


def _require_room(cpus: float) -> None:
    nodes: list[dict[str, Any]] = ray.nodes()
    most = max((node["Resources"].get("CPU", 0) for node in nodes if node["Alive"]), default=0)
    if most < cpus:
        raise Error(f"no machine of the cluster has {cpus:g} cores, the largest has {most:g}; give each job {max(most, 1):g} cpus or fewer")
