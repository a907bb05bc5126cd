# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The image encoder of as many rows as a picture has answers what TinyViT says, written down plainly here, with random weights."""
import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tools" / "models"))
try:
    import numpy as np
    import row_encoder
    from plain_network import answers, attended, gelu, normalized
except ImportError as missing:  # the tools' packages are set up by tools/setup.sh
    print(f"skipped: {missing}; tools/setup.sh installs what the model tools need")
    sys.exit(77)

ROWS, COLUMNS = 96, 112  # windows of 7 and 14 places of 8 and 16 pixels reach over both borders
STEM, WIDE, NECK = 16, 32, 16
CHANNELS = [32, 64, 32]  # of the layers with windows


def convolutions():
    """Outputs, inputs of each group, side, stride and groups, in the network's order; the last two have no bias."""
    yield from [(8, 3, 3, 2, 1), (STEM, 8, 3, 2, 1)]
    yield from 2 * [(WIDE, STEM, 1, 1, 1), (WIDE, 1, 3, 1, WIDE), (STEM, WIDE, 1, 1, 1)]
    before = STEM
    for channels, (blocks, _), stride in zip(CHANNELS, row_encoder.LAYERS, (2, 2, 1)):
        yield from [(channels, before, 1, 1, 1), (channels, 1, 3, stride, channels), (channels, channels, 1, 1, 1)]
        yield from blocks * [(channels, 1, 3, 1, channels)]
        before = channels
    yield from [(NECK, before, 1, 1, 1), (NECK, NECK, 3, 1, 1)]


