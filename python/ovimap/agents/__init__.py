# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Maps for programs that decide by themselves: one way to ask a map, whether it is a file or being made (docs/agents.md)."""

from .backend import MapBackend, MapFault, open_map

__all__ = ["MapBackend", "MapFault", "open_map"]
