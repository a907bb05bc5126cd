// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>

#include "ovimap/base/parallel.h"
#include "ovimap/map/integrate.h"

namespace ovimap {

namespace {

constexpr int kRowsPerTask = 16;
constexpr int kMaxStride = 8;

void sort_unique(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// Collects the blocks that the band around one pixel's point runs through.
class BandBlocks {
 public:
  BandBlocks(const VoxelMapConfig& config, const PinholeCamera& camera,
             const Pose& world_from_camera)
      : camera_(camera),
        rotation_(world_from_camera.linear().cast<float>()),
        origin_(world_from_camera.translation().cast<float>()),
        truncation_m_(config.truncation_m()),
        inverse_block_size_(1.f / config.block_size_m()),
        // Samples at most half a block apart leave out only corners that the ray cuts by less than
        // that; an odd number of them includes the point itself.
        samples_(1 + 2 * static_cast<int>(
                             std::ceil(config.truncation_m() / (0.5f * config.block_size_m())))),
        // Neighbouring sampled pixels may be a quarter of a block apart on the surface.
        pitch_m_(0.25f * config.block_size_m() * camera.fx) {}

  /// Power-of-two distance between the pixels worth sampling at this depth.
  int stride(float depth_m) const {
    const int pixels = std::clamp(static_cast<int>(pitch_m_ / depth_m), 1, kMaxStride);
    return static_cast<int>(std::bit_floor(static_cast<unsigned>(pixels)));
  }

  void add(int x, int y, float depth_m, std::vector<std::uint64_t>& keys) const {
    const Eigen::Vector3f ray =
        camera_.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
    const Eigen::Vector3f direction = rotation_ * ray.normalized();
    const Eigen::Vector3f start = origin_ + direction * (depth_m * ray.norm() - truncation_m_);
    const Eigen::Vector3f step =
        direction * (2.f * truncation_m_ / static_cast<float>(samples_ - 1));
    for (int i = 0; i < samples_; ++i) {
      const std::uint64_t key =
          pack_index(block_at(start + step * static_cast<float>(i), inverse_block_size_));
      if (keys.empty() || keys.back() != key) keys.push_back(key);
    }
  }

 private:
  const PinholeCamera& camera_;
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f origin_;
  float truncation_m_, inverse_block_size_;
  int samples_;
  float pitch_m_;
};

}  // namespace

std::vector<std::uint32_t> allocate_blocks(VoxelMap& map, const DepthImage& depth,
                                           const PinholeCamera& camera,
                                           const Pose& world_from_camera) {
  const BandBlocks band(map.config(), camera, world_from_camera);
  const auto tasks = static_cast<std::size_t>((depth.height() + kRowsPerTask - 1) / kRowsPerTask);
  std::vector<std::vector<std::uint64_t>> keys(tasks);
  parallel_for(tasks, 1, [&](std::size_t task) {
    const int first = static_cast<int>(task) * kRowsPerTask;
    for (int y = first; y < std::min(first + kRowsPerTask, depth.height()); ++y) {
      for (int x = 0; x < depth.width(); ++x) {
        const float z = depth.at(x, y);
        if (z <= 0.f) continue;
        const int mask = band.stride(z) - 1;
        if (((x | y) & mask) == 0) band.add(x, y, z, keys[task]);
      }
    }
    sort_unique(keys[task]);
  });
  std::vector<std::uint64_t> all;
  for (const auto& part : keys) all.insert(all.end(), part.begin(), part.end());
  sort_unique(all);
  std::vector<std::uint32_t> slots(all.size());
  std::transform(all.begin(), all.end(), slots.begin(),
                 [&map](std::uint64_t key) { return map.find_or_create(unpack_index(key)); });
  return slots;
}

}  // namespace ovimap
