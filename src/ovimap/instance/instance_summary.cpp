// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_summary.h"

#include <algorithm>
#include <map>
#include <span>

#include "ovimap/base/config.h"
#include "ovimap/instance/entity_fits.h"

namespace ovimap {

namespace {

/// What masks hardly show as a thing of its own is a leftover of something larger.
bool is_object(const InstanceSummary& summary, const InstanceSummaryConfig& config,
               const std::set<InstanceId>& corrected) {
  if (summary.points < static_cast<std::size_t>(config.min_instance_voxels)) return false;
  if (summary.confidence)
    return *summary.confidence >= config.min_confidence || corrected.contains(summary.id);
  return summary.views >= config.min_instance_views;
}

bool is_any_rated(const EntitySightings& sightings) {
  for (const auto& [root, seen] : sightings)
    if (std::any_of(seen.begin(), seen.end(), [](const auto& one) { return one.is_rated(); }))
      return true;
  return false;
}

}  // namespace

void describe(const SurfaceExtent& extent, InstanceSummary& summary) {
  summary.points = extent.points;
  summary.box = extent.box;
  if (extent.points > 0)
    summary.centroid = (extent.sum / static_cast<double>(extent.points)).cast<float>();
}

const InstanceSummary* find_instance(std::span<const InstanceSummary> instances, InstanceId id) {
  const auto found = std::ranges::find(instances, id, &InstanceSummary::id);
  return found == instances.end() ? nullptr : &*found;
}

void give_box(const Eigen::AlignedBox3f& box, InstanceSummary& summary) {
  summary.box = box;
  summary.centroid = summary.centroid.cwiseMax(box.min()).cwiseMin(box.max());
}

void list_fields(InstanceSummaryConfig& config, ConfigFields& fields) {
  fields.add("min_instance_voxels", config.min_instance_voxels, 0, 100000000,
             "instances with fewer surface voxels are left out");
  fields.add("min_instance_views", config.min_instance_views, 0, 1000000,
             "instances seen in fewer frames are left out, where nobody rates the masks");
  fields.add("min_confidence", config.min_confidence, 0.f, 1.f,
             "instances that rated masks show less surely as one thing are left out; one frame "
             "whose mask fits by half, times how its source rates it, has 1/6");
  fields.add("min_part_views", config.min_part_views, 1, 1000000,
             "parts of objects that fewer frames tell from the rest of it are left out");
  fields.add("max_part_share", config.max_part_share, 0.f, 1.f,
             "so are parts that are more than this share of their object");
}

std::vector<InstanceSummary> summarize_instances(const VoxelMap& map,
                                                 const InstanceRegistry& registry,
                                                 const InstanceSummaryConfig& config) {
  return summarize_instances(surface_extents(map), map.labels(), registry, config);
}

std::vector<InstanceSummary> summarize_instances(const SurfaceExtents& extents,
                                                 const LabelForest& forest,
                                                 const InstanceRegistry& registry,
                                                 const InstanceSummaryConfig& config,
                                                 const std::set<InstanceId>& corrected) {
  const std::vector<InstanceId> instance_of = registry.instance_table(forest);
  std::map<InstanceId, SurfaceExtent> totals;
  for (const auto& [label, extent] : extents)
    if (const InstanceId id = label < instance_of.size() ? instance_of[label] : 0; id != 0)
      totals[id] += extent;
  const EntitySightings& sightings = registry.entity_sightings();
  const bool rated = is_any_rated(sightings);
  const EntityFits fits(extents, sightings);
  std::vector<InstanceSummary> result;
  for (const auto& [id, extent] : totals) {
    InstanceSummary summary;
    summary.id = id;
    summary.views = registry.record(id).views;
    summary.super_points = registry.super_points_of(id);
    describe(extent, summary);
    if (rated) summary.confidence = fits.confidence(summary.super_points);
    if (is_object(summary, config, corrected)) result.push_back(std::move(summary));
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
    totals[found->second] += extent;
  }
  for (std::size_t i = 0; i < instances.size(); ++i) describe(totals[i], instances[i]);
}

}  // namespace ovimap
