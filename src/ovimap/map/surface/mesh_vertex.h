// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "ovimap/map/voxels/label_slots.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

struct MeshEdgeEnd {
  const VoxelBlock* block;
  int voxel;
};

/// An edge between two neighbouring voxels that the surface crosses.
struct MeshEdge {
  Eigen::Vector3i start;  ///< global voxel coordinates
  int axis;
  MeshEdgeEnd low, high;  ///< the voxels at its start and end
};

struct MeshVertex {
  Eigen::Vector3f position;  ///< world, metres
  std::array<std::uint8_t, 3> color{};
  Label label = kNoLabel;
};

/// The vertex where the surface crosses an edge: colour and label of the voxel nearer to the
/// surface; of the other one where that has none.
inline MeshVertex mesh_vertex(const VoxelMap& map, const MeshEdge& edge) {
  const auto tsdf = [](const MeshEdgeEnd& end) {
    return static_cast<float>(end.block->tsdf[static_cast<std::size_t>(end.voxel)]);
  };
  const float low = tsdf(edge.low), along = low / (low - tsdf(edge.high));
  MeshVertex vertex;
  vertex.position = edge.start.cast<float>().array() + 0.5f;
  vertex.position[edge.axis] += along;
  vertex.position *= map.config().voxel_size_m;
  const MeshEdgeEnd& nearer = along < 0.5f ? edge.low : edge.high;
  const MeshEdgeEnd& farther = along < 0.5f ? edge.high : edge.low;
  for (const MeshEdgeEnd& end : {nearer, farther}) {
    const auto voxel = static_cast<std::size_t>(end.voxel);
    if (vertex.color == std::array<std::uint8_t, 3>{})
      vertex.color = color_levels(end.block->color[voxel]);
    if (vertex.label == kNoLabel) vertex.label = voxel_label(*end.block, end.voxel, map.labels());
  }
  return vertex;
}

}  // namespace ovimap
