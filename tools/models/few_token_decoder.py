# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The mask decoder of SAM (Kirillov et al. 2023, section A) written so that many prompts cost little.

It answers what the published graph answers, to rounding: only the order of products changes.
- Attention between 4096 places of the image and some seven tokens multiplies the tokens by both
  projections first: x Wq (t Wk)^T = x (Wq (t Wk)^T), and A (x Wv) = (A x) Wv. So each place is
  multiplied by 8 heads x 7 tokens instead of 128 channels, and no large tensor is transposed.
- Before the first layer all prompts see one image: its keys and values are made once.
- There are as many places as the picture fills of its square (row_encoder.py), and masks go on below as they end.
- Places stay rows of a matrix to the end. A transposed convolution of stride 2 and size 2 is a product that
  gives each place its four; the masks alone are put in order, when four channels are left.
"""

import numpy as np
from onnx import numpy_helper
from transformer_graph import Graph

HEADS = 8
CHANNELS = 256
SIDE = 64  # of the image's features: columns, and rows at most
MASKS = 4
UPSCALED = 32  # channels that masks are made of
IMAGE = "image_embeddings"

# Tensors of the published graph between which the transformer and the upscaling lie.
TOKENS = "/Concat_2_output_0"
POSITIONS = "/Unsqueeze_1_output_0"
NO_MASK = "onnx::Mul_1919"
TOKENS_OUT = "/transformer/norm_final_attn/LayerNormalization_output_0"
MASK_WEIGHTS = "/Concat_10_output_0"
MASKS_OUT = "/Reshape_9_output_0"
UPSCALED_NORM = ("onnx::Mul_1984", "onnx::Add_1986")
DECODER = "mask_decoder."


class Weights:
    """Of the published graph, by the names of its layers."""

    def __init__(self, graph):
        self._values = {i.name: i for i in graph.initializer}
        self._products = {n.name: n.input[1] for n in graph.node if n.op_type == "MatMul"}

    def __getitem__(self, name):
        return numpy_helper.to_array(self._values[name])

    def linear(self, layer):
        """[in, out] and [out]."""
        return self[self._products[f"/{layer}/MatMul"]], self[f"{DECODER}{layer.replace('/', '.')}.bias"]

    def norm(self, layer):
        name = f"{DECODER}{layer.replace('/', '.')}"
        return self[f"{name}.weight"], self[f"{name}.bias"]


class Transformer:
    """Two-way attention: `tokens` [prompts, tokens, 256] and `image` [prompts or 1, places, 256]."""

    def __init__(self, graph, weights):
        self.g, self.w = graph, weights

    def heads(self, x):
        """[prompts, n, channels] to [prompts, heads, n, channels / heads]."""
        return self.g.transpose(self.g.reshape(x, 0, 0, HEADS, -1), 0, 2, 1, 3)

    def joined(self, x):
        return self.g.reshape(self.g.transpose(x, 0, 2, 1, 3), 0, 0, -1)

    @staticmethod
    def by_head(weight):
        """[in, out] to [1, heads, in, out / heads]."""
        return weight.reshape(1, weight.shape[0], HEADS, -1).transpose(0, 2, 1, 3)

    @staticmethod
    def scale(weight):
        """What scores are divided by."""
        return np.float32(np.sqrt(weight.shape[1] // HEADS))

    def softmax(self, scores):
        return self.g.add("Softmax", scores, axis=-1)

    def keys(self, x):
        """[prompts, heads, channels / heads, n] of [prompts, n, channels]."""
        return self.g.transpose(self.heads(x), 0, 1, 3, 2)

    def attended(self, name, q, k, v):
        made = self.joined(self.g.add("MatMul", self.softmax(self.g.add("MatMul", q, k)), v))
        return self.g.linear(made, self.w.linear(f"{name}/out_proj"))

    def attend_themselves(self, name, queries, values):
        layers = {part: self.w.linear(f"{name}/{part}_proj") for part in "qkv"}
        scale = self.scale(layers["q"][0])
        q = self.heads(self.g.linear(queries, tuple(part / scale for part in layers["q"])))
        k = self.keys(self.g.linear(queries, layers["k"]))
        v = self.heads(self.g.linear(values, layers["v"]))
        return self.attended(name, q, k, v)

    def queries_of_tokens(self, name, tokens):
        weight, bias = self.w.linear(f"{name}/q_proj")
        scale = self.scale(weight)
        return self.heads(self.g.linear(tokens, (weight / scale, bias / scale)))

    def look_at_one_image(self, name, tokens, keys, values):
        """Of an image that all prompts share. The bias of keys says the same of all places: it falls out of the softmax."""
        q = self.queries_of_tokens(name, tokens)
        k = self.keys(self.g.add("MatMul", keys, self.w.linear(f"{name}/k_proj")[0]))
        v = self.heads(self.g.linear(values, self.w.linear(f"{name}/v_proj")))
        return self.attended(name, q, k, v)

    def look_at_images(self, name, tokens, keys, values):
        q = self.queries_of_tokens(name, tokens)
        back = self.by_head(self.w.linear(f"{name}/k_proj")[0]).transpose(0, 1, 3, 2)
        q = self.g.reshape(self.g.add("MatMul", q, back), 0, -1, CHANNELS)
        shares = self.softmax(self.g.add("MatMul", q, self.g.transpose(keys, 0, 2, 1)))
        seen = self.g.reshape(self.g.add("MatMul", shares, values), 0, HEADS, -1, CHANNELS)
        weight, bias = self.w.linear(f"{name}/v_proj")
        made = self.g.add("Add", self.joined(self.g.add("MatMul", seen, self.by_head(weight))), bias)
        return self.g.linear(made, self.w.linear(f"{name}/out_proj"))

    def tell_images(self, name, image, keys, values):
        """[prompts, places, 256]: what places take from the tokens."""
        weight, bias = self.w.linear(f"{name}/q_proj")
        scale = self.scale(weight)
        k = self.keys(self.g.linear(keys, self.w.linear(f"{name}/k_proj")))
        ask = self.g.add("MatMul", self.by_head(weight / scale), k)  # [prompts, heads, 256, tokens]
        ask = self.g.reshape(self.g.transpose(ask, 0, 2, 1, 3), 0, CHANNELS, -1)
        always = self.g.reshape(self.g.add("MatMul", self.by_head(bias[None] / scale), k), 0, 1, -1)
        scores = self.g.add("Add", self.g.add("MatMul", image, ask), always)
        shares = self.softmax(self.g.reshape(scores, 0, 0, HEADS, -1))
        out, out_bias = self.w.linear(f"{name}/out_proj")
        back = out.reshape(1, HEADS, -1, CHANNELS)
        v = self.heads(self.g.linear(values, self.w.linear(f"{name}/v_proj")))
        told = self.g.add("Add", self.g.add("MatMul", v, back), out_bias / HEADS)  # shares of a head sum to one
        return self.g.add("MatMul", self.g.reshape(shares, 0, 0, -1), self.g.reshape(told, 0, -1, CHANNELS))

    def layer(self, number, tokens, image, first_tokens, positions):
        name, g = f"transformer/layers.{number}", self.g
        norm = lambda x, which: g.norm(x, self.w.norm(f"{name}/norm{which}"), 1e-5)  # noqa: E731
        if number == 0:
            tokens = norm(self.attend_themselves(f"{name}/self_attn", tokens, tokens), 1)
        else:
            asking = g.add("Add", tokens, first_tokens)
            tokens = norm(g.add("Add", tokens, self.attend_themselves(f"{name}/self_attn", asking, tokens)), 1)
        keys = g.add("Add", image, positions)
        look = self.look_at_one_image if number == 0 else self.look_at_images
        seen = look(f"{name}/cross_attn_token_to_image", g.add("Add", tokens, first_tokens), keys, image)
        tokens = norm(g.add("Add", tokens, seen), 2)
        wide = g.linear(tokens, self.w.linear(f"{name}/mlp/lin1"), relu=True)
        tokens = norm(g.add("Add", tokens, g.linear(wide, self.w.linear(f"{name}/mlp/lin2"))), 3)
        told = self.tell_images(f"{name}/cross_attn_image_to_token", keys, g.add("Add", tokens, first_tokens), tokens)
        return tokens, norm(g.add("Add", image, told), 4)

    def run(self, tokens, image, positions):
        first_tokens = tokens
        for number in range(2):
            tokens, image = self.layer(number, tokens, image, first_tokens, positions)
        asking, keys = self.g.add("Add", tokens, first_tokens), self.g.add("Add", image, positions)
        seen = self.look_at_images("transformer/final_attn_token_to_image", asking, keys, image)
        self.g.norm(self.g.add("Add", tokens, seen), self.w.norm("transformer/norm_final_attn"), 1e-5, result=TOKENS_OUT)
        return image


def upscale(g, x, weights, layer):
    """Each place to its four: [n, in] to [4 n, out]."""
    weight, bias = weights[f"{DECODER}output_upscaling.{layer}.weight"], weights[f"{DECODER}output_upscaling.{layer}.bias"]
    product = weight.transpose(0, 2, 3, 1).reshape(weight.shape[0], -1)
    return g.reshape(g.add("Gemm", x, product, np.tile(bias, 4)), -1, len(bias))


def masks_of(g, image, rows, weights):
    x = upscale(g, g.reshape(image, -1, CHANNELS), weights, 0)
    x = g.gelu(g.norm(x, tuple(weights[name].ravel() for name in UPSCALED_NORM), 1e-6))
    x = g.gelu(upscale(g, x, weights, 3))
    of_prompt = g.add("Concat", np.array([-1]), g.add("Mul", rows, np.array([16 * SIDE])), np.array([UPSCALED]), axis=0)
    x = g.add("MatMul", g.add("Reshape", x, of_prompt), g.transpose(MASK_WEIGHTS, 0, 2, 1))
    x = g.reshape(x, 0, -1, SIDE, 2, 2, 2, 2, MASKS)  # row, column, then twice the row and column among four
    x = g.reshape(g.transpose(x, 0, 7, 1, 3, 5, 2, 4, 6), 0, MASKS, -1, 4 * SIDE)
    below = g.add("Sub", np.array([4 * SIDE]), g.add("Mul", rows, np.array([4])))
    pads = g.add("Concat", np.zeros(6, np.int64), below, np.array([0]), axis=0)
    g.add("Pad", x, pads, result=MASKS_OUT, mode="edge")


def few_token_graph(weights):
    """From TOKENS, POSITIONS, IMAGE and MASK_WEIGHTS to TOKENS_OUT and MASKS_OUT."""
    g = Graph()
    rows = g.length(IMAGE, 2)
    image = g.add("Add", IMAGE, weights[NO_MASK].reshape(1, CHANNELS, 1, 1))
    image = g.transpose(g.reshape(image, 1, CHANNELS, -1), 0, 2, 1)
    positions = g.add("Slice", POSITIONS, np.array([0]), rows, np.array([2]))
    positions = g.transpose(g.reshape(positions, 1, CHANNELS, -1), 0, 2, 1)
    masks_of(g, Transformer(g, weights).run(TOKENS, image, positions), rows, weights)
    return g


def with_few_tokens(graph):
    """The nodes of the published graph, those of its transformer and upscaling replaced, and their constants."""
    few = few_token_graph(Weights(graph))
    made = {name for node in few.nodes for name in node.output}
    return few.nodes + [node for node in graph.node if not made & set(node.output)], few.constants
