# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The mask decoder with few tokens answers what SAM's decoder says, written down plainly here, with random weights."""
import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tools" / "models"))
try:
    import few_token_decoder as few
    import numpy as np
    from plain_network import answers, attended, gelu, normalized
except ImportError as missing:  # the tools' packages are set up by tools/setup.sh
    print(f"skipped: {missing}; tools/setup.sh installs what the model tools need")
    sys.exit(77)

PROMPTS, TOKENS = 2, 6


class RandomWeights:
    """Each made when it is first asked for."""

    def __init__(self, seed):
        self._random, self._made = np.random.default_rng(seed), {}

    def make(self, name, *shape):
        if name not in self._made:
            self._made[name] = (self._random.normal(size=shape) / math.sqrt(max(shape[0], 1))).astype(np.float32)
        return self._made[name]

    def linear(self, layer):
        inner = 256 if "self_attn" in layer else 128
        shape = {"q": (256, inner), "k": (256, inner), "v": (256, inner), "o": (inner, 256)}
        shape |= {"lin1": (256, 2048), "lin2": (2048, 256)}
        last = layer.rsplit("/", 1)[1]
        size = shape[last] if last in shape else shape[last[0]]
        return self.make(layer, *size), self.make(f"{layer} bias", size[1])

    def norm(self, layer):
        return 1 + self.make(layer, 256), self.make(f"{layer} bias", 256)

    def __getitem__(self, name):
        shapes = {f"{few.DECODER}output_upscaling.0.weight": (256, 64, 2, 2), f"{few.DECODER}output_upscaling.0.bias": (64,),
                  f"{few.DECODER}output_upscaling.3.weight": (64, 32, 2, 2), f"{few.DECODER}output_upscaling.3.bias": (32,),
                  few.UPSCALED_NORM[0]: (64, 1, 1), few.UPSCALED_NORM[1]: (64, 1, 1), few.NO_MASK: (1, 256, 1, 1)}
        return self.make(name, *shapes[name])


class PlainDecoder:
    """Kirillov et al. 2023, section A, and the authors' figure 14; an image for each prompt, every product as it is drawn."""

    def __init__(self, weights):
        self.w = weights

    def apply(self, layer, x):
        weight, bias = self.w.linear(layer)
        return x @ weight + bias

    def norm(self, layer, x):
        weight, bias = self.w.norm(layer)
        return normalized(x, 1e-5) * weight + bias

    def attention(self, name, q, k, v):
        q, k, v = (self.apply(f"{name}/{part}_proj", x) for part, x in (("q", q), ("k", k), ("v", v)))
        made = np.empty_like(q)
        for head in np.split(np.arange(q.shape[-1]), few.HEADS):
            scores = q[..., head] @ k[..., head].swapaxes(1, 2) / math.sqrt(len(head))
            made[..., head] = attended(scores, v[..., head])
        return self.apply(f"{name}/out_proj", made)

    def transform(self, first, image, positions):
        tokens = first
        for number in range(2):
            name = f"transformer/layers.{number}"
            asking = tokens + first if number else tokens
            made = self.attention(f"{name}/self_attn", asking, asking, tokens)
            tokens = self.norm(f"{name}/norm1", tokens + made if number else made)
            made = self.attention(f"{name}/cross_attn_token_to_image", tokens + first, image + positions, image)
            tokens = self.norm(f"{name}/norm2", tokens + made)
            made = self.apply(f"{name}/mlp/lin2", np.maximum(self.apply(f"{name}/mlp/lin1", tokens), 0))
            tokens = self.norm(f"{name}/norm3", tokens + made)
            made = self.attention(f"{name}/cross_attn_image_to_token", image + positions, tokens + first, tokens)
            image = self.norm(f"{name}/norm4", image + made)
        made = self.attention("transformer/final_attn_token_to_image", tokens + first, image + positions, image)
        return self.norm("transformer/norm_final_attn", tokens + made), image

    def upscale(self, layer, x):
        """A transposed convolution of size and stride 2: [prompts, rows, columns, in]."""
        weight, bias = (self.w[f"{few.DECODER}output_upscaling.{layer}.{part}"] for part in ("weight", "bias"))
        made = np.empty((x.shape[0], 2 * x.shape[1], 2 * x.shape[2], len(bias)), np.float32)
        for row in range(2):
            for column in range(2):
                made[:, row::2, column::2] = x @ weight[:, :, row, column] + bias
        return made

    def masks(self, image, mask_weights):
        x = self.upscale(0, image.reshape(len(image), -1, few.SIDE, few.CHANNELS))
        scale, shift = (self.w[name].ravel() for name in few.UPSCALED_NORM)
        x = gelu(self.upscale(3, gelu(normalized(x, 1e-6) * scale + shift)))
        return np.einsum("nyxc,nmc->nmyx", x, mask_weights)


class FewTokenDecoderTest(unittest.TestCase):
    def test_it_answers_what_the_plain_decoder_answers(self):
        self.compare(few.SIDE)

    def test_of_fewer_rows_it_answers_the_same_and_goes_on_below(self):
        self.compare(5)

    def compare(self, rows):
        weights, random = RandomWeights(1), np.random.default_rng(2)
        shapes = {few.TOKENS: (PROMPTS, TOKENS, 256), few.POSITIONS: (1, 256, few.SIDE, few.SIDE),
                  few.IMAGE: (1, 256, rows, few.SIDE), few.MASK_WEIGHTS: (PROMPTS, few.MASKS, few.UPSCALED)}  # fmt: skip
        given = {name: random.normal(size=shape).astype(np.float32) for name, shape in shapes.items()}
        tokens, masks = answers(few.few_token_graph(weights), given, (few.TOKENS_OUT, few.MASKS_OUT))

        def places(x):
            return np.repeat(x[:, :, :rows].reshape(256, -1).T[None], PROMPTS, 0)

        plain = PlainDecoder(weights)
        true_tokens, image = plain.transform(given[few.TOKENS], places(given[few.IMAGE] + weights[few.NO_MASK]), places(given[few.POSITIONS]))
        true_masks = plain.masks(image, given[few.MASK_WEIGHTS])
        true_masks = np.pad(true_masks, ((0, 0), (0, 0), (0, 4 * (few.SIDE - rows)), (0, 0)), "edge")
        np.testing.assert_allclose(tokens, true_tokens, atol=1e-4)
        np.testing.assert_allclose(masks, true_masks, atol=1e-3 * np.abs(true_masks).max())
        self.assertGreater(np.abs(true_masks).max(), 1)


if __name__ == "__main__":
    unittest.main()
