// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_edits.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "ovimap/base/error.h"
#include "ovimap/io/corrections/map_edit_desk.h"
#include "ovimap/io/corrections/map_edit_log.h"
#include "ovimap/io/corrections/map_file_corrections.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_file/map_file_change.h"
#include "ovimap/io/map_file/map_file_parts.h"
#include "ovimap/io/map_file/saved_tiles.h"

namespace ovimap {

namespace {

/// Nobody corrects the map while it is held. Null where nobody can anyway, or somebody does for
/// ever.
std::unique_ptr<MapChange> held(const std::filesystem::path& path) {
  constexpr int kPatience_ms = 60000;
  try {
    return std::make_unique<MapChange>(path, kPatience_ms);
  } catch (const Error&) {
    return nullptr;
  }
}

/// Appends to the document's log what is new in `log`. Returns what makes no sense there.
std::vector<std::string> carry_later_edits(const MapEdits& log, MapDocument& document) {
  const auto same = [](const MapEdit& a, const MapEdit& b) {
    return a.id == b.id && a.action == b.action && a.time_s == b.time_s;
  };
  auto later =
      std::mismatch(log.begin(), log.end(), document.edits.begin(), document.edits.end(), same)
          .first;
  std::vector<std::string> lost;
  const std::int64_t first_later = later == log.end() ? 0 : later->id;
  std::map<std::int64_t, std::int64_t> ids;    // in the document, by what they are in the file
  std::map<InstanceId, InstanceId> split_off;  // likewise
  for (; later != log.end(); ++later) {
    MapEdit edit = *later;
    if (const auto found = ids.find(edit.undoes); found != ids.end())
      edit.undoes = found->second;
    else if (edit.undoes >= first_later)
      continue;  // undoes what was lost
    for (InstanceId& id : edit.instances)
      if (const auto found = split_off.find(id); found != split_off.end()) id = found->second;
    try {
      const MapEdit carried = append_edit(
          document, document.map.labels(), [&]() -> const VoxelMap& { return document.map; }, edit);
      ids[later->id] = carried.id;
      if (carried.new_instance != 0) split_off[later->new_instance] = carried.new_instance;
    } catch (const Error& fault) {
      lost.push_back(
          concat("edit ", later->id, " (", edit_action_name(edit.action), "): ", fault.what()));
    }
  }
  return lost;
}

}  // namespace

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
      change.read([&](SQLite::Database& database) {
        map = read_voxels(database, change.schema(), meta, forest);
      });
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

std::vector<std::string> replace_map(const std::filesystem::path& path, MapDocument& document) {
  const auto nobody_else = held(path);
  std::vector<std::string> lost = carry_later_edits(read_edits(path), document);
  save_map(path, document);
  return lost;
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
