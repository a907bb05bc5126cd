// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/region_growth.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/image/set_bytes.h"
#include "ovimap/segment/task_rows.h"

namespace ovimap {

namespace {

constexpr std::uint32_t kNoSeed = std::numeric_limits<std::uint32_t>::max();

/// What may still change at a pixel.
enum State : std::uint8_t {
  kClosed = 0,  ///< no depth, or in a region
  kOpen = 1,    ///< has depth and no region
  kSeed = 2,    ///< in a region from the first
  kAsked = 4,   ///< open, and asked in this ring
};

/// Seeds and states of a row that starts at pixel `first`.
OVIMAP_VECTORIZE void start_row(const std::uint32_t* labels, const float* depth,
                                std::uint32_t first, int width, std::uint32_t* seeds,
                                std::uint8_t* states) {
  OVIMAP_NO_OVERLAP
  for (int x = 0; x < width; ++x) {
    const bool in_region = labels[x] != 0;
    seeds[x] = in_region ? first + static_cast<std::uint32_t>(x) : kNoSeed;
    const int open = depth[x] > 0.f ? kOpen : kClosed;
    states[x] = static_cast<std::uint8_t>(in_region ? kSeed : open);
  }
}

/// Open pixels with a seed beside them.
OVIMAP_VECTORIZE void find_border(const std::uint8_t* above, const std::uint8_t* here,
                                  const std::uint8_t* below, int width, std::uint8_t* border) {
  for (int x = 1; x < width - 1; ++x) {
    const int around = above[x - 1] | above[x] | above[x + 1] | here[x - 1] | here[x + 1] |
                       below[x - 1] | below[x] | below[x + 1];
    border[x] = static_cast<std::uint8_t>((around >> 1) & here[x] & 1);
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
        seeds_(Image<std::uint32_t>::unset(labels.width(), labels.height())),
        states_(labels.width() + 2, labels.height() + 2) {
    const auto rows = static_cast<std::size_t>(labels.height());
    parallel_for(rows, kPixelRowsPerTask, [&](std::size_t row) {
      const int y = static_cast<int>(row), width = labels_.width();
      start_row(labels_.row(y), depth_.row(y), static_cast<std::uint32_t>(y * width), width,
                seeds_.row(y), states_.row(y + 1) + 1);
    });
    std::vector<std::vector<std::uint32_t>> parts((rows + kPixelRowsPerTask - 1) /
                                                  kPixelRowsPerTask);
    parallel_for(rows, kPixelRowsPerTask, [&](std::size_t y) {
      add_border(static_cast<int>(y), parts[y / kPixelRowsPerTask]);
    });
    for (const std::vector<std::uint32_t>& part : parts)
      candidates_.insert(candidates_.end(), part.begin(), part.end());
  }

  /// One ring further; returns whether anything grew.
  bool grow() {
    std::vector<std::uint32_t> found(candidates_.size());
    parallel_for(candidates_.size(), kPixelsPerTask,
                 [&](std::size_t i) { found[i] = nearest_seed(candidates_[i]); });
    std::vector<std::uint32_t> grown;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const std::uint32_t pixel = candidates_[i];
      state(pixel) &= kOpen;
      if (found[i] == kNoSeed) continue;
      seeds_[pixel] = found[i];
      labels_[pixel] = labels_[found[i]];
      state(pixel) = kClosed;
      grown.push_back(pixel);
    }
    find_candidates(grown);
    return !grown.empty();
  }

 private:
  static constexpr std::size_t kPixelsPerTask = 2000;

  int x_of(std::uint32_t pixel) const { return static_cast<int>(pixel) % labels_.width(); }
  int y_of(std::uint32_t pixel) const { return static_cast<int>(pixel) / labels_.width(); }
  std::uint8_t& state(std::uint32_t pixel) { return states_.at(x_of(pixel) + 1, y_of(pixel) + 1); }

  void add_border(int y, std::vector<std::uint32_t>& candidates) const {
    const int width = labels_.width();
    std::vector<std::uint8_t> border(static_cast<std::size_t>(width) + 2);
    find_border(states_.row(y), states_.row(y + 1), states_.row(y + 2), width + 2, border.data());
    for_each_set(border.data() + 1, width,
                 [&](int x) { candidates.push_back(static_cast<std::uint32_t>(y * width + x)); });
  }

  /// Open pixels beside those that grew: only they can find a seed that they had not before.
  void find_candidates(const std::vector<std::uint32_t>& grown) {
    candidates_.clear();
    for (const std::uint32_t pixel : grown) {
      const int x = x_of(pixel), y = y_of(pixel);
      for (int dy = -1; dy <= 1; ++dy) {
        std::uint8_t* states = states_.row(y + 1 + dy) + x;
        for (int dx = 0; dx <= 2; ++dx) {
          if (states[dx] != kOpen) continue;
          states[dx] |= kAsked;
          candidates_.push_back(
              static_cast<std::uint32_t>((y + dy) * labels_.width() + x + dx - 1));
        }
      }
    }
  }

  Eigen::Vector3f point(int x, int y) const {
    return camera_.unproject(static_cast<float>(x), static_cast<float>(y), depth_.at(x, y));
  }

  std::uint32_t nearest_seed(std::uint32_t pixel) const {
    const int x = x_of(pixel), y = y_of(pixel);
    const Eigen::Vector3f here = point(x, y);
    float nearest = farthest_squared_;
    std::uint32_t result = kNoSeed, last = kNoSeed;
    for (int ny = std::max(0, y - 1); ny <= std::min(y + 1, labels_.height() - 1); ++ny) {
      for (int nx = std::max(0, x - 1); nx <= std::min(x + 1, labels_.width() - 1); ++nx) {
        const std::uint32_t seed = seeds_.at(nx, ny);
        if (seed == kNoSeed || seed == last) continue;
        last = seed;  // neighbours often have one seed
        const float distance = (point(x_of(seed), y_of(seed)) - here).squaredNorm();
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
  std::vector<std::uint32_t> candidates_;
};

}  // namespace

void grow_regions(const DepthSurface& surface, const PinholeCamera& camera,
                  const SegmentDepthConfig& config, Image<std::uint32_t>& labels) {
  if (config.regrow_px == 0) return;
  Growth growth(surface, camera, config, labels);
  for (int ring = 0; ring < config.regrow_px && growth.grow(); ++ring) continue;
}

}  // namespace ovimap
