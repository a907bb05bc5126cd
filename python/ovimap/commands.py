# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What the program's commands of the same names do, as functions."""

from __future__ import annotations

import contextlib
import json
import os
import warnings
from collections.abc import Callable, Sequence
from typing import Any

from . import _ovimap
from ._ovimap import Error, FrameError, FrameIterator, Map, Mapper, make_mask_source, open_source

Path = str | os.PathLike[str]


def run(
    source: Path,
    map: Path,
    *,
    masks: Any = "none",
    encoder: Any = "auto",
    frames: str = ":",
    preset: str = "default",
    settings: dict[str, Any] | None = None,
    progress: Callable[[int, int], Any] | None = None,
) -> Map:
    """Maps a recording, saves the map and opens it.

    masks and encoder as Mapper takes them; "gt": the recording's own masks; encoder "auto": the default one where
    there are masks. frames: "FIRST:LAST:STEP", each part optional. Frames that cannot be used are left out, as the
    program does; the map's `skipped` counts them by reason, and a warning says when none had masks. progress(done, total) is
    called after each frame and may return False to end early: what was mapped is saved. It is too when Ctrl-C or what a
    callable raises ends the run, unless there was a map at that path; then that is raised. Raises Error when no frame is
    usable, and before the first frame where the map cannot be written.
    """
    _ovimap.check_map_target(map)
    there_before = os.path.exists(map)
    recording = open_source(source)
    if isinstance(masks, str):
        masks = make_mask_source(masks, recording)
    if isinstance(encoder, str) and encoder == "auto":
        encoder = "none" if masks is None else "default"
    mapper = Mapper(masks, encoder, preset=preset, settings=settings)
    made_from = f"{recording.kind}:{recording.path}"
    chosen = recording.frames(frames)
    try:
        refused = _process(mapper, chosen, progress)
        mapper.save(map, source=made_from)
    except BaseException:
        if mapper.frames > 0 and not there_before:
            _save_what_stands(mapper, map, made_from)
        raise
    made = Map.open(map)
    _ovimap.note_skipped(made, [*(fault for _, fault in chosen.skipped), *refused])
    if masks is not None and made.mask_frames == 0:
        warnings.warn(f"none of the {made.frames} frames had masks, so the map tells no objects apart", stacklevel=2)
    return made


def _process(mapper: Mapper, frames: FrameIterator, progress: Callable[[int, int], Any] | None) -> list[str]:
    """Returns why frames were left out that could be read."""
    refused: list[str] = []
    for done, frame in enumerate(frames, 1):
        try:
            mapper.process(frame)
        except FrameError as fault:
            if mapper.frames == 0:  # what is wrong with the first is wrong with all as a rule
                raise
            refused.append(str(fault))
        if progress is not None and progress(done, len(frames)) is False:
            break
    return refused


def _save_what_stands(mapper: Mapper, map: Path, made_from: str) -> None:
    for _ in range(2):  # what the encoder raised meanwhile comes out first
        with contextlib.suppress(Exception):
            mapper.save(map, source=made_from)
            return


def eval(
    maps: Path | Sequence[Path],
    truths: Path | Sequence[Path],
    *,
    classes: str = "auto",
    encoder: str = "auto",
    settings: dict[str, Any] | None = None,
    model_dirs: Sequence[Path] = (),
) -> dict[str, Any]:
    """Scores maps against the truth of their recordings: what `ovimap eval --json` prints, as a dict.

    One truth for each map, in order; several are pooled. Raises Error for a truth that does not belong to its map.
    """
    figures: dict[str, Any] = json.loads(_ovimap.eval_json(maps, truths, classes, encoder, settings, list(model_dirs)))
    return figures


def synth(out: Path, room: str = "tiny", *, frames: int = 0, seed: int = 1, noise: bool = False) -> str:
    """Renders a furnished room with exact truth into OUT/room and returns that path.

    frames: 0 = as the room says. noise: as a depth camera sees it. Raises Error for an unknown room (the message
    lists them) and where the package was built without the renderer.
    """
    render = getattr(_ovimap, "synth", None)
    if render is None:
        raise Error("this ovimap was built without rendered rooms; build it with -C cmake.define.OVIMAP_SYNTH=ON")
    path: str = render(out, room, frames=frames, seed=seed, noise=noise)
    return path
