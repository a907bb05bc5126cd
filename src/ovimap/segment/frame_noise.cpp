// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/frame_noise.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/segment/depth_surface.h"

namespace ovimap {

namespace {

constexpr std::size_t kSampleStep = 7;  // pixels; no divisor of usual widths
constexpr std::size_t kSampledRowsPerTask = 120;
constexpr std::uint32_t kFewestSamples = 500;  // for medians good to some per cent
constexpr float kMedianOfNormal = 0.6745f;     // of |x| where sigma is 1
constexpr float kMedianOfAngle = 1.1774f;      // of the length of two of them
constexpr float kLeastScale = 0.02f;           // exact depth still has a last digit
constexpr float kFullWindow = 0.9f;            // of its pixels

/// How often positive numbers occurred, by the first five binary places of each.
class Histogram {
 public:
  void add(float value) { ++counts_[bin_of(value)]; }
  void add(const Histogram& other) {
    for (std::size_t bin = 0; bin < kBins; ++bin) counts_[bin] += other.counts_[bin];
  }
  std::uint32_t size() const { return std::accumulate(counts_.begin(), counts_.end(), 0u); }

  /// To where in its bin it should lie; 0 of nothing.
  float median() const {
    const float half = 0.5f * static_cast<float>(size());
    float below = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      const auto count = static_cast<float>(counts_[bin]);
      if (count > 0 && below + count >= half)
        return std::lerp(least_of(bin), least_of(bin + 1), (half - below) / count);
      below += count;
    }
    return 0;
  }

 private:
  static constexpr int kDropped = 19;  // of a float's 23 places after the first
  static constexpr std::uint32_t kFirst = std::bit_cast<std::uint32_t>(0x1p-10f) >> kDropped;
  static constexpr std::size_t kBins = 320;  // to 2^10

  static std::size_t bin_of(float value) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value) >> kDropped;
    return std::min<std::size_t>(std::max(bits, kFirst) - kFirst, kBins - 1);
  }
  static float least_of(std::size_t bin) {
    return std::bit_cast<float>((static_cast<std::uint32_t>(bin) + kFirst) << kDropped);
  }

  std::array<std::uint32_t, kBins> counts_{};
};

/// Absolute residuals in sigmas of the model, by range.
class Residuals {
 public:
  void add(float depth_m, float sigmas) { by_range_[ByRange::range_of(depth_m)].add(sigmas); }
  void add(const Residuals& other) {
    for (std::size_t range = 0; range < ByRange::kRanges; ++range)
      by_range_[range].add(other.by_range_[range]);
  }

  /// Their medians, which are moved by little but noise, over what they are where sigma is 1.
  /// Nothing where there are too few of them to tell.
  std::optional<ByRange> sigmas(float median_of_one) const {
    Histogram all;
    for (const Histogram& some : by_range_) all.add(some);
    if (all.size() < kFewestSamples) return std::nullopt;
    const auto sigma_of = [&](const Histogram& residuals) {
      return std::max(kLeastScale, residuals.median() / median_of_one);
    };
    ByRange found(sigma_of(all));
    for (std::size_t range = 0; range < ByRange::kRanges; ++range)
      if (by_range_[range].size() >= kFewestSamples) found[range] = sigma_of(by_range_[range]);
    return found;
  }

 private:
  std::array<Histogram, ByRange::kRanges> by_range_;
};

/// What a frame, or some rows of it, tell.
struct Samples {
  Residuals pixels, depths, normals;
  void add(const Samples& other) {
    pixels.add(other.pixels), depths.add(other.depths), normals.add(other.normals);
  }
};

/// Marks the pixels of a row whose windows are whole enough and hold a plane.
OVIMAP_VECTORIZE void mark_full(const DepthSurface& surface, int y, int fewest_px, int width,
                                std::uint8_t* full) {
  const std::uint8_t *left = surface.left_px.row(y), *right = surface.right_px.row(y);
  const std::uint8_t *up = surface.up_px.row(y), *down = surface.down_px.row(y);
  const float* slope = surface.plane_slope.row(y);
  OVIMAP_NO_OVERLAP
  for (int x = 0; x < width; ++x) {
    const int columns = left[x] + right[x] + 1, rows = up[x] + down[x] + 1;
    full[x] = (slope[x] > 0.f) & (columns * rows >= fewest_px);
  }
}

