#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Turns a Hugging Face checkpoint into an ovimap model folder.

CHECKPOINT is a name on the hub or a local folder; what it is, its config.json says:
SigLIP, SigLIP 2 (fixed resolution) and CLIP become encoders (kind dual_encoder), Mask2Former a
mask network (kind entity), SAM a promptable one (kind sam). Before it claims success the tool
runs the written networks with ONNX Runtime and compares them with torch.
"""

import argparse
import os
import pathlib
import sys

REQUIREMENTS = pathlib.Path(__file__).with_name("requirements-export.txt")


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("checkpoint", help="name on the hub, or folder with config.json")
    parser.add_argument("folder", type=pathlib.Path, help="model folder to write; must be new")
    parser.add_argument("--name", help="name of the model; default: the checkpoint's")
    parser.add_argument(
        "--license", help="licence of the weights, for model.yaml; default: what the card says"
    )
    parser.add_argument(
        "--input-px", type=int, help="Mask2Former only: side of the square input, a multiple of 32"
    )
    return parser.parse_args(arguments)


def main(arguments=None) -> int:
    args = parse_arguments(arguments)
    os.environ.setdefault("TRANSFORMERS_VERBOSITY", "error")
    try:
        from export.checkpoint import Options, export_checkpoint
        from export.errors import ExportError
    except ModuleNotFoundError as missing:
        print(
            f"export_model: the Python package {missing.name} is missing; "
            f"run: pip install -r {REQUIREMENTS}",
            file=sys.stderr,
        )
        return 1
    try:
        options = Options(name=args.name, license=args.license, input_px=args.input_px)
        description = export_checkpoint(args.checkpoint, args.folder, options)
    except ExportError as error:
        print(f"export_model: {error}", file=sys.stderr)
        return 1
    print(f"wrote {args.folder}: {description['name']}, kind {description['kind']}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
