// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

/// What summarize_instances finds, with what people corrected. `edits`: the map's log.
std::vector<InstanceSummary> summarize_objects(const SurfaceExtents& extents,
                                               const LabelForest& forest,
                                               const InstanceRegistry& registry,
                                               const InstanceSummaryConfig& config,
                                               const MapEdits& edits);

/// Fills in what a record says of the voxels of a finished map: instances, their surfaces, and
/// which way is up, by the poses of its frames. Walks over the voxels part by part.
void describe_map(const VoxelMap& map, const InstanceRegistry& registry,
                  const InstanceSummaryConfig& config, MapRecord& record);

}  // namespace ovimap
