#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Trains the entity finder of the default mask model and writes finder.onnx: from MobileSAM's embedding of an image, where its things
are (src/ovimap/inference/sam/entity_finder.h). Renders what it learns from, which no benchmark's unseen half shares anything with;
a broken-off run goes on where it stopped. Two cores need an hour and a half.

    pip install -r tools/models/requirements-finder.txt  # in an environment of its own
    python3 tools/models/train_finder.py build/release/bin/ovimap .models/mobilesam WORK_FOLDER

Then the digest that it prints goes into mobilesam.yaml.
"""

import argparse
import hashlib
import math
import pathlib

import numpy as np
import torch
from torch import nn
from torch.nn import functional

import finder_data
from onnx_graph import Graph

HERE = pathlib.Path(__file__).parent
CHANNELS, BATCH, RATE, WARM_UP, NOISE, DROPPED = 64, 6, 2e-3, 100, 0.02, 0.1
BOX_WEIGHT, SHARE_WEIGHT, BOX_BETA = 0.5, 0.3, 0.2
MIRRORED = [0, 3, 2, 1, 4, 5]  # left and right change places


class Finder(nn.Module):
    """Convolutions that see about 300 pixels of the network's input around a place, then twice the resolution."""

    def __init__(self):
        super().__init__()
        half = CHANNELS // 2
        self.a = nn.Conv2d(256, CHANNELS, 1)
        self.b = nn.Conv2d(CHANNELS, CHANNELS, 3, padding=1)
        self.c = nn.Conv2d(CHANNELS, CHANNELS, 3, padding=2, dilation=2)
        self.d = nn.Conv2d(CHANNELS, CHANNELS, 3, padding=4, dilation=4)
        self.up = nn.ConvTranspose2d(CHANNELS, half, 2, 2)
        self.skip = nn.ConvTranspose2d(256, half // 2, 2, 2)
        self.e = nn.Conv2d(half + half // 2, half, 3, padding=1)
        self.f = nn.Conv2d(half, half, 3, padding=1)
        self.o = nn.Conv2d(half, 6, 1)
        nn.init.zeros_(self.o.bias)
        self.o.bias.data[1:5] = 2.5  # things are some twelve cells across

    def forward(self, x):
        y = functional.relu(self.a(x))
        for layer in (self.b, self.c, self.d):
            y = y + functional.relu(layer(y))
        y = functional.relu(self.e(torch.cat([functional.relu(self.up(y)), functional.relu(self.skip(x))], 1)))
        return self.o(y + functional.relu(self.f(y)))


def exported(net) -> bytes:
    """As ONNX, weights in 16 bits."""
    weights = {name: tensor.numpy() for name, tensor in net.state_dict().items()}
    graph = Graph("finder")

    def convolved(tensor, layer, dilation=1, output=None):
        weight = weights[layer + ".weight"]
        return graph.add("Conv", tensor, graph.half_constant(weight), graph.constant(weights[layer + ".bias"]), output=output,
                         kernel_shape=list(weight.shape[2:]), dilations=[dilation] * 2, pads=[weight.shape[2] // 2 * dilation] * 4)  # fmt: skip

    def doubled(tensor, layer):
        return graph.add("Relu", graph.add("ConvTranspose", tensor, graph.half_constant(weights[layer + ".weight"]),
                                           graph.constant(weights[layer + ".bias"]), kernel_shape=[2, 2], strides=[2, 2]))  # fmt: skip

    x = graph.add_input("embedding", [1, 256, "rows", "columns"])
    y = graph.add("Relu", convolved(x, "a"))
    for layer, dilation in (("b", 1), ("c", 2), ("d", 4)):
        y = graph.add("Add", y, graph.add("Relu", convolved(y, layer, dilation)))
    y = graph.add("Concat", doubled(y, "up"), doubled(x, "skip"), axis=1)
    y = graph.add("Relu", convolved(y, "e"))
    y = graph.add("Add", y, graph.add("Relu", convolved(y, "f")))
    convolved(y, "o", output="things")
    graph.add_output("things", [1, 6, "cell_rows", "cell_columns"])
    return graph.serialised()


def losses(found, wanted, weight):
    """Of depth, boxes and filled shares; the last two where the middle of a thing is near."""
    depth = functional.binary_cross_entropy_with_logits(found[:, 0], wanted[:, 0], reduction="none")
    near = weight * wanted[:, 0] * (wanted[:, 5] > 0)
    box = functional.smooth_l1_loss(found[:, 1:5], wanted[:, 1:5], reduction="none", beta=BOX_BETA).sum(1)
    share = functional.binary_cross_entropy_with_logits(found[:, 5], wanted[:, 5], reduction="none")
    return (depth * weight).sum() / weight.sum(), (box * near).sum() / near.sum(), (share * near).sum() / near.sum()


def batch_of(samples, rng):
    """Random samples, half of them mirrored, side by side at the upper left of the largest one's size."""
    chosen = [samples[i] for i in rng.integers(0, len(samples), BATCH)]
    rows, columns = (max(sample.embedding.shape[axis] for sample in chosen) for axis in (1, 2))
    x = np.zeros((BATCH, 256, rows, columns), np.float32)
    wanted, weight = np.zeros((BATCH, 6, 2 * rows, 2 * columns), np.float32), np.zeros((BATCH, 2 * rows, 2 * columns), np.float32)
    for place, sample in enumerate(chosen):
        step = -1 if rng.random() < 0.5 else 1
        _, h, w = sample.embedding.shape
        x[place, :, :h, :w] = sample.embedding[:, :, ::step]
        wanted[place, :, : 2 * h, : 2 * w] = (sample.targets[MIRRORED] if step < 0 else sample.targets)[:, :, ::step]
        weight[place, : 2 * h, : 2 * w] = sample.weight[:, ::step]
    return torch.from_numpy(x), torch.from_numpy(wanted), torch.from_numpy(weight)


def rate_at(step, steps):
    return RATE * min(1, step / WARM_UP) * (0.5 * (1 + math.cos(math.pi * step / steps)) + 0.01)


def trained(samples, steps):
    torch.manual_seed(0)
    rng, net = np.random.default_rng(0), Finder()
    optimizer = torch.optim.AdamW(net.parameters(), lr=RATE, weight_decay=1e-3)
    sums = np.zeros(3)
    for step in range(1, steps + 1):
        optimizer.param_groups[0]["lr"] = rate_at(step, steps)
        x, wanted, weight = batch_of(samples, rng)
        x = x + NOISE * torch.randn_like(x)
        if rng.random() < 0.5:
            x = functional.dropout2d(x, DROPPED)
        depth, box, share = losses(net(x), wanted, weight)
        optimizer.zero_grad()
        (depth + BOX_WEIGHT * box + SHARE_WEIGHT * share).backward()
        nn.utils.clip_grad_norm_(net.parameters(), 1)
        optimizer.step()
        sums += depth.item(), box.item(), share.item()
        if step % 100 == 0:
            print(f"{step} of {steps}: depth {sums[0] / 100:.3f}, boxes {sums[1] / 100:.3f}, shares {sums[2] / 100:.3f}", flush=True)
            sums[:] = 0
    return net.eval()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("model", type=pathlib.Path, help="the folder of MobileSAM, for its encoder")
    parser.add_argument("work", type=pathlib.Path, help="folder for recordings and embeddings, 2 GB")
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--out", type=pathlib.Path, default=HERE / "finder.onnx")
    arguments = parser.parse_args()
    cache = arguments.work / "embedded"
    cache.mkdir(parents=True, exist_ok=True)
    encoder = finder_data.Encoder(arguments.model / "encoder.onnx")
    samples = [sample for scene in finder_data.rendered(arguments.program.resolve(), arguments.work / "scenes")
               for sample in finder_data.embedded(scene, encoder, cache)]  # fmt: skip
    print(f"{len(samples)} frames")
    data = exported(trained(samples, arguments.steps))
    arguments.out.write_bytes(data)
    print(f"finder.onnx: {hashlib.sha256(data).hexdigest()}")


if __name__ == "__main__":
    main()
