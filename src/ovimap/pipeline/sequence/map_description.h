// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// Fills in what a record says of the voxels of a finished map: instances, their surfaces, and
/// which way is up, by the poses of its frames. Walks over the voxels part by part.
void describe_map(const VoxelMap& map, const InstanceRegistry& registry,
                  const InstanceSummaryConfig& config, MapRecord& record);

}  // namespace ovimap
