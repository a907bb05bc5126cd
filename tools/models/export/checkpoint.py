# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Finds out what a checkpoint is and exports it."""

import dataclasses
import pathlib
import re

from transformers import AutoConfig

from .dual_encoder import export_dual_encoder, refuse_naflex
from .errors import ExportError
from .folder import FolderWriter
from .mask2former import export_mask2former
from .sam import export_sam

EXPORTERS = {
    "siglip": export_dual_encoder,
    "clip": export_dual_encoder,
    "mask2former": export_mask2former,
    "sam": export_sam,
}
UNKNOWN_LICENSE = "unknown; see the checkpoint's model card"


def load_config(checkpoint: str):
    try:
        return AutoConfig.from_pretrained(checkpoint)
    except (OSError, ValueError) as error:
        first_line = str(error).strip().splitlines()[0]
        raise ExportError(
            f"{checkpoint} is neither a folder with config.json nor a reachable checkpoint "
            f"({first_line})"
        ) from error


def card_license(checkpoint: str) -> str:
    """The `license:` line of a local checkpoint's README.md, or of the hub's copy of it."""
    card = pathlib.Path(checkpoint) / "README.md"
    if not pathlib.Path(checkpoint).is_dir():
        from huggingface_hub import hf_hub_download

        try:
            card = pathlib.Path(hf_hub_download(checkpoint, "README.md"))
        except Exception:  # no card, no network: the licence is then unknown
            return UNKNOWN_LICENSE
    if not card.is_file():
        return UNKNOWN_LICENSE
    found = re.search(r"^license:\s*(\S+)", card.read_text(encoding="utf-8"), re.MULTILINE)
    return found.group(1) if found else UNKNOWN_LICENSE


def hub_name(checkpoint: str) -> str:
    return "a local folder" if pathlib.Path(checkpoint).is_dir() else checkpoint


@dataclasses.dataclass
class Options:
    """What the user may say besides; None: as the checkpoint has it."""

    name: str | None = None
    license: str | None = None
    source: str | None = None  # of the weights; default: the name on the hub
    input_px: int | None = None  # side of the network's input, where it is free to choose


def run_exporter(checkpoint: str, writer, options: Options) -> dict:
    config = load_config(checkpoint)
    refuse_naflex(config)
    exporter = EXPORTERS.get(config.model_type)
    if exporter is None:
        raise ExportError(
            f"{checkpoint} is of type '{config.model_type}'; accepted are siglip (also SigLIP 2), "
            "clip, mask2former and sam"
        )
    if exporter is export_mask2former:
        return exporter(checkpoint, config, writer, options.input_px)
    if options.input_px:
        raise ExportError(
            f"--input-px is for mask2former; a {config.model_type} has a size of its own"
        )
    return exporter(checkpoint, config, writer)


def export_checkpoint(checkpoint: str, folder, options: Options | None = None) -> dict:
    """Writes `folder` and gives model.yaml's keys. Throws ExportError."""
    options = options or Options()
    writer = FolderWriter(pathlib.Path(folder))
    try:
        description = run_exporter(checkpoint, writer, options)
        head = {
            "kind": description.pop("kind"),
            "name": options.name or pathlib.PurePath(checkpoint).name,
            "license": options.license or card_license(checkpoint),
            "source": options.source or hub_name(checkpoint),
        }
        writer.finish(head | description)
        return head | description
    except OSError as error:  # what transformers throws for a file that is missing or broken
        writer.discard()
        raise ExportError(f"{checkpoint}: {str(error).strip().splitlines()[0]}") from error
    except BaseException:
        writer.discard()
        raise
