# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The network of the entity finder and its ONNX form."""

import torch
from torch import nn
from torch.nn import functional

from onnx_graph import Graph

EMBEDDED, CHANNELS, CELL_CHANNELS, BASIS = 256, 128, 64, 32
DILATIONS = [1, 2, 4, 8, 1, 2]
PLACE = 5  # of a kernel: terms of where a pixel lies seen from the cell: 1, x, y, x squared, y squared
PLACE_UNIT = 32.0  # pixels of the grid of masks
FINE = 2  # pixels of that grid along a cell
SEEN, SHARP = 4, [16, 32, 64]  # maps of depth (finder_data.geometry), and what is made of them at the grid, cells, the embedding


def conv(inputs, outputs, size=3, dilation=1):
    """A convolution that leaves the size as it is, its outputs of variance one in training; export folds that into the weights."""
    return nn.Sequential(nn.Conv2d(inputs, outputs, size, padding=size // 2 * dilation, dilation=dilation, bias=False), nn.BatchNorm2d(outputs))


def conv_halving(inputs, outputs):
    """Four by four, so that a pixel of the output lies in the middle of what it sees."""
    return nn.Sequential(nn.Conv2d(inputs, outputs, 4, 2, 1, bias=False), nn.BatchNorm2d(outputs))


class Finder(nn.Module):
    """Convolutions over the embedding and over the depth seen with it; at twice its resolution what each cell's thing is (one-stage detection, FCOS: Tian et al.
    2019); and the masks of things as sums of a few images over the whole view, weighed as each cell says (YOLACT: Bolya et al. 2019)."""

    def __init__(self):
        super().__init__()
        half = CHANNELS // 2
        self.seen = conv(SEEN, SHARP[0])
        self.halved = nn.ModuleList([conv_halving(SHARP[0], SHARP[1]), conv_halving(SHARP[1], SHARP[2])])
        self.widened = nn.ModuleList([conv(SHARP[1], SHARP[1]), conv(SHARP[2], SHARP[2])])
        self.stem = conv(EMBEDDED + SHARP[2], CHANNELS, 1)
        self.blocks = nn.ModuleList(conv(CHANNELS, CHANNELS, 3, dilation) for dilation in DILATIONS)
        self.up = nn.ConvTranspose2d(CHANNELS, half, 2, 2)
        self.skip = nn.ConvTranspose2d(EMBEDDED, half // 2, 2, 2)
        self.join = conv(half + half // 2 + SHARP[1], half)
        self.cells = conv(half, half)
        self.things = nn.Conv2d(half, 6, 1)
        nn.init.zeros_(self.things.bias)
        self.things.bias.data[1:5] = 2.5  # things are some twelve cells across
        self.asked = conv(half, half)
        self.kernels = nn.Conv2d(half, BASIS + PLACE + 1, 1)
        self.fine = nn.ConvTranspose2d(half, half // 2, 2, 2)
        self.sharp = conv(half // 2 + SHARP[0], half // 2)
        self.basis = nn.ModuleList([conv(half // 2, half // 2), conv(half // 2, half // 2)])
        self.last = nn.Conv2d(half // 2, BASIS, 1)

    def forward(self, x, shown):
        """`shown`: the maps of depth, with four times the rows and columns of the embedding `x`."""
        fine = functional.relu(self.seen(shown))
        levels = [fine]
        for halved, widened in zip(self.halved, self.widened):
            level = functional.relu(halved(levels[-1]))
            levels.append(level + functional.relu(widened(level)))
        y = functional.relu(self.stem(torch.cat([x, levels[2]], 1)))
        for block in self.blocks:
            y = y + functional.relu(block(y))
        y = functional.relu(self.join(torch.cat([functional.relu(self.up(y)), functional.relu(self.skip(x)), levels[1]], 1)))
        z = y + functional.relu(self.cells(y))
        kernels = self.kernels(y + functional.relu(self.asked(y)))
        b = functional.relu(self.fine(y))
        b = functional.relu(self.sharp(torch.cat([b, fine], 1)))
        for layer in self.basis:
            b = b + functional.relu(layer(b))
        return self.things(z), kernels, self.last(b)

    @staticmethod
    def masks(kernels, basis, cells):
        """Logits, masks x rows x columns, that the cells (image, row, column) answer with."""
        kernel = kernels[cells[:, 0], :, cells[:, 1], cells[:, 2]]
        logits = torch.einsum("nk,nkhw->nhw", kernel[:, :BASIS], basis[cells[:, 0]])
        rows, columns = basis.shape[2:]
        middle = (cells[:, 1:].float() + 0.5) * FINE - 0.5
        y = (torch.arange(rows, device=basis.device) - middle[:, :1]) / PLACE_UNIT
        x = (torch.arange(columns, device=basis.device) - middle[:, 1:]) / PLACE_UNIT
        one, ax, ay, axx, ayy = (kernel[:, BASIS + term, None] for term in range(PLACE))
        return logits + (one + ay * y + ayy * y * y)[:, :, None] + (ax * x + axx * x * x)[:, None, :]


def exported(net: Finder) -> bytes:
    """As ONNX, weights in 16 bits."""
    graph = Graph("finder")

    def convolved(tensor, layer, output=None):
        convolution, norm = (layer[0], layer[1]) if isinstance(layer, nn.Sequential) else (layer, None)
        weight = convolution.weight.detach()
        bias = convolution.bias.detach() if convolution.bias is not None else torch.zeros(weight.shape[0])
        if norm:
            scale = norm.weight.detach() / (norm.running_var + norm.eps).sqrt()
            weight, bias = weight * scale.view(-1, 1, 1, 1), norm.bias.detach() - norm.running_mean * scale
        return graph.add("Conv", tensor, graph.half_constant(weight.numpy()), graph.constant(bias.numpy()), output=output,
                         kernel_shape=list(weight.shape[2:]), dilations=list(convolution.dilation), strides=list(convolution.stride), pads=list(convolution.padding) * 2)  # fmt: skip

    def doubled(tensor, layer):
        return graph.add("Relu", graph.add("ConvTranspose", tensor, graph.half_constant(layer.weight.detach().numpy()),
                                           graph.constant(layer.bias.detach().numpy()), kernel_shape=[2, 2], strides=[2, 2]))  # fmt: skip

    def further(tensor, layer):
        return graph.add("Add", tensor, graph.add("Relu", convolved(tensor, layer)))

    x = graph.add_input("embedding", [1, EMBEDDED, "rows", "columns"])
    shown = graph.add_input("geometry", [1, SEEN, "grid_rows", "grid_columns"])
    levels = [graph.add("Relu", convolved(shown, net.seen))]
    for halved, widened in zip(net.halved, net.widened):
        levels.append(further(graph.add("Relu", convolved(levels[-1], halved)), widened))
    y = graph.add("Relu", convolved(graph.add("Concat", x, levels[2], axis=1), net.stem))
    for block in net.blocks:
        y = further(y, block)
    y = graph.add("Relu", convolved(graph.add("Concat", doubled(y, net.up), doubled(x, net.skip), levels[1], axis=1), net.join))
    convolved(further(y, net.cells), net.things, output="things")
    graph.add_output("things", [1, 6, "cell_rows", "cell_columns"])
    convolved(further(y, net.asked), net.kernels, output="kernels")
    graph.add_output("kernels", [1, BASIS + PLACE + 1, "cell_rows", "cell_columns"])
    basis = graph.add("Relu", convolved(graph.add("Concat", doubled(y, net.fine), levels[0], axis=1), net.sharp))
    for layer in net.basis:
        basis = further(basis, layer)
    convolved(basis, net.last, output="basis")
    graph.add_output("basis", [1, BASIS, "grid_rows", "grid_columns"])
    return graph.serialised()
