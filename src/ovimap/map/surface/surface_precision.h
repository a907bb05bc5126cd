// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// How well the surface in a block is known: the median standard error of the distance of the
/// voxels within one voxel of it, metres. The weight of a voxel is its information (see integrate),
/// so that many frames, near ones and such as agree with what the sensor can do make it small.
/// Nothing where the block has no surface that the mesh shows.
std::optional<float> surface_error_m(const VoxelMap& map, const VoxelBlock& block);

/// The same in a byte, as it is sent: steps of a fifth of a millimetre, 1 to 255; 0: unknown. What
/// is worse than the last step is as bad as that.
std::uint8_t error_byte(std::optional<float> error_m);

/// What a byte stands for, metres; not of 0.
float error_of_byte(std::uint8_t byte);

}  // namespace ovimap
