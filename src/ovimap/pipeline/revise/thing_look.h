// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/map/rays/surface_lookup.h"

namespace ovimap {

/// A thing's surface and its colours, to know it again at another place.
struct ThingLook {
  std::vector<Eigen::Vector3f> points;  ///< about their mean, z upwards, metres
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< of each, sRGB; all 0: unknown
  Eigen::Isometry3f world_from_look = Eigen::Isometry3f::Identity();
  float reach_m = 0;                    ///< root of their mean squared distance from it
};

/// The points without pieces of less than such a share of them, or without any where all are. Pieces
/// are what gaps of `gap_m`, and of up to twice that, part.
std::vector<Eigen::Vector3f> large_pieces(const std::vector<Eigen::Vector3f>& points, float gap_m,
                                          float least_share);

/// The colour of the voxel at a point, sRGB; all 0 where it has none.
std::array<std::uint8_t, 3> color_at(VoxelFinder& finder, const Eigen::Vector3f& point);

/// `up`: unit, in the world. Points without surface have no colour.
ThingLook thing_look(const MapDocument& map, InstanceId id, const Eigen::Vector3f& up);

}  // namespace ovimap
