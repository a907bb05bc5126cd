# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A map as rooms, places, objects and relations, for programs that have formats of their own for that (docs/export.md)."""

from .scene import Scene, SceneObject, read_scene

__all__ = ["Scene", "SceneObject", "read_scene"]
