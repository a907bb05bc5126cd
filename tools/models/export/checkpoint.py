# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Finds out what a checkpoint is and exports it."""

import pathlib
import re

from transformers import AutoConfig

from .dual_encoder import export_dual_encoder, refuse_naflex
from .errors import ExportError
from .folder import FolderWriter

EXPORTERS = {
    "siglip": export_dual_encoder,
    "clip": export_dual_encoder,
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


def export_checkpoint(checkpoint: str, folder, name=None, license_name="", source=None) -> dict:
    """Writes `folder` and gives model.yaml's keys. Throws ExportError. `source` is what model.yaml
    says of the weights' origin; default: the name on the hub."""
    config = load_config(checkpoint)
    refuse_naflex(config)
    exporter = EXPORTERS.get(config.model_type)
    if exporter is None:
        raise ExportError(
            f"{checkpoint} is of type '{config.model_type}'; accepted are siglip (also SigLIP 2), "
            "clip, mask2former and sam"
        )
    writer = FolderWriter(pathlib.Path(folder))
    try:
        description = exporter(checkpoint, config, writer)
        head = {
            "kind": description.pop("kind"),
            "name": name or pathlib.PurePath(checkpoint).name,
            "license": license_name or card_license(checkpoint),
            "source": source or hub_name(checkpoint),
        }
        writer.finish(head | description)
        return head | description
    except BaseException:
        writer.discard()
        raise
