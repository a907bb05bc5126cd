// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/map/fusion/integrate.h"
#include "ovimap/map/rays/pixel_rays.h"

namespace ovimap {

namespace {

constexpr std::size_t kDepthRowsPerTask = 32;

void sort_unique(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// Throws Error where blocks lie so far out that their keys would be those of others (pack_index).
void check_reach(const VoxelMapConfig& config, const Pose& world_from_camera) {
  constexpr double kUsed = 0.95;  // the rest is for what the camera sees
  const double reach_m = kUsed * (1 << 20) * static_cast<double>(config.block_size_m()),
               away_m = world_from_camera.translation().cwiseAbs().maxCoeff();
  if (!(away_m < reach_m))
    throw Error(concat("the camera is ", away_m, " m from the origin, and a map of voxels of ",
                       config.voxel_size_m, " m reaches ", reach_m,
                       " m; subtract an offset from all poses, or take larger voxels "
                       "(map.voxel_size_m)"));
}

/// Throws FrameError where memory has no room for the blocks that a frame is fused into.
void check_room(const VoxelMap& map, const std::vector<std::uint64_t>& keys) {
  constexpr std::size_t kMegabyte = 1000000;
  std::size_t blocks = keys.size();  // with a store all others may leave memory
  if (!map.has_store())
    blocks = map.blocks_in_memory() +
             static_cast<std::size_t>(std::count_if(keys.begin(), keys.end(), [&](auto key) {
               return map.find_slot(unpack_index(key)) == kNoBlock;
             }));
  if (blocks <= map.room_bytes() / VoxelBlock::kMostBytes) return;
  throw FrameError(concat("with what the frame shows the map takes ",
                          blocks * VoxelBlock::kMostBytes / kMegabyte, " MB of memory, and ",
                          map.room_bytes() / kMegabyte,
                          " MB are its room; if its depth is not noise, take larger voxels "
                          "(map.voxel_size_m) or bound the memory (--max-memory)"));
}

/// Block keys, with most repetitions left out: neighbouring pixels run through the same blocks.
class KeyCollector {
 public:
  void add(std::uint64_t key) {
    std::uint64_t& recent = recent_[(key ^ key >> 18 ^ key >> 35) % kRecent];
    if (recent == key) return;
    recent = key;
    keys_.push_back(key);
  }
  std::vector<std::uint64_t> take() {
    sort_unique(keys_);
    return std::move(keys_);
  }

 private:
  static constexpr std::size_t kRecent = 512;
  std::array<std::uint64_t, kRecent> recent_{};  // 0 is the key of no block near any origin
  std::vector<std::uint64_t> keys_;
};

/// Collects the blocks that the bands around the points of pixels run through.
class BandBlocks {
 public:
  BandBlocks(const VoxelMapConfig& config, const PinholeCamera& camera,
             const Pose& world_from_camera)
      : rays_(camera, world_from_camera.linear().cast<float>()),
        origin_(world_from_camera.translation().cast<float>()),
        truncation_m_(config.truncation_m()),
        inverse_block_size_(1.f / config.block_size_m()) {
    // Neighbouring sampled pixels may be a quarter of a block apart on the surface. A pixel whose
    // column and row are multiples of 2^k, and not both of 2^(k+1), is left out where every 2^(k+1)
    // pixels are enough.
    const float pitch_m = 0.25f * config.block_size_m() * camera.fx;
    for (int k = 0; k < kMostSkips; ++k) nearest_m_[k] = pitch_m / static_cast<float>(2 << k);
    nearest_m_[kMostSkips] = 0.f;
  }

  /// Blocks within the truncation go to `needed`. Where the deviation is known (else null) those of
  /// wider bands go to `reached`.
  void add_row(const float* depth, const float* sigma, int y, int width, KeyCollector& needed,
               KeyCollector& reached) const {
    float nearest_m[1 << kMostSkips];  // by column, which repeats
    for (int x = 0; x < 1 << kMostSkips; ++x)
      nearest_m[x] =
          nearest_m_[std::min(std::countr_zero(static_cast<unsigned>(x | y)), kMostSkips)];
    for (int x = 0; x < width; ++x) {
      if (!(depth[x] > nearest_m[x % (1 << kMostSkips)])) continue;
      const Eigen::Vector3f ray = rays_.at(x, y);
      add(ray, depth[x], truncation_m_, needed);
      const float band_m = sigma ? std::min(kBandSigmas * sigma[x], kMostBand_m) : 0.f;
      if (band_m > truncation_m_) add(ray, depth[x], band_m, reached);
    }
  }

 private:
  void add(const Eigen::Vector3f& ray, float depth_m, float band_m, KeyCollector& keys) const {
    // Samples at most half a block apart leave out only corners that the ray cuts by less than
    // that; an odd number of them includes the point itself.
    const int half = static_cast<int>(std::ceil(2.f * band_m * inverse_block_size_));
    const Eigen::Vector3f step = ray * (band_m / (ray.norm() * static_cast<float>(half)));
    const Eigen::Vector3f point = origin_ + ray * depth_m;
    for (int i = -half; i <= half; ++i)
      keys.add(pack_index(block_at(point + step * static_cast<float>(i), inverse_block_size_)));
  }

  static constexpr int kMostSkips = 3;  ///< every 2^3 pixels at least
  PixelRays rays_;
  Eigen::Vector3f origin_;
  float truncation_m_, inverse_block_size_;
  float nearest_m_[kMostSkips + 1];  ///< depth from which such a pixel counts, by k
};

/// The keys of parts of an image, each once.
class FrameKeys {
 public:
  explicit FrameKeys(std::size_t parts) : parts_(parts) {}
  void put(std::size_t part, KeyCollector& keys) { parts_[part] = keys.take(); }
  std::vector<std::uint64_t> all() const {
    std::vector<std::uint64_t> keys;
    for (const auto& part : parts_) keys.insert(keys.end(), part.begin(), part.end());
    sort_unique(keys);
    return keys;
  }

 private:
  std::vector<std::vector<std::uint64_t>> parts_;
};

}  // namespace

std::vector<std::uint32_t> allocate_blocks(VoxelMap& map, const Observation& observation) {
  const DepthImage& depth = observation.depth;
  check_reach(map.config(), observation.world_from_camera);
  const BandBlocks band(map.config(), observation.camera, observation.world_from_camera);
  const auto rows = static_cast<std::size_t>(depth.height());
  const std::size_t parts = (rows + kDepthRowsPerTask - 1) / kDepthRowsPerTask;
  FrameKeys needed(parts), reached(parts);
  parallel_for_ranges(rows, kDepthRowsPerTask, [&](std::size_t begin, std::size_t end) {
    KeyCollector needed_here, reached_here;
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      band.add_row(depth.row(y), observation.sigma_m ? observation.sigma_m->row(y) : nullptr, y,
                   depth.width(), needed_here, reached_here);
    needed.put(begin / kDepthRowsPerTask, needed_here);
    reached.put(begin / kDepthRowsPerTask, reached_here);
  });
  const std::vector<std::uint64_t> to_create = needed.all(), to_find = reached.all();
  check_room(map, to_create);
  std::vector<std::uint64_t> keys;
  std::set_union(to_create.begin(), to_create.end(), to_find.begin(), to_find.end(),
                 std::back_inserter(keys));
  std::vector<std::uint32_t> slots;
  slots.reserve(keys.size());
  auto next = to_create.begin();
  for (const std::uint64_t key : keys) {
    const bool create = next != to_create.end() && *next == key;
    next += create;
    const BlockIndex index = unpack_index(key);
    const std::uint32_t slot = create ? map.find_or_create(index) : map.find_slot(index);
    if (slot != kNoBlock && (!observation.blocks || observation.blocks->contains(slot)))
      slots.push_back(slot);
  }
  return slots;
}

}  // namespace ovimap
