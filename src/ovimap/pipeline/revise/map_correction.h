// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/mapping/mapper_config.h"

namespace ovimap {

/// What corrected poses did to a map.
struct PoseCorrection {
  std::size_t moved = 0;                  ///< frames with another pose than before
  std::size_t refused = 0;                ///< frames that were fused again
  std::size_t blocks = 0;                 ///< of voxels that were made anew
  double furthest_m = 0, widest_rad = 0;  ///< the largest move and turn of a frame
};

/// Moves a map to corrected poses (of every frame of its log, world_from_camera of the depth
/// camera): what frames that moved show is fused anew from what the map keeps (fuse_moved), and the
/// instances are measured again. Labels stay what they are, so that instances keep ids, names,
/// corrections and embeddings. `config`: the settings of the run that made the map. Throws Error
/// when the map keeps no frames.
///
/// Blocks are made anew, rather than old views taken out of their voxels: weights are capped,
/// distances and colours rounded, and label slots forget, so no frame can be taken out exactly.
PoseCorrection correct_poses(
    MapDocument& map, const std::vector<Pose>& poses, const MapperConfig& config,
    const std::function<void(std::size_t, std::size_t)>& progress = nullptr);

}  // namespace ovimap