class Sampler {
 public:
  Sampler(const DepthImage& depth, const DepthSurface& surface, const PinholeCamera& camera,
          const DepthNoiseConfig& model)
      : depth_(depth),
        surface_(surface),
        model_(model),
        side_px_(2 * surface.radius_px + 1),
        normal_per_pixel_(normal_sigma_rad(1.f, surface.radius_px, camera, model) /
                          model.sigma_m(1.f)),
        full_(Image<std::uint8_t>::unset(depth.width(), depth.height())) {
    const auto fewest_px = static_cast<int>(kFullWindow * static_cast<float>(side_px_ * side_px_));
    parallel_for(static_cast<std::size_t>(depth.height()), kSampledRowsPerTask,
                 [&](std::size_t row) {
                   const int y = static_cast<int>(row);
                   mark_full(surface_, y, fewest_px, depth_.width(), full_.row(y));
                 });
  }

  /// Of the rows [begin, end).
  void sample(std::size_t begin, std::size_t end, Samples& samples) const {
    const auto width = static_cast<std::size_t>(depth_.width());
    for (std::size_t i = next_multiple(begin * width, kSampleStep); i < end * width;
         i += kSampleStep)
      compare_pixel(i, samples);
    const int step = std::max(1, surface_.radius_px / 2);
    for (int y = next_multiple(static_cast<int>(begin), step); y < static_cast<int>(end); y += step)
      for (int x = 0; x < depth_.width(); x += step) {
        compare(x, y, 1, 0, samples);
        compare(x, y, 0, 1, samples);
      }
  }

 private:
  template <class Integer>
  static Integer next_multiple(Integer from, Integer of) {
    return (from + of - 1) / of * of;
  }

  void compare_pixel(std::size_t i, Samples& samples) const {
    if (depth_[i] <= 0.f || surface_.plane_slope[i] <= 0.f) return;
    const float smooth = surface_.smooth_depth_m[i];
    samples.pixels.add(smooth, std::abs(depth_[i] - smooth) / model_.sigma_m(smooth));
  }

  /// A plane against those of the windows beside it: in a row, two to either side, in the direction
  /// (dx, dy).
  void compare(int x, int y, int dx, int dy, Samples& samples) const {
    dx *= side_px_, dy *= side_px_;
    if (!is_full(x, y) || !is_full(x + dx, y + dy)) return;
    compare_normals(x, y, x + dx, y + dy, samples);
    if (!is_full(x - dx, y - dy) || !is_full(x - 2 * dx, y - 2 * dy) ||
        !is_full(x + 2 * dx, y + 2 * dy))
      return;
    const Image<float>& depth = surface_.smooth_depth_m;
    const float here = depth.at(x, y), line = 0.5f / depth.at(x - 2 * dx, y - 2 * dy) +
                                              0.5f / depth.at(x + 2 * dx, y + 2 * dy);
    constexpr float kDeviation = 1.22474487f;  // of the second difference, sqrt(1.5)
    samples.depths.add(here,
                       here * std::abs(1.f - here * line) / (kDeviation * model_.sigma_m(here)));
  }

  void compare_normals(int x1, int y1, int x2, int y2, Samples& samples) const {
    const float depth = surface_.smooth_depth_m.at(x1, y1),
                sigma = normal_per_pixel_ * model_.sigma_m(depth) / depth;
    constexpr float kDeviation = 1.41421356f;  // of a difference
    samples.normals.add(depth, (surface_.normals.at(x1, y1) - surface_.normals.at(x2, y2)).norm() /
                                   (kDeviation * sigma));
  }

  bool is_full(int x, int y) const { return full_.contains(x, y) && full_.at(x, y); }

  const DepthImage& depth_;
  const DepthSurface& surface_;
  const DepthNoiseConfig& model_;
  const int side_px_;
  const float normal_per_pixel_;  ///< sigma of a normal at 1 m, of a pixel's
  Image<std::uint8_t> full_;
};

}  // namespace

FrameNoise read_noise(const DepthImage& depth, const DepthSurface& surface,
                      const PinholeCamera& camera, const DepthNoiseConfig& model) {
  const Sampler sampler(depth, surface, camera, model);
  Samples samples;
  std::mutex adding;  // counts are the same in any order
  parallel_for_ranges(static_cast<std::size_t>(depth.height()), kSampledRowsPerTask,
                      [&](std::size_t begin, std::size_t end) {
                        Samples some;
                        sampler.sample(begin, end, some);
                        const std::lock_guard lock(adding);
                        samples.add(some);
                      });
  FrameNoise noise;
  if (const auto pixel = samples.pixels.sigmas(kMedianOfNormal)) noise.pixel = *pixel;
  noise.plane = samples.depths.sigmas(kMedianOfNormal).value_or(noise.pixel);
  if (const auto normal = samples.normals.sigmas(kMedianOfAngle)) noise.normal = *normal;
  return noise;
}

}  // namespace ovimap
