// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_tables/map_file_record.h"

namespace ovimap {

/// Everything that mapping found but the voxels, and the log of corrections. Throws Error with a
/// phrase when the file does not hold what was written.
/// `forest`: the map's; objects of old maps that have no super-point get one with a new label.
MapMeta read_found(SQLite::Database& database, int schema, LabelForest& forest, MapRecord& record);

/// The voxels, verified.
VoxelMap read_voxels(SQLite::Database& database, int schema, const MapMeta& meta,
                     const LabelForest& forest);

/// What read_map_info() reads.
MapInfo read_info(SQLite::Database& database, const OpenMap& file);

}  // namespace ovimap
