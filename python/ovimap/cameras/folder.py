# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Writes frames as a folder that `ovimap run` reads: TUM's layout, with the camera's own times and calibration."""

from __future__ import annotations

import json
import pathlib
from typing import Any

import numpy as np
import numpy.typing as npt

from .._ovimap import Error, encode_png
from ..gyroscope import Quaternion, Rate


class FolderWriter:
    """In the place of a FrameSender. Images are kept as they are (PNG); of two frames of one time the second is left out."""

    def __init__(self, folder: pathlib.Path, rig: dict[str, Any]) -> None:
        if folder.exists() and any(folder.iterdir()):
            raise Error(f"'{folder}' is not empty; name a new folder")
        self.taken = self.skipped = 0
        self._folder, self._names = folder, set[str]()
        for kind in ("rgb", "depth"):
            (folder / kind).mkdir(parents=True, exist_ok=True)
        (folder / "camera.yaml").write_text("".join(f"{key}: {json.dumps(value)}\n" for key, value in rig.items()))  # JSON is YAML
        self._lists = {kind: (folder / f"{kind}.txt").open("w") for kind in ("rgb", "depth")}

    def send(self, color: npt.NDArray[np.uint8], depth: npt.NDArray[Any], pose: None, timestamp: float, *,
             orientation: Quaternion | None = None, patience_s: float = 0.0) -> bool:  # fmt: skip
        """As FrameSender's; what a gyroscope measures is kept as it is."""
        name = f"{timestamp:.6f}"
        if name in self._names:
            self.skipped += 1
            return False
        self._names.add(name)
        for kind, image in (("rgb", color), ("depth", depth)):
            (self._folder / kind / f"{name}.png").write_bytes(encode_png(image))
            self._lists[kind].write(f"{name} {kind}/{name}.png\n")
        self.taken += 1
        return True

    def keep_rate(self, time_s: float, rate: Rate) -> None:
        """A sample of the gyroscope, about the axes of the depth camera."""
        if "gyroscope" not in self._lists:
            self._lists["gyroscope"] = (self._folder / "gyroscope.txt").open("w")
        self._lists["gyroscope"].write(f"{time_s:.6f} " + " ".join(f"{value:.9g}" for value in rate) + "\n")

    def finish(self) -> None:
        self.close()

    def close(self) -> None:
        for file in self._lists.values():
            file.close()
