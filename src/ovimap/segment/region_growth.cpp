// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/region_growth.h"

#include <limits>
#include <vector>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/segment/task_rows.h"

namespace ovimap {

namespace {

constexpr std::uint32_t kNoSeed = std::numeric_limits<std::uint32_t>::max();

/// What may still change at a pixel.
enum State : std::uint8_t {
  kClosed = 0,  ///< no depth, or in a region for long
  kOpen = 1,    ///< has depth and no region
  kFresh = 2,   ///< joined a region in the last ring
};

/// Open pixels with a fresh one beside them: only they can find a seed that they had not before.
OVIMAP_VECTORIZE void find_candidates(const std::uint8_t* above, const std::uint8_t* here,
                                      const std::uint8_t* below, int width,
                                      std::uint8_t* candidates) {
  for (int x = 1; x < width - 1; ++x) {
    const int around = above[x - 1] | above[x] | above[x + 1] | here[x - 1] | here[x + 1] |
                       below[x - 1] | below[x] | below[x + 1];
    candidates[x] = static_cast<std::uint8_t>((around >> 1) & here[x] & 1);
  }
}

/// Grows all regions at once, ring by ring. Each pixel remembers the interior pixel it grew from.
class Growth {
 public:
  Growth(const DepthSurface& surface, const PinholeCamera& camera, const SegmentDepthConfig& config,
         Image<std::uint32_t>& labels)
      : depth_(surface.smooth_depth_m),
        camera_(camera),
        farthest_squared_(config.regrow_m * config.regrow_m),
        labels_(labels),
        seeds_(labels.width(), labels.height()),
        states_(labels.width() + 2, labels.height() + 2) {
    parallel_for(
        static_cast<std::size_t>(labels.height()), kPixelRowsPerTask, [&](std::size_t row) {
          const int y = static_cast<int>(row);
          const std::uint32_t* label = labels_.row(y);
          std::uint32_t* seed = seeds_.row(y);
          std::uint8_t* state = states_.row(y + 1) + 1;
          for (int x = 0; x < labels_.width(); ++x) {
            seed[x] = label[x] ? static_cast<std::uint32_t>(y * labels_.width() + x) : kNoSeed;
            state[x] = label[x] ? kFresh : depth_.at(x, y) > 0.f ? kOpen : kClosed;
          }
        });
  }

  /// One ring further; returns whether anything grew.
  bool grow() {
    const auto rows = static_cast<std::size_t>(labels_.height());
    std::vector<std::vector<Grown>> grown((rows + kPixelRowsPerTask - 1) / kPixelRowsPerTask);
    parallel_for_ranges(rows, kPixelRowsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y)
        grow_row(static_cast<int>(y), grown[begin / kPixelRowsPerTask]);
    });
    close_fresh();
    last_ring_.clear();
    for (const std::vector<Grown>& part : grown) {
      for (const Grown& pixel : part) {
        seeds_[pixel.pixel] = pixel.seed;
        labels_[pixel.pixel] = labels_[pixel.seed];
        state(pixel.pixel) = kFresh;
      }
      last_ring_.insert(last_ring_.end(), part.begin(), part.end());
    }
    return !last_ring_.empty();
  }

 private:
  struct Grown {
    std::uint32_t pixel, seed;
  };

  std::uint8_t& state(std::uint32_t pixel) {
    const auto width = static_cast<std::uint32_t>(labels_.width());
    return states_.at(static_cast<int>(pixel % width) + 1, static_cast<int>(pixel / width) + 1);
  }

  /// Fresh pixels have given what they had.
  void close_fresh() {
    if (last_ring_.empty())  // before the first ring all interior pixels are fresh
      parallel_for(states_.size(), kPixelRowsPerTask * 1024,
                   [&](std::size_t i) { states_[i] &= kOpen; });
    for (const Grown& last : last_ring_) state(last.pixel) = kClosed;
  }

  void grow_row(int y, std::vector<Grown>& grown) const {
    const int width = labels_.width();
    std::vector<std::uint8_t> candidates(static_cast<std::size_t>(width) + 2);
    find_candidates(states_.row(y), states_.row(y + 1), states_.row(y + 2), width + 2,
                    candidates.data());
    for (int x = 0; x < width; ++x) {
      if (!candidates[static_cast<std::size_t>(x) + 1]) continue;
      const std::uint32_t seed = nearest_seed(x, y);
      if (seed != kNoSeed) grown.push_back({static_cast<std::uint32_t>(y * width + x), seed});
    }
  }

  Eigen::Vector3f point(int x, int y) const {
    return camera_.unproject(static_cast<float>(x), static_cast<float>(y), depth_.at(x, y));
  }

  std::uint32_t nearest_seed(int x, int y) const {
    const auto width = static_cast<std::uint32_t>(labels_.width());
    const Eigen::Vector3f here = point(x, y);
    float nearest = farthest_squared_;
    std::uint32_t result = kNoSeed;
    for (int ny = y - 1; ny <= y + 1; ++ny) {
      for (int nx = x - 1; nx <= x + 1; ++nx) {
        if (!seeds_.contains(nx, ny) || seeds_.at(nx, ny) == kNoSeed) continue;
        const std::uint32_t seed = seeds_.at(nx, ny);
        const float distance =
            (point(static_cast<int>(seed % width), static_cast<int>(seed / width)) - here)
                .squaredNorm();
        if (distance < nearest) nearest = distance, result = seed;
      }
    }
    return result;
  }

  const Image<float>& depth_;
  const PinholeCamera& camera_;
  float farthest_squared_;
  Image<std::uint32_t>& labels_;
  Image<std::uint32_t> seeds_;
  Image<std::uint8_t> states_;  ///< with a border of closed pixels
  std::vector<Grown> last_ring_;
};

}  // namespace

void grow_regions(const DepthSurface& surface, const PinholeCamera& camera,
                  const SegmentDepthConfig& config, Image<std::uint32_t>& labels) {
  if (config.regrow_px == 0) return;
  Growth growth(surface, camera, config, labels);
  for (int ring = 0; ring < config.regrow_px && growth.grow(); ++ring) continue;
}

}  // namespace ovimap
