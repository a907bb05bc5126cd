// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/pose.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// Appends the labels of `other` to those of `map`, with their merges: label l of `other` becomes
/// l + the returned offset.
Label append_labels(VoxelMap& map, const LabelForest& other);

/// Fuses the voxels of `other` into `map`: distances and colours by their weights, label supports
/// added. Labels of `other` get `label_offset` (append_labels). Where the voxels of both maps
/// coincide each is taken as it is; else distance, weight and colour are interpolated between eight
/// observed voxels, and labels are those of the nearest.
void fuse_map(VoxelMap& map, const VoxelMap& other, const Pose& map_from_other, Label label_offset);

}  // namespace ovimap
