#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Trains the judge that says which super-points are one thing and writes src/ovimap/instance/consensus/pair_judge_weights.h: renders rooms and desks
of the tuned halves of the benchmarks, of seeds that no benchmark and no other network uses, maps them with MobileSAM's masks, with
true ones and by depth alone, and learns from all pairs of clusters that a grouping meets (bench/quality/pair_samples.cpp).

    python3 tools/models/train_pair_judge.py build/release/bin WORK_FOLDER    # needs NumPy; an hour on two cores

With --beside, networks of earlier judges stay beside the new ones: judges that learned from maps made in different ways err differently
(docs/experiments.md). In every other round the sampler follows the judge that it was built with, so build again and train again to learn from one's mistakes.
A broken-off run goes on where it stopped.
"""

import argparse
import ast
import pathlib
import re
import subprocess

import numpy as np

HEADER = pathlib.Path(__file__).parents[2] / "src/ovimap/instance/consensus/pair_judge_weights.h"
INPUTS, HIDDEN, NETWORKS = 24, 24, 8  # PairFeature::kCount; several networks that differ in their chance err less together
STEPS, BATCH, RATE, DECAY = 5000, 1024, 3e-3, 1e-3
WALK, STILL = ["--fps", "1"], ["--noise", "--frames", "40"]
DESKS, ROOMS = ["writing-desk", "breakfast-table", "book-shelf"], ["living-room", "bedroom", "kitchen"]
# Kind, seed, options, every how many frames masks are asked for: often and seldom, since recordings differ in how far their frames are apart.
SCENES = [(kind, seed, WALK if kind in DESKS else STILL, (1, 2, 4)) for seed in (201, 202, 203) for kind in DESKS + ROOMS] + [("courtyard", 201, WALK, (3, 6))]
OTHER_MASKS = {(kind, 201) for kind in DESKS + ROOMS} | {("writing-desk", 202)}


def run(*command):
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)


def asked_for(programs, work, scene, name, interval):
    """A folder of the network's masks, which is asked once."""
    folder = work / "masks" / name
    if not (folder / "done").exists():
        run(programs / "ovimap", "masks", scene, "--frames", f"::{interval}", "-o", folder)
        (folder / "done").touch()
    return folder


def mapped(programs, work, scene, name, masks, interval):
    file = work / "maps" / f"{name}.ovimap"
    if not file.exists():
        run(programs / "ovimap", "run", scene, "--masks", masks, "--encoder", "none", "--set", f"mask_interval={interval}", "-o", file)
    return file


def samples(programs, work):
    """Features and verdicts of each map's pairs."""
    for folder in ("maps", "pairs"):
        (work / folder).mkdir(parents=True, exist_ok=True)
    for kind, seed, options, intervals in SCENES:
        rendered = work / "scenes" / f"{kind}-{seed}"
        if not (rendered / "done").exists():
            run(programs / "ovimap", "synth", rendered, "--room", kind, "--seed", seed, *options)
            (rendered / "done").touch()
        scene = next(path.parent for path in rendered.glob("*/results"))
        network = asked_for(programs, work, scene, f"{kind}-{seed}", intervals[0])
        others = [("gt", "gt", 2), ("none", "none", 2)] if (kind, seed) in OTHER_MASKS else []
        for source, masks, interval in [("sam", network, n) for n in intervals] + others:
            name = f"{kind}-{seed}-{source}-{interval}"
            file = work / "pairs" / name
            run(programs / "ovimap_pair_samples", mapped(programs, work, scene, name, masks, interval), scene, file)
            values = np.fromfile(file, np.float32).reshape(-1, INPUTS + 1)
            print(f"{name}: {len(values)} pairs, {100 * values[:, INPUTS].mean():.0f} % of one thing", flush=True)
            yield values[:, :INPUTS], values[:, INPUTS]


