# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Turns Hugging Face checkpoints into ovimap model folders."""
