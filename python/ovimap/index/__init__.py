# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The objects of many maps as tables, and one search over all of them: what `ovimap-index` does (docs/many-maps.md)."""

from .objects import export_objects, object_table
from .search import Answer, MapAnswer, ObjectIndex

__all__ = ["Answer", "MapAnswer", "ObjectIndex", "export_objects", "object_table"]
