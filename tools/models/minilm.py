# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The sentence encoder all-MiniLM-L6-v2 (a BERT of six layers; Devlin et al. 2019, Wang et al.
2020) as an ONNX graph: token ids and mask in, the mean over the unmasked tokens out. Token types
are left out: a lone text has one type only, whose embedding is added to the positions'."""

import numpy as np
from onnx import TensorProto

LAYERS = 6
HEADS = 12
WIDTH = 384
LAYER_NORM_EPSILON = 1e-12
MASKED = -1e9  # added to the attention's logits


class _Network:
    def __init__(self, graph, weights):
        self.graph, self.weights = graph, weights

    def linear(self, tensor, name):
        weight = self.graph.half_constant(self.weights[f"{name}.weight"].T)
        product = self.graph.add("MatMul", tensor, weight)
        return self.graph.add("Add", product, self.graph.constant(self.weights[f"{name}.bias"]))

    def layer_norm(self, tensor, name):
        return self.graph.add(
            "LayerNormalization",
            tensor,
            self.graph.constant(self.weights[f"{name}.weight"]),
            self.graph.constant(self.weights[f"{name}.bias"]),
            axis=-1,
            epsilon=LAYER_NORM_EPSILON,
        )

    def gelu(self, tensor):
        graph = self.graph
        error = graph.add("Erf", graph.add("Div", tensor, graph.constant(np.sqrt(2.0))))
        gate = graph.add("Mul", graph.add("Add", error, graph.constant(1)), graph.constant(0.5))
        return graph.add("Mul", tensor, gate)

    def heads(self, tensor, order):
        shape = self.graph.constant([0, 0, HEADS, WIDTH // HEADS], np.int64)
        return self.graph.add("Transpose", self.graph.add("Reshape", tensor, shape), perm=order)

    def attention(self, tensor, penalty, name):
        graph = self.graph
        query = self.heads(self.linear(tensor, f"{name}.self.query"), [0, 2, 1, 3])
        key = self.heads(self.linear(tensor, f"{name}.self.key"), [0, 2, 3, 1])
        value = self.heads(self.linear(tensor, f"{name}.self.value"), [0, 2, 1, 3])
        logits = graph.add("MatMul", query, key)
        logits = graph.add("Mul", logits, graph.constant((WIDTH // HEADS) ** -0.5))
        weights = graph.add("Softmax", graph.add("Add", logits, penalty), axis=-1)
        mixed = graph.add("Transpose", graph.add("MatMul", weights, value), perm=[0, 2, 1, 3])
        joined = graph.add("Reshape", mixed, graph.constant([0, 0, WIDTH], np.int64))
        return self.linear(joined, f"{name}.output.dense")

    def layer(self, tensor, penalty, name):
        graph = self.graph
        attended = self.attention(tensor, penalty, f"{name}.attention")
        tensor = self.layer_norm(
            graph.add("Add", tensor, attended), f"{name}.attention.output.LayerNorm"
        )
        inner = self.gelu(self.linear(tensor, f"{name}.intermediate.dense"))
        outer = self.linear(inner, f"{name}.output.dense")
        return self.layer_norm(graph.add("Add", tensor, outer), f"{name}.output.LayerNorm")

    def embeddings(self, ids):
        graph = self.graph
        words = graph.add(
            "Gather", graph.half_constant(self.weights["embeddings.word_embeddings.weight"]), ids
        )
        positions = self.weights["embeddings.position_embeddings.weight"].astype(np.float64)
        positions += self.weights["embeddings.token_type_embeddings.weight"][0]
        length = graph.add("Slice", graph.add("Shape", ids), *self._int64([1], [2], [0]))
        place = graph.add("Slice", graph.constant(positions), *self._int64([0]), length,
                          *self._int64([0]))
        return self.layer_norm(graph.add("Add", words, place), "embeddings.LayerNorm")

    def _int64(self, *lists):
        return [self.graph.constant(values, np.int64) for values in lists]

    def masked_mean(self, tensor, mask):
        graph = self.graph
        weights = graph.add("Unsqueeze", mask, *self._int64([2]))
        total = graph.add(
            "ReduceSum", graph.add("Mul", tensor, weights), *self._int64([1]), keepdims=0
        )
        count = graph.add("ReduceSum", weights, *self._int64([1]), keepdims=0)
        return graph.add("Div", total, graph.add("Max", count, graph.constant(1e-9)))


def add_sentence_mean(graph, weights, ids, mask):
    """[N, 384] of token ids and mask, both int64 [N, L]; not normalised."""
    network = _Network(graph, weights)
    mask = graph.add("Cast", mask, to=TensorProto.FLOAT)
    absent = graph.add("Sub", graph.constant(1), mask)
    penalty = graph.add("Mul", absent, graph.constant(MASKED))
    penalty = graph.add("Unsqueeze", penalty, graph.constant([1, 2], np.int64))
    tensor = network.embeddings(ids)
    for index in range(LAYERS):
        tensor = network.layer(tensor, penalty, f"encoder.layer.{index}")
    return network.masked_mean(tensor, mask)
