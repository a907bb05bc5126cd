// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "ovimap/instance/instance_aliases.h"
#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// Gives the voxels when they are needed, which is where an object was taken apart.
using VoxelSource = std::function<const VoxelMap&()>;

/// Turns what mapping found into what people made of it: instances, `hidden`, names, surfaces and
/// `locked` follow the record's log. `forest`: which labels are merged by now. The log, the
/// registry and the looks of super-points stay as they are. Returns the aliases that then hold,
/// those of mapping included.
InstanceAliases apply_edits(MapRecord& record, const LabelForest& forest,
                            const VoxelSource& voxels);

}  // namespace ovimap
