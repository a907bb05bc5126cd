// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/instance/instance_registry.h"
#include "ovimap/instance/surface_extents.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

struct InstanceSummaryConfig {
  int min_instance_voxels = 20;    ///< instances with fewer surface voxels are left out
  int min_instance_views = 2;      ///< seen in fewer frames: left out, where masks are not rated
  float min_confidence = 1.f / 6;  ///< where they are: instances of which they are less sure are
                                   ///< left out. So sure is one frame whose mask fits by half
  int min_part_views = 3;          ///< parts of objects told by fewer frames are left out
  float max_part_share = 0.8f;     ///< so are those that are more of their object
};
void list_fields(InstanceSummaryConfig& config, ConfigFields& fields);

/// One object of the map. World frame, metres.
struct InstanceSummary {
  InstanceId id = 0;
  Eigen::AlignedBox3f box;
  Eigen::Vector3f centroid = Eigen::Vector3f::Zero();
  std::size_t points = 0;           ///< surface voxels
  int views = 0;                    ///< frames in which it was seen
  std::vector<Label> super_points;  ///< roots, ascending
  /// How sure masks are that it is one whole thing, 0 to 1 (EntityFits); none where their source
  /// does not rate them, and of what a person put together.
  std::optional<float> confidence;
};

/// The one with that id; null: none has it.
const InstanceSummary* find_instance(std::span<const InstanceSummary> instances, InstanceId id);

/// Sets its points, box and centroid.
void describe(const SurfaceExtent& extent, InstanceSummary& summary);
/// Gives it that box, in which its centroid then lies.
void give_box(const Eigen::AlignedBox3f& box, InstanceSummary& summary);

/// Gathers every instance's geometry by one pass over the map. Ordered by id.
std::vector<InstanceSummary> summarize_instances(const VoxelMap& map,
                                                 const InstanceRegistry& registry,
                                                 const InstanceSummaryConfig& config);
/// The same of a map that is measured already. `forest`: the map's. `corrected`: what people named
/// or put right, which stays however unsure masks are of it: they saw that it is something.
std::vector<InstanceSummary> summarize_instances(const SurfaceExtents& extents,
                                                 const LabelForest& forest,
                                                 const InstanceRegistry& registry,
                                                 const InstanceSummaryConfig& config,
                                                 const std::set<InstanceId>& corrected = {});

/// Fills box, centroid and points of instances that name their super-points (roots).
void measure_instances(const VoxelMap& map, std::vector<InstanceSummary>& instances);
void measure_instances(const SurfaceExtents& extents, std::vector<InstanceSummary>& instances);

}  // namespace ovimap
