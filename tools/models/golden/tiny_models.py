# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Models of two layers whose random weights are the same with any version of the libraries."""

import numpy as np
import torch

SEED = 20260
TOWER = {
    "hidden_size": 16,
    "intermediate_size": 24,
    "num_hidden_layers": 2,
    "num_attention_heads": 2,
}


def fill(model, attention_gain: float = 4.0, gain: float = 1.2, seed: int = SEED):
    """Gives every parameter numbers of its own, from its name and `seed`; gains large enough
    that different inputs have clearly different answers."""
    for name, parameter in sorted(model.named_parameters()):
        rng = np.random.default_rng([seed, *name.encode()])
        shape = tuple(parameter.shape)
        values = rng.normal(size=shape)
        if "norm" in name.lower() and name.endswith("weight"):
            values = 1 + 0.1 * values
        elif "position" in name or "token_type" in name:
            values *= 0.3  # else a pooled token knows where it is, but not what stands before it
        elif "embedding" in name and "patch" not in name:
            pass
        elif values.ndim < 2:
            values *= 0.1
        elif "attn" in name or "attention" in name:
            values *= attention_gain / np.sqrt(shape[-1])
        else:
            values *= gain / np.sqrt(np.prod(shape[1:]))
        if parameter.ndim > 0 and parameter.numel() > 1:
            with torch.no_grad():
                parameter.copy_(torch.from_numpy(np.asarray(values, np.float32)))
    return model.eval()


def set_scalar(parameter, value: float):
    with torch.no_grad():
        parameter.fill_(value)
