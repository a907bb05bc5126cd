// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/corrections/map_file_corrections.h"

#include <algorithm>

#include "ovimap/io/corrections/map_edit_log.h"
#include "ovimap/io/map_tables/map_file_record.h"
#include "ovimap/io/map_tables/map_file_rows.h"
#include "ovimap/io/map_tables/map_file_semantics.h"

namespace ovimap {

namespace {

using namespace map_tables;

/// Objects that a person hid or locked.
void write_flags(SQLite::Database& database, const MapRecord& corrected) {
  std::set<InstanceId> hidden;
  for (const InstanceSummary& instance : corrected.hidden) hidden.insert(instance.id);
  std::set<InstanceId> flagged = corrected.locked;
  flagged.insert(hidden.begin(), hidden.end());
  RowWriter rows(database, kCorrectedFlags);
  for (const InstanceId id : flagged)
    rows.insert(id, hidden.contains(id) ? 1 : 0, corrected.locked.contains(id) ? 1 : 0);
  rows.finish();
}

}  // namespace

void write_corrections(SQLite::Database& database, const MapRecord& found,
                       const LabelForest& forest, const VoxelSource& voxels) {
  for (const MapTable& table :
       {kEdits, kCorrectedInstances, kCorrectedSuperPoints, kCorrectedNames, kCorrectedConfidences,
        kCorrectedSurfaces, kCorrectedShapes, kCorrectedEmbeddings, kCorrectedFlags})
    drop_table(database, table);
  if (found.edits.empty()) return;
  write_edits(database, found.edits);
  if (effective_edits(found.edits).empty()) return;
  MapRecord corrected = found;
  apply_edits(corrected, forest, voxels);
  write_flags(database, corrected);
  write_surfaces(database, corrected.surfaces, kCorrectedSurfaces);
  write_shapes(database, corrected, kCorrectedShapes);
  write_embeddings(database, corrected.instances, corrected.semantics, kCorrectedEmbeddings);
  std::vector<InstanceSummary>& all = corrected.instances;
  all.insert(all.end(), corrected.hidden.begin(), corrected.hidden.end());
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  write_instances(database, corrected, kCorrectedInstanceTables);
}

bool has_corrections(SQLite::Database& database) {
  return holds_table(database, kCorrectedFlags);
}

void read_corrected_instances(SQLite::Database& database, MapRecord& record) {
  read_instances(database, record, kCorrectedInstanceTables);
  std::set<InstanceId> hidden;
  RowReader rows(database, kCorrectedFlags);
  while (rows.next()) {
    const auto id = rows.integer<InstanceId>();
    if (rows.integer<int>() != 0) hidden.insert(id);
    if (rows.integer<int>() != 0) record.locked.insert(id);
  }
  std::erase_if(record.instances, [&](const InstanceSummary& instance) {
    if (!hidden.contains(instance.id)) return false;
    record.hidden.push_back(instance);
    return true;
  });
}

}  // namespace ovimap
