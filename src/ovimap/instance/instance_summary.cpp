// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_summary.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/map/voxels/block_tiles.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {

namespace {

/// Adds the surface voxels of one block by label.
void add_extents(const VoxelMap& map, const VoxelBlock& block, SurfaceExtents& extents) {
  const float voxel_size = map.config().voxel_size_m;
  for (int v = 0; v < kBlockVoxels; ++v) {
    if (block.weight[static_cast<std::size_t>(v)] <= 0.f ||
        std::fabs(map.distance_m(block, v)) >= voxel_size)
      continue;
    const Label label = voxel_label(block, v, map.labels());
    if (label == kNoLabel) continue;
    const Eigen::Vector3i offset(v & 7, v >> 3 & 7, v >> 6);
    const Eigen::Vector3f center =
        ((block.index * kBlockSide + offset).cast<float>().array() + 0.5f) * voxel_size;
    SurfaceExtent& extent = extents[label];
    ++extent.points;
    extent.sum += center.cast<double>();
    extent.box.extend(center);
  }
}

}  // namespace

void list_fields(InstanceSummaryConfig& config, ConfigFields& fields) {
  fields.add("min_instance_voxels", config.min_instance_voxels, 0, 100000000,
             "instances with fewer surface voxels are left out");
  fields.add("min_instance_views", config.min_instance_views, 0, 1000000,
             "instances seen in fewer frames are left out");
  fields.add("min_part_views", config.min_part_views, 1, 1000000,
             "parts of objects that fewer frames tell from the rest of it are left out");
  fields.add("max_part_share", config.max_part_share, 0.f, 1.f,
             "so are parts that are more than this share of their object");
  fields.add("surface_spacing_m", config.surface_spacing_m, 0.001f, 10.f,
             "between the points of an instance that a map keeps apart from its voxels, metres");
}

SurfaceExtents surface_extents(const VoxelMap& map) {
  SurfaceExtents totals;
  for_each_part(map, [&](std::span<const Tile> tiles) {
    std::vector<SurfaceExtents> extents(tiles.size());
    parallel_for(tiles.size(), 2, [&](std::size_t i) {
      for (const std::uint32_t slot : tiles[i].slots) add_extents(map, map.block(slot), extents[i]);
    });
    for (const SurfaceExtents& of_tile : extents)
      for (const auto& [label, extent] : of_tile) {
        SurfaceExtent& total = totals[label];
        total.points += extent.points;
        total.sum += extent.sum;
        total.box.extend(extent.box);
      }
  });
  return totals;
}

std::vector<InstanceSummary> summarize_instances(const VoxelMap& map,
                                                 const InstanceRegistry& registry,
                                                 const InstanceSummaryConfig& config) {
  return summarize_instances(surface_extents(map), map.labels(), registry, config);
}

std::vector<InstanceSummary> summarize_instances(const SurfaceExtents& extents,
                                                 const LabelForest& forest,
                                                 const InstanceRegistry& registry,
                                                 const InstanceSummaryConfig& config) {
  const std::vector<InstanceId> instance_of = registry.instance_table(forest);
  std::map<InstanceId, InstanceSummary> summaries;
  std::map<InstanceId, Eigen::Vector3d> sums;
  for (const auto& [label, extent] : extents) {
    const InstanceId id = label < instance_of.size() ? instance_of[label] : 0;
    if (id == 0) continue;
    InstanceSummary& summary = summaries[id];
    summary.points += extent.points;
    summary.box.extend(extent.box);
    sums.try_emplace(id, Eigen::Vector3d::Zero()).first->second += extent.sum;
  }
  std::vector<InstanceSummary> result;
  for (auto& [id, summary] : summaries) {
    summary.views = registry.record(id).views;
    summary.super_points = registry.super_points_of(id);
    if (summary.points < static_cast<std::size_t>(config.min_instance_voxels) ||
        summary.views < config.min_instance_views)
      continue;
    summary.id = id;
    summary.centroid = (sums.at(id) / static_cast<double>(summary.points)).cast<float>();
    result.push_back(std::move(summary));
  }
  return result;
}

void measure_instances(const VoxelMap& map, std::vector<InstanceSummary>& instances) {
  measure_instances(surface_extents(map), instances);
}

void measure_instances(const SurfaceExtents& extents, std::vector<InstanceSummary>& instances) {
  std::map<Label, std::size_t> owner;
  for (std::size_t i = 0; i < instances.size(); ++i)
    for (const Label label : instances[i].super_points) owner[label] = i;
  std::vector<SurfaceExtent> totals(instances.size());
  for (const auto& [label, extent] : extents) {
    const auto found = owner.find(label);
    if (found == owner.end()) continue;
    SurfaceExtent& total = totals[found->second];
    total.points += extent.points;
    total.sum += extent.sum;
    total.box.extend(extent.box);
  }
  for (std::size_t i = 0; i < instances.size(); ++i) {
    instances[i].points = totals[i].points;
    instances[i].box = totals[i].box;
    if (totals[i].points > 0)
      instances[i].centroid = (totals[i].sum / static_cast<double>(totals[i].points)).cast<float>();
  }
}

}  // namespace ovimap