class RandomWeights:
    """Each made when it is first asked for; of one seed always the same."""

    def __init__(self):
        self._made, self._shapes = {}, list(convolutions())
        self._next = 0

    def make(self, name, *shape):
        if name not in self._made:
            random = np.random.default_rng(abs(sum(ord(c) * (i + 1) for i, c in enumerate(name))))
            self._made[name] = (random.normal(size=shape) / math.sqrt(shape[0])).astype(np.float32)
        return self._made[name]

    def next_convolution(self):
        number, (out, inner, side, stride, groups) = self._next, self._shapes[self._next]
        self._next += 1
        weights = [self.make(f"convolution {number}", out, inner, side, side)]
        if number < len(self._shapes) - 2:
            weights.append(self.make(f"convolution {number} bias", out))
        return weights, {"strides": [stride] * 2, "pads": [side // 2] * 4, "group": groups}

    @staticmethod
    def channels(layer):
        return CHANNELS[int(layer.split("layers.")[1][0]) - 1]

    def linear(self, layer):
        n = self.channels(layer)
        shape = {"qkv": (n, 3 * n), "proj": (n, n), "fc1": (n, 4 * n), "fc2": (4 * n, n)}[layer.rsplit("/", 1)[1]]
        return self.make(layer, *shape), self.make(f"{layer} bias", shape[1])

    def of_node(self, name):
        """What attention adds to its scores by where two places lie."""
        places = row_encoder.LAYERS[int(name.split("layers.")[1][0]) - 1][1] ** 2
        return self.make(name, self.channels(name) // row_encoder.HEAD, places, places)

    def norm(self, layer):
        return 1 + self.make(layer, self.channels(layer)), self.make(f"{layer} bias", self.channels(layer))

    def channel_norm(self, layer):
        return 1 + self.make(layer, NECK, 1, 1), self.make(f"{layer} bias", NECK, 1, 1)


class PlainEncoder:
    """Wu et al., ECCV 2022, figure 3, with MobileSAM's neck; all are [channels, rows, columns]."""

    def __init__(self, weights):
        self.w = weights

    def convolution(self, x):
        (weight, *bias), how = self.w.next_convolution()
        side, stride, groups = weight.shape[-1], how["strides"][0], how["group"]
        padded = np.pad(x, ((0, 0), (side // 2,) * 2, (side // 2,) * 2))
        rows, columns = x.shape[1] // stride, x.shape[2] // stride
        made = np.zeros((weight.shape[0], rows, columns), np.float32)
        for i in range(side):
            for j in range(side):
                seen = padded[:, i : i + stride * rows : stride, j : j + stride * columns : stride]
                each = weight[:, :, i, j]
                made += each[:, 0, None, None] * seen if groups > 1 else np.einsum("oc,cyx->oyx", each, seen)
        return made + bias[0][:, None, None] if bias else made

    def three(self, x):
        return self.convolution(gelu(self.convolution(gelu(self.convolution(x)))))

    @staticmethod
    def norm(x, weights, epsilon):
        scale, shift = (part.ravel() for part in weights)
        return normalized(x, epsilon) * scale + shift

    def apply(self, layer, x):
        weight, bias = self.w.linear(layer)
        return x @ weight + bias

    def attention(self, x, layer):
        """Of one window: [places, channels]."""
        asked = self.apply(f"{layer}/qkv", self.norm(x, self.w.norm(f"{layer.replace('/', '.')}.norm"), 1e-5))
        made = np.empty_like(x)
        for head in range(x.shape[1] // row_encoder.HEAD):
            q, k, v = np.split(asked[:, 3 * row_encoder.HEAD * head :][:, : 3 * row_encoder.HEAD], 3, axis=1)
            scores = q @ k.T / math.sqrt(row_encoder.HEAD) + self.w.of_node(f"/{layer}/Add")[head]
            made[:, row_encoder.HEAD * head :][:, : row_encoder.HEAD] = attended(scores, v)
        return self.apply(f"{layer}/proj", made)

    def windows(self, x, layer, side):
        channels, rows, columns = x.shape
        made = np.zeros_like(x)
        for top in range(0, rows, side):
            for left in range(0, columns, side):
                window = np.zeros((channels, side, side), np.float32)
                part = x[:, top : top + side, left : left + side]
                window[:, : part.shape[1], : part.shape[2]] = part
                seen = self.attention(window.reshape(channels, -1).T, layer).T.reshape(window.shape)
                made[:, top : top + side, left : left + side] = seen[:, : part.shape[1], : part.shape[2]]
        return made

    def block(self, x, layer, side):
        x = self.convolution(x + self.windows(x, f"{layer}/attn", side))
        places = x.reshape(len(x), -1).T
        normed = self.norm(places, self.w.norm(f"{layer.replace('/', '.')}.mlp.norm"), 1e-5)
        told = self.apply(f"{layer}/mlp/fc2", gelu(self.apply(f"{layer}/mlp/fc1", normed)))
        return (places + told).T.reshape(x.shape)

    def run(self, x):
        x = self.convolution(gelu(self.convolution(x)))
        for _ in range(2):
            x = gelu(x + self.three(x))
        for number, (blocks, side) in enumerate(row_encoder.LAYERS, start=1):
            x = self.three(x)
            for block in range(blocks):
                x = self.block(x, f"layers.{number}/blocks.{block}", side)
        for layer in ("neck/neck.1", "neck/neck.3"):
            x = self.convolution(x)
            x = np.moveaxis(self.norm(np.moveaxis(x, 0, -1), self.w.channel_norm(layer), 1e-6), -1, 0)
        return x


class RowEncoderTest(unittest.TestCase):
    def test_it_answers_what_the_plain_encoder_answers(self):
        image = np.random.default_rng(1).normal(size=(1, 3, ROWS, COLUMNS)).astype(np.float32)
        graph = row_encoder.Encoder(RandomWeights(), COLUMNS).run("image", "embedding")
        [embedding] = answers(graph, {"image": image}, ["embedding"])
        self.assertEqual(embedding.shape, (1, NECK, ROWS // row_encoder.STEP, COLUMNS // row_encoder.STEP))
        np.testing.assert_allclose(embedding[0], PlainEncoder(RandomWeights()).run(image[0]), atol=1e-3)


if __name__ == "__main__":
    unittest.main()
