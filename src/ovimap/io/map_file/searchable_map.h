// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "ovimap/io/map_file/map_file.h"
#include "ovimap/semantics/relations/object_shapes.h"

namespace ovimap {

/// What a search in a map needs.
struct SearchableMap {
  MapInfo info;
  Embeddings embeddings;       ///< row i belongs to info.instances[i]; zeros: it has none
  Embeddings part_embeddings;  ///< likewise of info.parts
  ObjectShapes shapes;         ///< of the instances; surfaces are read from the file when asked for
  std::vector<FrameLogEntry> frames;
};

/// The frames of a map, and what they showed last.
struct MapSightings {
  std::vector<FrameLogEntry> frames;
  /// FrameLogEntry::index of the last frame whose segments showed each super-point; empty in maps
  /// of earlier schemas.
  std::map<Label, std::int64_t> last;
};
MapSightings read_sightings(const std::filesystem::path& path);

/// Of the instances of a map as people corrected it; verified likewise.
InstanceSurfaces read_corrected_surfaces(const std::filesystem::path& path);

/// Reads it without the voxels, verified likewise.
SearchableMap read_searchable_map(const std::filesystem::path& path);

}  // namespace ovimap
