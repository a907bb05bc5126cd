# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The mathematics of the default encoder's head: a picture's embedding is

    share * (probabilities @ classes - class_mean) + features @ weights + bias

where the first part is the classifier's own answer (ConSE) and the second a ridge regression from
the classifier's features to the centred embeddings of the names of what the pictures show. So that
the regression keeps what the classifier knows and furniture does not show, it is also fitted to
one made-up feature vector for each ImageNet class (an anchor)."""

import dataclasses

import numpy as np

COVARIANCE_SHRINKAGE = 0.3
ANCHOR_PROBABILITY = 0.6
MAP_SHARE = 0.8
BISECTIONS, MOST_STEPS = 25, 200.0


@dataclasses.dataclass(frozen=True)
class Settings:
    anchor_weight: float  # of an anchor against the mean weight of a picture
    ridge: float  # against the mean diagonal entry
    share: float  # of the classifier's own answer
    temperature: float  # of its probabilities


def normalised(rows):
    return rows / np.maximum(np.linalg.norm(rows, axis=-1, keepdims=True), 1e-12)


def probabilities(logits, temperature=1.0):
    shifted = (logits - logits.max(-1, keepdims=True)) / temperature
    weights = np.exp(shifted)
    return weights / weights.sum(-1, keepdims=True)


class Classifier:
    """The last layer of the network, and where each class lies among the features."""

    def __init__(self, weights, bias):
        self.weights, self.bias = weights.astype(np.float64), bias.astype(np.float64)

    def logits(self, features):
        return features @ self.weights.T + self.bias

    def anchors(self, features, shown):
        """[classes, features]: from the mean feature, a step towards each class (its direction in
        linear discriminant analysis, with the covariance within the models that `shown` tells
        apart) that is just long enough for ANCHOR_PROBABILITY."""
        middle = features.mean(0)
        means = np.stack([features[shown == i].mean(0) for i in np.unique(shown)])
        rest = features - means[np.searchsorted(np.unique(shown), shown)]
        covariance = rest.T @ rest / len(rest)
        covariance += np.eye(len(covariance)) * (
            COVARIANCE_SHRINKAGE * np.trace(covariance) / len(covariance)
        )
        directions = (self.weights - self.weights.mean(0)) @ covariance
        low, high = np.zeros(len(directions)), np.full(len(directions), MOST_STEPS)
        for _ in range(BISECTIONS):
            step = (low + high) / 2
            points = np.maximum(middle + step[:, None] * directions, 0)
            enough = np.diag(probabilities(self.logits(points))) >= ANCHOR_PROBABILITY
            low, high = np.where(enough, low, step), np.where(enough, step, high)
        return np.maximum(middle + high[:, None] * directions, 0)


def ridge(inputs, targets, weights, strength):
    """Weights [inputs, targets] and bias of the weighted ridge regression."""
    total = weights.sum()
    input_mean, target_mean = weights @ inputs / total, weights @ targets / total
    root = np.sqrt(weights)[:, None]
    centred, wanted = (inputs - input_mean) * root, (targets - target_mean) * root
    gram = centred.T @ centred
    gram[np.diag_indices_from(gram)] += strength * np.trace(gram) / len(gram)
    solution = np.linalg.solve(gram, centred.T @ wanted)
    return solution, target_mean - input_mean @ solution


def fit_head(settings, pictures, crops, anchors):
    """The ridge regression over `pictures` and `crops` (features, targets, weights of any scale), of whose weight the crops
    have MAP_SHARE, and `anchors` (features, targets), which weigh settings.anchor_weight each. `crops` may be None."""
    share = MAP_SHARE if crops else 0.0
    parts = [(*pictures[:2], scaled(pictures[2], (1 - share) * len(pictures[2])))]
    if crops:
        parts.append((*crops[:2], scaled(crops[2], share * len(pictures[2]))))
    parts.append((*anchors, np.full(len(anchors[0]), settings.anchor_weight)))
    return ridge(*(np.concatenate(column) for column in zip(*parts)), settings.ridge)


def scaled(weights, total):
    return weights * (total / weights.sum())


def ranks(embeddings, words, accepted):
    """The best rank, from 1, that an accepted word has for each embedding."""
    scores = embeddings @ words.T
    best = np.array([row[list(good)].max() for row, good in zip(scores, accepted)])
    return 1 + (scores > best[:, None]).sum(1)


def recall(rank_list) -> dict:
    return {
        "recall@1": float(np.mean(rank_list <= 1)),
        "recall@5": float(np.mean(rank_list <= 5)),
        "mrr": float(np.mean(1 / rank_list)),
    }


def quantised(matrix):
    """Bytes and a scale a row."""
    scales = np.abs(matrix).max(1) / 127
    return np.round(matrix / scales[:, None]).astype(np.int8), scales.astype(np.float32)
