// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

class ConfigFields;

/// How much what was seen in earlier visits counts in a new one.
struct PastEvidenceConfig {
  float most_weight = 4.f;  ///< of a voxel's distance: its standard error is half a voxel or more
  int most_support = 2;     ///< of a voxel's strongest label; the others keep their share of it
};
void list_fields(PastEvidenceConfig& config, ConfigFields& fields);

/// Between two visits anything may have changed, by more than surfaces err: a book that was laid on
/// the table lies within the truncation of what hundreds of frames saw there. So no voxel goes into
/// the new visit with more than that evidence, and a few frames tell what is there now.
void discount_past(VoxelMap& map, const PastEvidenceConfig& config);

}  // namespace ovimap
