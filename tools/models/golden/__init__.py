# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Tiny checkpoints with random weights, and what the Hugging Face pipeline makes of them."""
