// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/fusion/free_space.h"

#include <algorithm>
#include <array>
#include <bit>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/map/fusion/block_update.h"
#include "ovimap/map/fusion/projected_row.h"
#include "ovimap/map/fusion/seen_ahead.h"

namespace ovimap {

namespace {

constexpr std::size_t kClearedBlocksPerTask = 16;

/// The voxels of a block that a frame sees through: a byte for each row along x.
struct Doubted {
  std::array<std::uint8_t, kBlockVoxels / kBlockSide> rows{};
  int voxels = 0;
  float image_px = 0;  ///< of the image that their surface takes
};

/// `furthest_m`: BlockAhead::free_m. Voxels are read last, where they lie before what is free: that
/// takes longer than to find out.
OVIMAP_VECTORIZE void find_doubted(const FusionView& view, const Image<float>& free_m,
                                   float furthest_m, const VoxelBlock& block, Doubted& result) {
  const Eigen::Vector3f origin = view.block_origin(block.index);
  const Eigen::Matrix3f& steps = view.voxel_steps;
  const Floats surface = broadcast(view.to_tsdf / view.voxels_per_m);  // one voxel, as stored
  ProjectedRow row;
  for (std::uint64_t rows = block.observed_rows; rows != 0; rows &= rows - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rows));
    const float y = static_cast<float>(i % kBlockSide), z = static_cast<float>(i / kBlockSide);
    const Eigen::Vector3f start = origin + steps.col(1) * y + steps.col(2) * z;
    if (std::min(start.z(), start.z() + (kLanes - 1) * steps(2, 0)) >= furthest_m) continue;
    project(view.camera, start, steps, row);
    const Ints before = row.inside & (row.z_m < gather(free_m.data(), row.pixel));
    if (!any(before)) continue;
    const Floats distance = load_integers(block.tsdf.data() + i * kBlockSide);
    const Ints through = before & (distance < surface) & (distance != 0.f);
    if (!any(through)) continue;
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!through[lane]) continue;
      result.rows[i] = static_cast<std::uint8_t>(result.rows[i] | 1u << lane);
      if (distance[lane] > -surface[lane])  // one of the two layers that a surface has
        result.image_px += 0.5f / (row.z_m[lane] * row.z_m[lane]);
    }
    result.voxels += std::popcount(result.rows[i]);
  }
  result.image_px *= view.camera.fx * view.camera.fy / (view.voxels_per_m * view.voxels_per_m);
}

/// Returns how many voxels went.
std::size_t doubt(const Doubted& doubted, int frames, VoxelBlock& block) {
  std::size_t gone = 0;
  block.doubts.resize(kBlockVoxels);
  for (std::size_t row = 0; row < doubted.rows.size(); ++row)
    for (unsigned bits = doubted.rows[row]; bits != 0; bits &= bits - 1) {
      const std::size_t voxel = row * kBlockSide + static_cast<std::size_t>(std::countr_zero(bits));
      if (++block.doubts[voxel] < frames) continue;
      block.forget(voxel);
      ++gone;
    }
  if (!block.doubted()) block.doubts = {};
  return gone;
}

}  // namespace

void list_fields(FreeSpaceConfig& config, ConfigFields& fields) {
  fields.add("enabled", config.enabled, "whether surface goes that frames see through");
  fields.add("frames", config.frames, 1, 255,
             "so many frames on end must see through a surface, and none see it");
  fields.add("margin_voxels", config.margin_voxels, 1.f, 100.f,
             "nothing goes that is nearer to the plane that is seen, voxels");
  fields.add("sigmas", config.sigmas, 0.f, 100.f,
             "the same along the ray, standard deviations of the depth");
  fields.add("least_slope", config.least_slope, 0.01f, 1.f,
             "metres off a plane per metre of depth: what is seen at more of a slant takes "
             "nothing away");
  fields.add("unknown_slope", config.unknown_slope, 0.01f, 1.f,
             "that of planes that are not known");
  fields.add("guard_px", config.guard_px, 1, 64,
             "all rays so far around, up to twice as far, must see through as well, pixels");
  fields.add("holes", config.holes, 0.f, 1.f,
             "where a larger share of those has no depth, nothing goes");
  fields.add("least_step_m", config.least_step_m, 0.f, 10.f,
             "frames count as several when the camera has moved this far in between, metres");
  fields.add("least_turn_rad", config.least_turn_rad, 0.f, 3.f, "or turned this far, radians");
}

ClearedSpace clear_free_space(VoxelMap& map, const Observation& observation,
                              const FreeSpaceConfig& config) {
  ClearedSpace result;
  if (!config.enabled || observation.sigma_m == nullptr || map.block_count() == 0) return result;
  Image<float> made;
  const Image<float>& free_m = free_depth(map.config(), observation, config, made);
  const FusionView view(map.config(), observation);
  const std::vector<BlockAhead> ahead = blocks_ahead(map, observation, free_m);
  std::vector<Doubted> doubted(ahead.size());
  parallel_for(ahead.size(), kClearedBlocksPerTask, [&](std::size_t i) {
    find_doubted(view, free_m, ahead[i].free_m, map.block(ahead[i].slot), doubted[i]);
  });
  double contradicted_px = 0;
  for (const Doubted& block : doubted) contradicted_px += static_cast<double>(block.image_px);
  if (contradicted_px > 0 && contradicted_px > confirmed_px(map, observation)) {
    result.refused = true;
    return result;
  }
  std::vector<std::size_t> gone(ahead.size());
  parallel_for(ahead.size(), kClearedBlocksPerTask, [&](std::size_t i) {
    if (doubted[i].voxels > 0)
      gone[i] = doubt(doubted[i], config.frames, map.writable_block(ahead[i].slot));
  });
  for (std::size_t i = 0; i < ahead.size(); ++i) {
    if (doubted[i].voxels == 0) continue;
    result.slots.push_back(ahead[i].slot);
    result.doubted += static_cast<std::size_t>(doubted[i].voxels);
    result.cleared += gone[i];
  }
  return result;
}

std::vector<std::uint32_t> clear_blocks(VoxelMap& map, const Observation& observation,
                                        const Image<float>& free_m,
                                        std::span<const std::uint32_t> slots) {
  const FusionView view(map.config(), observation);
  const float furthest_m = *std::max_element(free_m.begin(), free_m.end());
  std::vector<Doubted> doubted(slots.size());
  parallel_for(slots.size(), kClearedBlocksPerTask, [&](std::size_t i) {
    find_doubted(view, free_m, furthest_m, map.block(slots[i]), doubted[i]);
    if (doubted[i].voxels > 0) doubt(doubted[i], 1, map.writable_block(slots[i]));
  });
  std::vector<std::uint32_t> changed;
  for (std::size_t i = 0; i < slots.size(); ++i)
    if (doubted[i].voxels > 0) changed.push_back(slots[i]);
  return changed;
}

bool SeparateLooks::next(const Pose& world_from_camera, const FreeSpaceConfig& config) {
  if (last_) {
    const Pose moved = last_->inverse() * world_from_camera;
    if (moved.translation().norm() < static_cast<double>(config.least_step_m) &&
        Eigen::AngleAxisd(moved.linear()).angle() < static_cast<double>(config.least_turn_rad))
      return false;
  }
  last_ = world_from_camera;
  return true;
}

}  // namespace ovimap
