# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The command ovimap-index: the objects of many maps as tables, and one search over all of them (docs/many-maps.md)."""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING, Any

from .command_line import DONE, MENDABLE, NO, run_command

if TYPE_CHECKING:
    from .index import Answer, MapAnswer
    from .index.search import Hit


def main(arguments: list[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    return run_command("ovimap-index", _parser().parse_args(arguments), extra="index", packages=("faiss", "pyarrow"))


def _build(options: argparse.Namespace) -> int:
    from .index import ObjectIndex

    update = ObjectIndex.build(options.output, options.maps)
    said = {"index": options.output, "added": update.added, "replaced": update.replaced, "kept": update.kept, "refused": update.refused}
    text = f"{options.output}: {len(update.added)} maps added, {len(update.replaced)} replaced, {len(update.kept)} as they were"
    print(json.dumps(said) if options.json else text)
    for fault in update.refused.values():
        print(f"ovimap-index: left out: {fault}", file=sys.stderr)
    return MENDABLE if update.refused else DONE


def _remove(options: argparse.Namespace) -> int:
    from .index import ObjectIndex

    ObjectIndex.remove(options.index, options.maps)
    print(json.dumps({"index": options.index, "removed": options.maps}) if options.json else f"{len(options.maps)} maps removed")
    return DONE


def _list(options: argparse.Namespace) -> int:
    from .index import ObjectIndex

    maps = ObjectIndex(options.index).maps
    if options.json:
        rows = [{"map": entry.path, "objects": entry.objects, "content_hash": entry.content_hash, "table": entry.file} for entry in maps]
        print(json.dumps({"index": options.index, "maps": rows}))
    else:
        for entry in maps:
            print(f"{entry.path}: {entry.objects} objects")
    return DONE


def _query(options: argparse.Namespace) -> int:
    from .index import ObjectIndex

    index = ObjectIndex(options.index, encoder=options.encoder, model_dirs=options.model_dir)
    if options.nearest:
        return _nearest(index.nearest_to_text(options.text, options.top), options)
    negatives = [term.strip() for text in options.negatives for term in text.split(",") if term.strip()]
    answer = index.query(options.text, top=options.top, negatives=negatives)
    if options.json:
        maps = [_map_json(said) for said in answer.maps]
        print(json.dumps({"query": answer.query, "verdict": answer.verdict, "p_value": answer.p_value, "maps": maps}))
    else:
        _print_answer(answer)
    return {"found": DONE, "not_in_map": NO, "unknown": MENDABLE}[answer.verdict]


def _nearest(hits: list[Hit], options: argparse.Namespace) -> int:
    if options.json:
        print(json.dumps({"query": options.text, "objects": [vars(hit) for hit in hits]}))
    else:
        for hit in hits:
            print(f"{hit.cosine:6.3f}  object {hit.object} of {hit.map}")
    return DONE if hits else NO


def _print_answer(answer: Answer) -> None:
    if answer.verdict == "unknown":
        print(f'"{answer.query}" was not found, but not all maps could be asked: bring these back and run `ovimap-index build`, '
              "or take them out with `ovimap-index remove`")
    elif not answer.found:
        print(f'"{answer.query}" is in none of the maps; what comes nearest:')
    for said in answer.maps:
        best = said.best
        if best is None:
            print(f"{said.map}: not asked: {said.notice}")
            continue
        likely = "" if best.probability is None else f", probability {best.probability:.2f}"
        print(f"{said.map}: object {best.id}{likely}{'' if said.found else ' (not in this map)'}{_and(best.evidence)}{_and(said.notice)}")


def _map_json(said: MapAnswer) -> dict[str, Any]:
    matches = said.answer.matches if said.answer is not None else []
    objects = [{"id": match.id, "score": match.score, "standard_score": match.standard_score, "p_value": match.p_value,
                "probability": match.probability, "evidence": match.evidence} for match in matches]
    verdict = None if said.answer is None else "found" if said.found else "not_in_map"
    return {"map": said.map, "verdict": verdict, "objects": objects, "notice": said.notice, "nearest": [vars(hit) for hit in said.hits[:5]]}


def _export(options: argparse.Namespace) -> int:
    from .index import export_objects

    rows = export_objects(options.maps, options.output)
    print(json.dumps({"table": options.output, "objects": rows}) if options.json else f"{options.output}: {rows} objects of {len(options.maps)} maps")
    return DONE


def _and(text: str) -> str:
    return f"; {text}" if text else ""


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="ovimap-index", description="searches the objects of many maps together")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    build = commands.add_parser("build", help="make an index, add maps to it, or bring it up to date with maps that changed")
    build.add_argument("maps", nargs="+", metavar="MAP", help="map files, all with embeddings of one encoder")
    build.add_argument("-o", "--output", required=True, metavar="INDEX", help="folder of the index")
    build.set_defaults(command=_build)

    remove = commands.add_parser("remove", help="take maps out of an index")
    remove.add_argument("index", metavar="INDEX")
    remove.add_argument("maps", nargs="+", metavar="MAP")
    remove.set_defaults(command=_remove)

    listing = commands.add_parser("list", help="the maps in an index")
    listing.add_argument("index", metavar="INDEX")
    listing.set_defaults(command=_list)

    query = commands.add_parser("query", help="which maps have it?")
    query.add_argument("index", metavar="INDEX")
    query.add_argument("text", metavar="TEXT", help='as of `ovimap query`: "fire extinguisher", "mug on the table"')
    query.add_argument("--top", type=int, default=5, help="maps shown (5)")
    query.add_argument("--not", dest="negatives", action="append", default=[], metavar="TEXT", help="what it must not be; commas separate")
    query.add_argument("--nearest", action="store_true", help="only list the nearest objects; asks no map, so gives no verdict")
    query.add_argument("--encoder", default="auto", help="default, a model, or auto: the default one if it made the embeddings")
    query.add_argument("--model-dir", action="append", default=[], help="folder to look for models in first")
    query.set_defaults(command=_query)

    export = commands.add_parser("export", help="write the objects of maps as one Parquet table")
    export.add_argument("maps", nargs="+", metavar="MAP", help="map files, all with embeddings of one encoder")
    export.add_argument("-o", "--output", required=True, metavar="FILE", help="Parquet file to write")
    export.set_defaults(command=_export)

    for command in (build, remove, listing, query, export):
        command.add_argument("--json", action="store_true", help="print one JSON object")
    return parser


if __name__ == "__main__":
    sys.exit(main())
