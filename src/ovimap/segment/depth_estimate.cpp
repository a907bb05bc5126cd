// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/depth_estimate.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/segment/task_rows.h"

namespace ovimap {

namespace {

constexpr float kMostSquares = 25.f;      // squared sigmas; what lies further off tells no more
constexpr float kStepsPerSquare = 256.f;  // of a residual as a whole number

/// A squared residual in steps, and in the high half that there is one: sums of both at once,
/// exact, whatever their order.
using Residual = std::uint64_t;
constexpr Residual kOne = Residual{1} << 32;

class Estimator {
 public:
  Estimator(const DepthImage& depth, const DepthSurface& surface, const DepthNoiseConfig& model)
      : depth_(depth),
        surface_(surface),
        model_(model),
        alike_(alike_of(surface.noise, surface.radius_px)),
        width_(static_cast<std::size_t>(depth.width())),
        row_sums_(depth.width(), depth.height()),
        estimate_{DepthImage(depth.width(), depth.height()),
                  Image<float>(depth.width(), depth.height())} {}

  DepthEstimate estimate() {
    const auto height = static_cast<std::size_t>(depth_.height());
    parallel_for_ranges(height, kWindowRowsPerTask, [&](std::size_t begin, std::size_t end) {
      std::vector<Residual> residuals(width_);
      for (std::size_t y = begin; y < end; ++y) {
        measure_row(static_cast<int>(y), residuals);
        sum_row(residuals, row_sums_.row(static_cast<int>(y)));
      }
    });
    parallel_for_ranges(height, kWindowRowsPerTask, [&](std::size_t begin, std::size_t end) {
      filter_rows(static_cast<int>(begin), static_cast<int>(end));
    });
    return std::move(estimate_);
  }

 private:
  /// What a frame's noise says of the mean of a window's pixels.
  struct Alike {
    ByRange pixels{1.f};  ///< so many count as one sample
    ByRange most{1.f};    ///< variance of a plane over that of a pixel, in whatever window
  };
  static Alike alike_of(const FrameNoise& noise, int radius_px) {
    const auto full = static_cast<float>((2 * radius_px + 1) * (2 * radius_px + 1));
    Alike alike;
    for (std::size_t range = 0; range < ByRange::kRanges; ++range) {
      const float share = noise.plane[range] / noise.pixel[range];
      alike.pixels[range] = std::max(1.f, full * share * share);
      alike.most[range] = std::max(1.f, share * share);
    }
    return alike;
  }

  /// Sigma of each pixel as measured, and its squared residual in sigmas.
  void measure_row(int y, std::vector<Residual>& residuals) {
    const float *depth = depth_.row(y), *smooth = surface_.smooth_depth_m.row(y),
                *slope = surface_.plane_slope.row(y);
    float* sigma = estimate_.sigma_m.row(y);
    for (std::size_t x = 0; x < width_; ++x) {
      residuals[x] = 0;
      if (depth[x] <= 0.f) continue;
      sigma[x] = model_.sigma_m(smooth[x]) * surface_.noise.pixel.at(smooth[x]);
      if (slope[x] <= 0.f) continue;
      const float off = (depth[x] - smooth[x]) / sigma[x];
      residuals[x] =
          kOne + static_cast<Residual>(std::min(off * off, kMostSquares) * kStepsPerSquare);
    }
  }

  /// Sums over each pixel's window along the row.
  void sum_row(const std::vector<Residual>& residuals, Residual* sums) const {
    const auto radius = static_cast<std::size_t>(surface_.radius_px);
    Residual sum = 0;
    for (std::size_t x = 0; x < std::min(radius, width_); ++x) sum += residuals[x];
    for (std::size_t x = 0; x < width_; ++x) {
      if (x + radius < width_) sum += residuals[x + radius];
      if (x > radius) sum -= residuals[x - radius - 1];
      sums[x] = sum;
    }
  }

  void filter_rows(int begin, int end) {
    const int radius = surface_.radius_px, height = depth_.height();
    std::vector<Residual> sums(width_);
    for (int y = std::max(0, begin - radius); y < std::min(height, begin + radius); ++y)
      for (std::size_t x = 0; x < width_; ++x) sums[x] += row_sums_.row(y)[x];
    for (int y = begin; y < end; ++y) {
      const Residual* enters = y + radius < height ? row_sums_.row(y + radius) : nullptr;
      const Residual* leaves =
          y > begin && y - radius - 1 >= 0 ? row_sums_.row(y - radius - 1) : nullptr;
      for (std::size_t x = 0; x < width_; ++x)
        sums[x] += (enters ? enters[x] : 0) - (leaves ? leaves[x] : 0);
      filter_row(y, sums);
    }
  }

  void filter_row(int y, const std::vector<Residual>& sums) {
    const float *depth = depth_.row(y), *smooth = surface_.smooth_depth_m.row(y),
                *slope = surface_.plane_slope.row(y);
    const std::uint8_t *left = surface_.left_px.row(y), *right = surface_.right_px.row(y),
                       *up = surface_.up_px.row(y), *down = surface_.down_px.row(y);
    float *estimate = estimate_.depth_m.row(y), *sigma = estimate_.sigma_m.row(y);
    for (std::size_t x = 0; x < width_; ++x) {
      const auto squares = static_cast<float>(sums[x] & (kOne - 1)) / kStepsPerSquare;
      const auto samples = static_cast<float>(sums[x] >> 32);
      // The share of what was measured: of the residuals' variance, that which is no noise.
      const float excess = squares - samples;
      const float raw = slope[x] > 0.f ? (excess > 0.f ? excess / squares : 0.f) : 1.f;
      estimate[x] = depth[x] > 0.f ? smooth[x] + raw * (depth[x] - smooth[x]) : 0.f;
      const auto window = static_cast<float>((left[x] + right[x] + 1) * (up[x] + down[x] + 1));
      const float alike = std::min(alike_.most.at(smooth[x]), alike_.pixels.at(smooth[x]) / window);
      sigma[x] *= std::sqrt(raw * raw + (1.f - raw) * (1.f - raw) * alike);
    }
  }

  const DepthImage& depth_;
  const DepthSurface& surface_;
  const DepthNoiseConfig& model_;
  const Alike alike_;
  const std::size_t width_;
  Image<Residual> row_sums_;
  DepthEstimate estimate_;
};

}  // namespace

void list_fields(DepthEstimateConfig& config, ConfigFields& fields) {
  fields.add("enabled", config.enabled,
             "fuse depth as planes and measurement together have it, weighed by its variance; off: "
             "as measured, weighed by 1/z^2");
}

DepthEstimate estimate_depth(const DepthImage& depth, const DepthSurface& surface,
                             const DepthNoiseConfig& model, const DepthEstimateConfig& config) {
  if (!config.enabled) return {depth, {}};
  return Estimator(depth, surface, model).estimate();
}

}  // namespace ovimap
