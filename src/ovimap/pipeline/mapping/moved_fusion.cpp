// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/moved_fusion.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/map/fusion/seen_ahead.h"

namespace ovimap {

namespace {

/// Up to which depth a frame may change the map along each pixel's ray: the far end of its bands.
/// They end within a voxel, and so does what keeping the frame made of its depth. Without an
/// estimate of the deviation the widest band there is is meant.
Image<float> reach_of(DepthImage depth, const Image<float>* sigma_m, const VoxelMapConfig& map) {
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] <= 0.f) continue;
    const float band = sigma_m ? std::min(kBandSigmas * (*sigma_m)[i], kMostBand_m) : kMostBand_m;
    depth[i] += std::max(band, map.truncation_m()) + map.voxel_size_m;
  }
  return depth;
}

/// What frames that moved may have changed, and which others show the same.
class MovedSpace {
 public:
  MovedSpace(const VoxelMap& map, const MapperConfig& config, const PinholeCamera& camera)
      : map_(map), config_(config), camera_(camera), blocks_(map.block_count()) {}

  /// From where a kept frame was and from where it is.
  void add(const KeptFrame& kept, const Pose& before, const Pose& after) {
    const DepthEstimate estimate = PreparedKept(kept, config_, camera_).estimate;
    const Image<float> reach = reach_of(
        estimate.depth_m, estimate.sigma_m.empty() ? nullptr : &estimate.sigma_m, map_.config());
    add(reach, before);
    add(reach, after);
  }
  /// Of a frame that is not kept, from where it was. `like`: the kept one before it; null: none is.
  void add_unkept(const KeptFrame* like, const Pose& before) {
    float furthest_m = config_.max_range_m;
    if (like) {
      const Image<float> reach =
          reach_of(decode_kept_depth(*like, camera_), nullptr, map_.config());
      furthest_m = *std::max_element(reach.begin(), reach.end());
    }
    add(Image<float>(camera_.width, camera_.height, furthest_m), before);
  }

  /// Whether a kept frame may change any of it.
  bool shown_by(const KeptFrame& kept, const Pose& world_from_camera) const {
    const Image<float> reach = reach_of(decode_kept_depth(kept, camera_), nullptr, map_.config());
    return !blocks_ahead(map_, view(reach, world_from_camera, &blocks_), reach).empty();
  }

  const BlockChoice& blocks() const { return blocks_; }

 private:
  Observation view(const Image<float>& reach, const Pose& world_from_camera,
                   const BlockChoice* blocks) const {
    return {.depth = reach,
            .camera = camera_,
            .world_from_camera = world_from_camera,
            .blocks = blocks};
  }
  void add(const Image<float>& reach, const Pose& world_from_camera) {
    for (const BlockAhead& block :
         blocks_ahead(map_, view(reach, world_from_camera, nullptr), reach))
      blocks_.add(block.slot);
  }

  const VoxelMap& map_;
  const MapperConfig& config_;
  PinholeCamera camera_;
  BlockChoice blocks_;
};

/// The frames that moved, and those that are looks of their own by now, or no longer.
std::vector<std::uint8_t> changed_frames(const KeptFrames& kept, const PoseChange& change,
                                         const FreeSpaceConfig& config) {
  std::vector<std::uint8_t> changed = change.moved;
  SeparateLooks before, after;
  for (const auto& [position, frame] : kept) {
    const bool was = before.next(change.before[position], config),
               is = after.next(change.after[position], config);
    if (was != is) changed[position] = 1;
  }
  return changed;
}

/// Calls `work`, and says of what it throws which frame was at fault.
template <class Work>
auto at_frame(std::size_t position, const Work& work) {
  try {
    return work();
  } catch (const Error& fault) {
    throw Error(concat("the kept frame ", position, " cannot be fused again (", fault.what(),
                       "); map the recording anew"));
  }
}

MovedSpace moved_space(const VoxelMap& map, const KeptFrames& kept, const PoseChange& change,
                       const std::vector<std::uint8_t>& changed, const MapperConfig& config,
                       const PinholeCamera& camera) {
  MovedSpace space(map, config, camera);
  auto next = kept.begin();
  const KeptFrame* last = nullptr;
  for (std::size_t position = 0; position < changed.size(); ++position) {
    const bool is_kept = next != kept.end() && next->first == position;
    if (is_kept) last = next++->second.get();
    if (changed[position] == 0) continue;
    at_frame(position, [&] {
      if (is_kept)
        space.add(*last, change.before[position], change.after[position]);
      else
        space.add_unkept(last, change.before[position]);
    });
  }
  return space;
}

}  // namespace

PoseChange change_of(std::vector<Pose> fused_from, const std::vector<Pose>& poses, double still_m,
                     double at_m) {
  OVIMAP_ASSERT(fused_from.size() == poses.size());
  PoseChange change{std::move(fused_from), poses, std::vector<std::uint8_t>(poses.size(), 0)};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose between = change.before[i].inverse() * poses[i];
    const double turned_rad = Eigen::AngleAxisd(between.linear()).angle();
    change.moved[i] = between.translation().norm() + 2 * std::sin(turned_rad / 2) * at_m > still_m;
    if (change.moved[i] == 0) change.after[i] = change.before[i];
  }
  return change;
}

FusedAgain fuse_moved(VoxelMap& map, const KeptFrames& kept, const PoseChange& change,
                      const MapperConfig& config, const PinholeCamera& camera,
                      const std::function<void(std::size_t, std::size_t)>& progress) {
  FusedAgain result;
  result.moved = static_cast<std::size_t>(std::count(change.moved.begin(), change.moved.end(), 1));
  const std::vector<std::uint8_t> changed = changed_frames(kept, change, config.free_space);
  const MovedSpace space = moved_space(map, kept, change, changed, config, camera);
  map.empty_blocks(space.blocks());
  KeptFusion fusion(config, camera);
  std::size_t done = 0;
  for (const auto& entry : kept) {  // no binding: Clang before 16 captures none
    const std::size_t position = entry.first;
    const KeptFrame& frame = *entry.second;
    const Pose& pose = change.after[position];
    at_frame(position, [&] {
      if (changed[position] == 0 && !space.shown_by(frame, pose)) return fusion.pass(pose);
      map.note_changes(fusion.fuse(frame, pose, map, &space.blocks()));
      map.trim();
      ++result.frames;
    });
    if (progress) progress(++done, kept.size());
  }
  result.slots = map.ordered_slots();
  std::erase_if(result.slots, [&](std::uint32_t slot) { return !space.blocks().contains(slot); });
  result.looks = fusion.looks();
  return result;
}

}  // namespace ovimap
