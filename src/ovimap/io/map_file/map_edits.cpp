// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_edits.h"

#include <optional>

#include "ovimap/io/corrections/map_edit_desk.h"
#include "ovimap/io/corrections/map_edit_log.h"
#include "ovimap/io/corrections/map_file_corrections.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_file/map_file_change.h"
#include "ovimap/io/map_file/map_file_parts.h"
#include "ovimap/io/map_file/saved_tiles.h"

namespace ovimap {

MapEdit edit_map(const std::filesystem::path& path, MapEdit edit) {
  MapChange change(path);
  MapRecord found;
  LabelForest forest;
  MapMeta meta;
  change.read([&](SQLite::Database& database) {
    forest = read_forest(database);
    meta = read_found(database, change.schema(), forest, found);
  });
  std::optional<VoxelMap> map;
  const VoxelSource voxels = [&]() -> const VoxelMap& {
    if (!map)
      change.read([&](SQLite::Database& database) { map = read_voxels(database, meta, forest); });
    return *map;
  };
  edit = append_edit(found, forest, voxels, std::move(edit));
  change.write(
      [&](SQLite::Database& database) { write_corrections(database, found, forest, voxels); });
  change.commit();
  return edit;
}

MapEdits read_edits(const std::filesystem::path& path) {
  OpenMap file(path);
  MapEdits log;
  file.read([&](SQLite::Database& database) { log = read_edits(database); });
  return log;
}

MapDocument load_corrected_map(const std::filesystem::path& path) {
  constexpr std::size_t kMostVoxelBytes = std::size_t{1}
                                          << 30;  // a flat's stay once they were read
  MapDocument document = load_map_by_tiles(path, kMostVoxelBytes);
  const VoxelMap& map = document.map;
  apply_edits(document, map.labels(), [&]() -> const VoxelMap& { return map; });
  return document;
}

}  // namespace ovimap
