# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""MobileSAM's encoder for training on its features: many images at once, on a GPU where there is one."""

import numpy as np
import onnx
import onnx2torch
import torch
from onnx import numpy_helper

from finder_data import EMBEDDED_PX, INPUT_PX

MEAN = torch.tensor([123.675, 116.28, 103.53]).view(1, 3, 1, 1)
STD = torch.tensor([58.395, 57.12, 57.375]).view(1, 3, 1, 1)


class SamEncoder:
    """`at_once` images of a call: its shapes are fixed when it is made."""

    def __init__(self, file, device, at_once):
        self._device, self._at_once = device, at_once
        self._type = torch.float16 if device == "cuda" else torch.float32
        net = onnx2torch.convert(self._of_any_batch(onnx.load(file))).eval().requires_grad_(False).to(device)
        example = torch.zeros(at_once, 3, INPUT_PX, INPUT_PX, device=device)
        with torch.no_grad(), torch.autocast(device, torch.float16, enabled=device == "cuda"):
            self._net = torch.jit.trace(net, example, check_trace=False)

    @staticmethod
    def _of_any_batch(model):
        """Two of its shapes were written down for one image."""
        for node in model.graph.node:
            if node.op_type == "Constant":
                shape = numpy_helper.to_array(node.attribute[0].t)
                if shape.shape == (4,) and shape[0] == 1 and shape[3] == -1:
                    node.attribute[0].t.CopyFrom(numpy_helper.from_array(np.array([0, *shape[1:]], shape.dtype)))
        return model

    @torch.no_grad()
    def __call__(self, rgb):
        """Of uint8 images, count x height x width x 3, count x 256 x rows x columns of what they fill."""
        tensor = torch.zeros(self._at_once, 3, INPUT_PX, INPUT_PX, device=self._device)
        images = rgb.to(self._device).permute(0, 3, 1, 2).float()
        tensor[: len(rgb), :, : rgb.shape[1], : rgb.shape[2]] = (images - MEAN.to(self._device)) / STD.to(self._device)
        with torch.autocast(self._device, torch.float16, enabled=self._device == "cuda"):
            embedding = self._net(tensor)
        return embedding[: len(rgb), :, : -(-rgb.shape[1] // EMBEDDED_PX), : -(-rgb.shape[2] // EMBEDDED_PX)].to(self._type)
