// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ovimap/map/fusion/integrate.h"

namespace ovimap {

/// A block of which a part may lie in free space.
struct BlockAhead {
  std::uint32_t slot;
  float free_m;  ///< the rays through it run through empty space no further than this depth
};

/// The blocks of which a part may lie in front of `free_m` (free_depth), in block-index order:
/// those between the camera and what it sees, of Observation::blocks. Costs one projection per
/// block in view.
std::vector<BlockAhead> blocks_ahead(const VoxelMap& map, const Observation& observation,
                                     const Image<float>& free_m);

/// How many pixels of the frame show surface where the map has surface, whichever block that is in,
/// judged by one in 64.
double confirmed_px(const VoxelMap& map, const Observation& observation);

/// Whether the frame sees through nearly all of the map that it should see, and by far: three
/// quarters of the places where both have surface, by a fifth of the depth at least, and the map
/// has surface in half of what the frame shows. No drift of poses shows that, and little that
/// happens in a room: a sensor's depth that is suddenly all far does, and a pose of somewhere else.
/// Where more than a quarter of the frame lies on surface of the map it does not, whatever stood
/// before that. Judged by some hundred pixels.
bool sees_through_map(const VoxelMap& map, const Observation& observation);

}  // namespace ovimap
