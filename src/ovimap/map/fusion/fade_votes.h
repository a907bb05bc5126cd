// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// Divides the votes of all labels by `divisor` (at least 1), rounding up, so that the labels of
/// voxels stay and what is seen from now on can outvote them. Where a flat thing came to stand on
/// another, or left it, voxels are the same, and only votes tell. Lets the map make room on the way.
void fade_votes(VoxelMap& map, int divisor);

}  // namespace ovimap
