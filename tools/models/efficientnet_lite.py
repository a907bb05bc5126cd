# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""EfficientNet-Lite2 (Tan and Le 2019, the Lite variant: ReLU6, no squeeze-and-excitation) as an
ONNX graph. Batch normalisation is folded into the convolutions before it."""

import numpy as np

SIZE_PX = 260
FEATURES = 1280
BATCH_NORM_EPSILON = 1e-3
STEM_CHANNELS = 32
# repeats, kernel, stride of the first, expansion of the channels
STAGES = [
    (1, 3, 1, 1),
    (3, 3, 2, 6),
    (3, 5, 2, 6),
    (4, 3, 2, 6),
    (4, 5, 1, 6),
    (5, 5, 2, 6),
    (1, 3, 1, 6),
]


class _Network:
    def __init__(self, graph, weights):
        self.graph, self.weights = graph, weights
        self.zero, self.six = graph.constant(0), graph.constant(6)

    def convolution(self, tensor, size_px, conv, norm, stride=1, depthwise=False, relu=True):
        """The output's name and its side in pixels."""
        kernel = self.weights[conv + ".weight"].astype(np.float64)
        scale, bias, mean, variance = (
            self.weights[f"{norm}.{part}"].astype(np.float64)
            for part in ("weight", "bias", "running_mean", "running_var")
        )
        scale = scale / np.sqrt(variance + BATCH_NORM_EPSILON)
        out_px = -(-size_px // stride)
        # TensorFlow's "SAME": what is odd goes to the right and bottom.
        pad = max((out_px - 1) * stride + kernel.shape[2] - size_px, 0)
        result = self.graph.add(
            "Conv",
            tensor,
            self.graph.constant(kernel * scale[:, None, None, None]),
            self.graph.constant(bias - mean * scale),
            strides=[stride, stride],
            kernel_shape=list(kernel.shape[2:]),
            pads=[pad // 2, pad // 2, pad - pad // 2, pad - pad // 2],
            group=kernel.shape[0] if depthwise else 1,
        )
        if relu:
            result = self.graph.add("Clip", result, self.zero, self.six)
        return result, out_px

    def block(self, tensor, size_px, name, stride, expands):
        """An inverted residual block."""
        result, out_px = tensor, size_px
        if expands:
            result, _ = self.convolution(result, size_px, f"{name}._expand_conv", f"{name}._bn0")
        result, out_px = self.convolution(
            result, size_px, f"{name}._depthwise_conv", f"{name}._bn1", stride, depthwise=True
        )
        result, _ = self.convolution(
            result, out_px, f"{name}._project_conv", f"{name}._bn2", relu=False
        )
        return result, out_px


def add_features(graph, weights, image):
    """[N, 1280] pooled features of `image` [N, 3, 260, 260], pixels as (value - 127) / 128."""
    network = _Network(graph, weights)
    tensor, size_px = network.convolution(image, SIZE_PX, "_conv_stem", "_bn0", stride=2)
    index = 0
    for repeats, _, first_stride, expansion in STAGES:
        for repeat in range(repeats):
            stride = first_stride if repeat == 0 else 1
            result, size_px = network.block(
                tensor, size_px, f"_blocks.{index}", stride, expansion > 1
            )
            # A block adds to its input wherever the shapes agree: all but a stage's first.
            tensor = graph.add("Add", result, tensor) if repeat > 0 else result
            index += 1
    tensor, _ = network.convolution(tensor, size_px, "_conv_head", "_bn1")
    return graph.add("Flatten", graph.add("GlobalAveragePool", tensor))


def add_logits(graph, weights, features):
    """[N, 1000] logits of ImageNet's classes."""
    return graph.add(
        "Gemm",
        features,
        graph.constant(weights["_fc.weight"]),
        graph.constant(weights["_fc.bias"]),
        transB=1,
    )