class Network:
    """Two hidden layers, trained by Adam on the cross entropy."""

    def __init__(self, chance):
        def weights(outputs, inputs, gain):
            return chance.normal(0, np.sqrt(gain / inputs), (outputs, inputs))

        self.parameters = [weights(HIDDEN, INPUTS, 2), np.zeros(HIDDEN), weights(HIDDEN, HIDDEN, 2), np.zeros(HIDDEN), weights(1, HIDDEN, 1)[0], np.zeros(1)]
        self.means, self.squares = ([np.zeros_like(p) for p in self.parameters] for _ in range(2))
        self.steps = 0

    def gradients(self, inputs, verdicts):
        first, first_bias, second, second_bias, last, last_bias = self.parameters
        a = np.maximum(inputs @ first.T + first_bias, 0)
        b = np.maximum(a @ second.T + second_bias, 0)
        error = (1 / (1 + np.exp(-(b @ last + last_bias[0]))) - verdicts) / len(verdicts)
        at_b = np.outer(error, last) * (b > 0)
        at_a = at_b @ second * (a > 0)
        return at_a.T @ inputs, at_a.sum(0), at_b.T @ a, at_b.sum(0), b.T @ error, np.array([error.sum()])

    def learn(self, inputs, verdicts, rate):
        self.steps += 1
        for p, mean, square, g in zip(self.parameters, self.means, self.squares, self.gradients(inputs, verdicts)):
            mean += 0.1 * (g - mean)
            square += 0.001 * (g * g - square)
            step = mean / (1 - 0.9**self.steps) / (np.sqrt(square / (1 - 0.999**self.steps)) + 1e-8)
            p -= rate * (step + (DECAY * p if p.ndim > 1 else 0))


def trained(scenes, mean, inverse_deviation, seed):
    """Every scene is heard as much as any other."""
    chance = np.random.default_rng(seed)
    network, share = Network(chance), BATCH // len(scenes) + 1
    for step in range(STEPS):
        chosen = [(inputs[i], verdicts[i]) for inputs, verdicts in scenes for i in [chance.integers(0, len(verdicts), share)]]
        inputs, verdicts = (np.concatenate(part) for part in zip(*chosen))
        network.learn((inputs - mean) * inverse_deviation, verdicts, RATE * 0.5 * (1 + np.cos(np.pi * step / STEPS)))
    return network


def literal(values):
    if values.ndim == 0:
        number = f"{values:.6g}"
        return number + ("f" if "." in number or "e" in number else ".f")
    return "{" + (", " if values.ndim == 1 else ",\n    ").join(literal(value) for value in values) + "}"


NAMES = ["kFirst[kNetworks][kInputs][kHidden]", "kFirstBias[kNetworks][kHidden]", "kSecond[kNetworks][kHidden][kHidden]",
         "kSecondBias[kNetworks][kHidden]", "kLast[kNetworks][kHidden]", "kLastBias[kNetworks]"]  # fmt: skip


def as_kept(network, mean, inverse_deviation):
    """Its arrays as the header has them: of features as they are, weights by input."""
    first, first_bias, second, second_bias, last, last_bias = network.parameters
    first = first * inverse_deviation
    return [first.T, first_bias - first @ mean, second.T, second_bias, last, last_bias[0]]


def networks_in(text):
    """The arrays of each network of a header."""
    found = [re.search(re.escape(name) + r" = (.*?);", text, re.DOTALL)[1] for name in NAMES]
    return list(zip(*(ast.literal_eval(values.translate(str.maketrans("{}", "[]", "f"))) for values in found)))


def header(networks):
    arrays = list(zip(NAMES, (np.array(array) for array in zip(*networks))))
    lines = ["// SPDX-FileCopyrightText: 2026 The ovimap authors", "// SPDX-License-Identifier: Apache-2.0",
             "// Written by tools/models/train_pair_judge.py.", "#pragma once", "", "#include <cstddef>", "",
             "namespace ovimap::pair_judge_weights {", "",
             f"inline constexpr std::size_t kNetworks = {len(networks)}, kHidden = {HIDDEN}, kInputs = {INPUTS};",
             *(f"inline constexpr float {name} = {literal(values)};" for name, values in arrays), "",
             "}  // namespace ovimap::pair_judge_weights", ""]  # fmt: skip
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, help="folder of ovimap and ovimap_pair_samples")
    parser.add_argument("work", type=pathlib.Path, help="folder for recordings, masks, maps and pairs, 3 GB")
    parser.add_argument("--out", type=pathlib.Path, default=HEADER)
    parser.add_argument("--beside", type=pathlib.Path, nargs="*", default=[], help="headers of earlier judges, whose networks stay beside the new ones")
    arguments = parser.parse_args()
    scenes = list(samples(arguments.programs.resolve(), arguments.work))
    inputs = np.concatenate([inputs for inputs, _ in scenes])
    mean, inverse_deviation = inputs.mean(0), 1 / (inputs.std(0) + 1e-6)
    earlier = [network for path in arguments.beside for network in networks_in(path.read_text())]
    networks = [as_kept(trained(scenes, mean, inverse_deviation, seed), mean, inverse_deviation) for seed in range(NETWORKS)]
    arguments.out.write_text(header(earlier + networks))


if __name__ == "__main__":
    main()
