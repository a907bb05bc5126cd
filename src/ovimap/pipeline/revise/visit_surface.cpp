// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/visit_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "ovimap/instance/object_boxes.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {

namespace {

constexpr std::size_t kLeastPoints = 10;  // of an object's surface: fewer are a stray look at it
constexpr std::uint32_t kBlocksPerPart = 4096;  // then maps may make room

/// The colour of the voxel at a point, sRGB; all 0 where it has none.
std::array<std::uint8_t, 3> color_at(VoxelFinder& finder, const Eigen::Vector3f& point) {
  if (!finder.seek(point)) return {};
  return color_levels(finder.block().color[static_cast<std::size_t>(finder.voxel())]);
}

/// Whether a voxel is as the visit found it. Supports of labels say no more than its distance.
bool is_untouched(const VoxelBlock& was, const VoxelBlock& is, std::size_t v) {
  return was.tsdf[v] == is.tsdf[v] && was.weight[v] == is.weight[v] && was.color[v] == is.color[v];
}

/// The voxels of a block that changed, without labels, which are another map's; whether there are
/// any.
bool keep_touched(const VoxelBlock* was, VoxelBlock& block) {
  bool any = false;
  block.palette = {kNoLabel};
  block.slots = {};
  for (std::size_t v = 0; v < kBlockVoxels; ++v) {
    if (was != nullptr && is_untouched(*was, block, v)) block.forget(v);
    any |= block.weight[v] > 0.f;
  }
  return any;
}

void copy_touched(const VoxelMap& before, const VoxelMap& after, VoxelMap& seen) {
  for (std::uint32_t slot = 0; slot < after.block_count(); ++slot) {
    VoxelBlock block = after.block(slot);
    if (keep_touched(before.find(block.index), block)) {
      const std::uint32_t made = seen.find_or_create(block.index);
      seen.writable_block(made) = std::move(block);
      seen.note_changes(std::span(&made, 1));
    }
    if (slot % kBlocksPerPart != kBlocksPerPart - 1) continue;
    before.trim();
    after.trim();
    seen.trim();
  }
}

/// Drops points where a map has no surface.
void keep_observed(const VoxelMap& map, std::vector<Eigen::Vector3f>& points) {
  VoxelFinder finder(map);
  std::erase_if(points, [&](const Eigen::Vector3f& point) {
    return !finder.seek(point) ||
           finder.block().weight[static_cast<std::size_t>(finder.voxel())] <= 0.f;
  });
}

/// Where things were that are gone, and which voxels were theirs.
class Remains {
 public:
  Remains(const MapDocument& before, const MapDocument& seen, const std::set<InstanceId>& gone,
          MapDocument& after)
      : seen_(seen.map),
        after_(after),
        spacing_m_(surface_spacing_m(after.map.config().voxel_size_m)),
        instance_of_(instances_by_label(after.map, after.instances)) {
    for (const InstanceId id : gone)
      if (const auto was = before.surfaces.find(id); was != before.surfaces.end())
        boxes_[id] = box_without_specks(was->second, spacing_m_);
  }

  void forget() {
    for (std::uint32_t slot = 0; slot < after_.map.block_count(); ++slot)
      if (may_hold_some(after_.map.block_index(slot)) && forget_in(slot))
        after_.map.note_changes(std::span(&slot, 1));
    for (const auto& [id, count] : forgotten_) forget_object(id, count);
    fit_boxes(after_.surfaces, spacing_m_, after_.instances);
  }

 private:
  Eigen::AlignedBox3f box_of(const BlockIndex& index) const {
    const float side_m = after_.map.config().block_size_m();
    const Eigen::Vector3f low = index.cast<float>() * side_m;
    return {low, low + Eigen::Vector3f::Constant(side_m)};
  }

  bool may_hold_some(const BlockIndex& index) const {
    const Eigen::AlignedBox3f block = box_of(index);
    return std::any_of(boxes_.begin(), boxes_.end(),
                       [&](const auto& box) { return box.second.intersects(block); });
  }

  bool forget_in(std::uint32_t slot) {
    const VoxelBlock* seen = seen_.find(after_.map.block_index(slot));
    VoxelBlock& block = after_.map.writable_block(slot);
    bool changed = false;
    for (int v = 0; v < kBlockVoxels; ++v) {
      const auto at = static_cast<std::size_t>(v);
      if (block.weight[at] <= 0.f || (seen != nullptr && seen->weight[at] > 0.f)) continue;
      const Label label = voxel_label(block, v, after_.map.labels());
      const bool surface =
          std::fabs(after_.map.distance_m(block, v)) < after_.map.config().voxel_size_m;
      if (label == kNoLabel ? surface : !boxes_.contains(instance_of_[label])) continue;
      if (label != kNoLabel && surface) ++forgotten_[instance_of_[label]];
      block.forget(at);
      changed = true;
    }
    if (!block.doubted()) block.doubts = {};
    return changed;
  }

  void forget_object(InstanceId id, std::size_t forgotten) {
    const auto found = std::ranges::find(after_.instances, id, &InstanceSummary::id);
    keep_observed(after_.map, after_.surfaces[id]);
    found->points -= std::min(found->points, forgotten);
    if (found->points >= static_cast<std::size_t>(InstanceSummaryConfig{}.min_instance_voxels))
      return;
    after_.surfaces.erase(id);
    after_.instances.erase(found);
  }

  const VoxelMap& seen_;
  MapDocument& after_;
  const float spacing_m_;
  std::vector<InstanceId> instance_of_;  ///< by label
  std::map<InstanceId, Eigen::AlignedBox3f> boxes_;
  std::map<InstanceId, std::size_t> forgotten_;  ///< surface voxels
};

}  // namespace

MapDocument seen_in_visit(const MapDocument& before, const MapDocument& after,
                          std::shared_ptr<BlockStore> store) {
  MapDocument seen;
  seen.map = VoxelMap(after.map.config());
  if (store) seen.map.keep_in(std::move(store));
  copy_touched(before.map, after.map, seen.map);
  seen.frames.assign(after.frames.begin() + after.history.visits.back().first_frame,
                     after.frames.end());
  seen.depth_camera = after.depth_camera;
  seen.up = after.up;
  seen.instances = after.instances;
  seen.surfaces = after.surfaces;
  for (auto& [id, points] : seen.surfaces) {
    keep_observed(seen.map, points);
    seen.map.trim();
  }
  std::erase_if(seen.instances, [&](const InstanceSummary& instance) {
    const auto surface = seen.surfaces.find(instance.id);
    return surface == seen.surfaces.end() || surface->second.size() < kLeastPoints;
  });
  seen.map.trim();
  return seen;
}

void forget_remains(const MapDocument& before, const MapDocument& seen,
                    const std::set<InstanceId>& gone, MapDocument& after) {
  if (!gone.empty()) Remains(before, seen, gone, after).forget();
}

std::shared_ptr<const PastObject> past_of(const MapDocument& map, InstanceId id) {
  const InstanceSummary* instance = find_instance(map.instances, id);
  const auto surface = map.surfaces.find(id);
  if (instance == nullptr || surface == map.surfaces.end() || surface->second.empty())
    return nullptr;
  auto was = std::make_shared<PastObject>(PastObject{instance->centroid,
                                                     instance->points,
                                                     instance->views,
                                                     instance->super_points,
                                                     surface->second,
                                                     {}});
  VoxelFinder finder(map.map);
  for (const Eigen::Vector3f& point : was->surface) was->colors.push_back(color_at(finder, point));
  map.map.trim();
  return was;
}

}  // namespace ovimap
