# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The command ovimap-ray: many scenes, or one large site, on a Ray cluster (docs/many-maps.md)."""

from __future__ import annotations

import argparse
import json
import pathlib
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .command_line import DONE, MENDABLE, run_command

if TYPE_CHECKING:
    from .cluster import Job


def main(arguments: list[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    words = sys.argv[1:] if arguments is None else arguments
    cut = words.index("--") if "--" in words else len(words)
    options = _parser().parse_args(words[:cut])
    options.run_options = words[cut + 1:]
    try:
        return run_command("ovimap-ray", options, extra="ray", packages=("ray", "rich"))
    except KeyboardInterrupt:
        print("ovimap-ray: stopped; the same command goes on where it stopped", file=sys.stderr)
        return MENDABLE


def _map(options: argparse.Namespace) -> int:
    from .cluster import scene_jobs

    jobs = scene_jobs(options.scenes, pathlib.Path(options.output), frames=options.frames, **_run_choices(options))
    _run(jobs, options)
    return _end(jobs, options, {"folder": options.output})


def _site(options: argparse.Namespace) -> int:
    from .cluster import site_jobs

    jobs = site_jobs(options.source, pathlib.Path(options.output), parts=options.parts, overlap=options.overlap, **_run_choices(options))
    _run(jobs, options)
    return _end(jobs, options, {"map": options.output})


def _eval(options: argparse.Namespace) -> int:
    from .cluster import eval_jobs, pool_job

    jobs = eval_jobs(options.maps, options.gt, classes=options.classes, encoder=options.encoder, cpus=options.cpus)
    _run(jobs, options)
    pool = pool_job(jobs)
    _run([pool], options)
    if not options.json:
        _print_scores(pool.report)
    return _end([*jobs, pool], options, pool.report)


def _run_choices(options: argparse.Namespace) -> dict[str, Any]:
    return {"options": options.run_options, "cpus": options.cpus, "program": options.program}


def _run(jobs: Sequence[Job], options: argparse.Namespace) -> None:
    from .cluster import cluster, run_jobs
    from .cluster.table import audience_of

    with cluster(options.address), audience_of(jobs) as audience:
        run_jobs(jobs, audience=audience, retries=options.retries)


def _end(jobs: Sequence[Job], options: argparse.Namespace, figures: dict[str, Any]) -> int:
    """Prints what came of it; the exit code says whether all did."""
    failed = [job for job in jobs if job.state != "done"]
    if options.json:
        rows = [{"name": job.name, "state": job.state, "tries": job.tries, "fault": job.fault, "seconds": job.seconds, "report": job.report}
                for job in jobs]
        print(json.dumps(figures | {"done": len(jobs) - len(failed), "failed": len(failed), "jobs": rows}))
    if failed:
        print(f"ovimap-ray: {len(failed)} of {len(jobs)} jobs failed, the first: {failed[0].name}: {failed[0].fault}", file=sys.stderr)
    return MENDABLE if failed else DONE


def _print_scores(figures: dict[str, Any]) -> None:
    rows = [*figures.get("scenes", {}).items(), ("pooled", {"standard": figures.get("standard", {}).get("class_agnostic", {})})]
    print(f"{'':40} {'mIoU':>6} {'AP':>6} {'AP50':>6} {'AP25':>6}")
    for name, scores in rows:
        agnostic = scores.get("standard", {})
        print(f"{name[-40:]:40} " + " ".join(f"{agnostic.get(key, float('nan')):6.3f}" for key in ("miou", "ap", "ap50", "ap25")))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="ovimap-ray", description="maps many scenes, or one large site, on a Ray cluster",
        epilog="what follows -- goes to `ovimap run`, as in: ovimap-ray map rooms/* -o maps -- --masks sam")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    scenes = commands.add_parser("map", help="map many recordings, a map each")
    scenes.add_argument("scenes", nargs="+", metavar="SCENE", help="recordings, by paths that every machine has")
    scenes.add_argument("-o", "--output", required=True, metavar="FOLDER", help="folder of the maps, which every machine has")
    scenes.add_argument("--frames", default=":", help="which frames of each: FIRST:LAST:STEP, each part optional")
    scenes.set_defaults(command=_map)

    site = commands.add_parser("site", help="map one large recording in parts and merge them")
    site.add_argument("source", metavar="SOURCE", help="recording, by a path that every machine has")
    site.add_argument("-o", "--output", required=True, metavar="MAP", help="map to write; the parts' maps go beside it")
    site.add_argument("--parts", type=int, required=True, help="how many")
    site.add_argument("--overlap", type=int, default=20, help="frames that neighbouring parts share (20)")
    site.set_defaults(command=_site)

    scores = commands.add_parser("eval", help="score maps against the truth, each and pooled")
    scores.add_argument("maps", nargs="+", metavar="MAP", help="map files")
    scores.add_argument("--gt", nargs="+", default=[], metavar="SCENE", help="one for each map; default: what each was made from")
    scores.add_argument("--classes", default="auto", help="as of `ovimap eval`")
    scores.add_argument("--encoder", default="auto", help="as of `ovimap eval`")
    scores.set_defaults(command=_eval)

    for command in (scenes, site, scores):
        command.add_argument("--address", default="", help="of a Ray cluster, or auto; default: this machine's cores")
        command.add_argument("--cpus", type=int, default=1, help="cores for each job (1)")
        command.add_argument("--retries", type=int, default=3, help="how often a job is tried again whose worker was lost (3)")
        command.add_argument("--json", action="store_true", help="print one JSON object")
    for command in (scenes, site):
        command.add_argument("--program", default="", help="the program ovimap; default: $OVIMAP_PROGRAM, or what is on the PATH")
    return parser


if __name__ == "__main__":
    sys.exit(main())
