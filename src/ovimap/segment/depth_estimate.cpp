// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/depth_estimate.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/segment/task_rows.h"

namespace ovimap {

namespace {

constexpr float kMostSquares = 25.f;      // squared sigmas; what lies further off tells no more
constexpr float kStepsPerSquare = 256.f;  // of a residual as a whole number

/// Of a row: squared residuals in steps, and of how many pixels. Whole numbers, whose sums are the
/// same in any order.
struct ResidualRow {
  std::int32_t *squares, *samples;
};

/// What a frame's noise says of the mean of a window's pixels.
struct Alike {
  ByRange pixels{1.f};  ///< so many count as one sample
  ByRange most{1.f};    ///< variance of a plane over that of a pixel, in whatever window
};

Alike alike_of(const FrameNoise& noise, int radius_px) {
  const auto full = static_cast<float>((2 * radius_px + 1) * (2 * radius_px + 1));
  Alike alike;
  for (std::size_t range = 0; range < ByRange::kRanges; ++range) {
    const float share = noise.plane[range] / noise.pixel[range];
    alike.pixels[range] = std::max(1.f, full * share * share);
    alike.most[range] = std::max(1.f, share * share);
  }
  return alike;
}

/// The rows of a fitted surface that the estimate of one row reads.
struct SurfaceRow {
  SurfaceRow(const DepthSurface& surface, int y)
      : smooth(surface.smooth_depth_m.row(y)),
        slope(surface.plane_slope.row(y)),
        left(surface.left_px.row(y)),
        right(surface.right_px.row(y)),
        up(surface.up_px.row(y)),
        down(surface.down_px.row(y)) {}
  const float *smooth, *slope;
  const std::uint8_t *left, *right, *up, *down;
};

/// Sigma of each pixel as measured, and its squared residual in sigmas.
OVIMAP_VECTORIZE void measure_row(const float* depth, const SurfaceRow& row,
                                  const DepthNoiseConfig& model, const ByRange& noise, int width,
                                  float* sigma, ResidualRow residuals) {
  const float *smooth = row.smooth, *slope = row.slope;
  OVIMAP_NO_OVERLAP
  for (int x = 0; x < width; ++x) {
    const float expected = model.sigma_m(smooth[x]) * noise.at(smooth[x]);
    const float off = (depth[x] - smooth[x]) / expected;
    const bool told = (depth[x] > 0.f) & (slope[x] > 0.f);
    sigma[x] = depth[x] > 0.f ? expected : 0.f;
    const float square = told ? std::min(off * off, kMostSquares) * kStepsPerSquare : 0.f;
    residuals.squares[x] = static_cast<std::int32_t>(square);
    residuals.samples[x] = told;
  }
}

/// Sums over each pixel's window along the row.
void sum_row(const std::int32_t* values, int radius, int width, std::int32_t* sums) {
  std::int32_t sum = 0;
  for (int x = 0; x < std::min(radius, width); ++x) sum += values[x];
  for (int x = 0; x < width; ++x) {
    if (x + radius < width) sum += values[x + radius];
    if (x > radius) sum -= values[x - radius - 1];
    sums[x] = sum;
  }
}

OVIMAP_VECTORIZE void add_row(const std::int32_t* row, std::int32_t times, int width,
                              std::int32_t* sums) {
  OVIMAP_NO_OVERLAP
  for (int x = 0; x < width; ++x) sums[x] += times * row[x];
}

/// Depth, and what it is uncertain by, from the residuals around. `sigma`: of a pixel before.
OVIMAP_VECTORIZE void filter_row(const float* depth, const SurfaceRow& row, const Alike& alike,
                                 ResidualRow sums, int width, float* estimate, float* sigma) {
  const float *smooth = row.smooth, *slope = row.slope;
  const std::uint8_t *left = row.left, *right = row.right, *up = row.up, *down = row.down;
  OVIMAP_NO_OVERLAP
  for (int x = 0; x < width; ++x) {
    const float squares = static_cast<float>(sums.squares[x]) * (1.f / kStepsPerSquare);
    const auto samples = static_cast<float>(sums.samples[x]);
    // The share of what was measured: of the residuals' variance, that which is no noise.
    const float excess = squares - samples;
    const float share = excess > 0.f ? excess / squares : 0.f;
    const float raw = slope[x] > 0.f ? share : 1.f;
    estimate[x] = depth[x] > 0.f ? smooth[x] + raw * (depth[x] - smooth[x]) : 0.f;
    const auto window = static_cast<float>((left[x] + right[x] + 1) * (up[x] + down[x] + 1));
    const float plane = std::min(alike.most.at(smooth[x]), alike.pixels.at(smooth[x]) / window);
    sigma[x] *= std::sqrt(raw * raw + (1.f - raw) * (1.f - raw) * plane);
  }
}

class Estimator {
 public:
  Estimator(const DepthImage& depth, const DepthSurface& surface, const DepthNoiseConfig& model)
      : depth_(depth),
        surface_(surface),
        model_(model),
        width_(depth.width()),
        squares_(Image<std::int32_t>::unset(depth.width(), depth.height())),
        samples_(Image<std::int32_t>::unset(depth.width(), depth.height())),
        estimate_{DepthImage::unset(depth.width(), depth.height()),
                  Image<float>::unset(depth.width(), depth.height())} {}

  DepthEstimate estimate() {
    const auto height = static_cast<std::size_t>(depth_.height());
    parallel_for_ranges(height, kWindowRowsPerTask, [&](std::size_t begin, std::size_t end) {
      measure_rows(static_cast<int>(begin), static_cast<int>(end));
    });
    parallel_for_ranges(height, kWindowRowsPerTask, [&](std::size_t begin, std::size_t end) {
      filter_rows(static_cast<int>(begin), static_cast<int>(end));
    });
    return std::move(estimate_);
  }

 private:
  void measure_rows(int begin, int end) {
    std::vector<std::int32_t> squares(static_cast<std::size_t>(width_)), samples(squares.size());
    for (int y = begin; y < end; ++y) {
      measure_row(depth_.row(y), SurfaceRow(surface_, y), model_, surface_.noise.pixel, width_,
                  estimate_.sigma_m.row(y), {squares.data(), samples.data()});
      sum_row(squares.data(), surface_.radius_px, width_, squares_.row(y));
      sum_row(samples.data(), surface_.radius_px, width_, samples_.row(y));
    }
  }

  void filter_rows(int begin, int end) {
    const Alike alike = alike_of(surface_.noise, surface_.radius_px);
    const int radius = surface_.radius_px, height = depth_.height();
    std::vector<std::int32_t> squares(static_cast<std::size_t>(width_)), samples(squares.size());
    const auto add = [&](int y, std::int32_t times) {
      add_row(squares_.row(y), times, width_, squares.data());
      add_row(samples_.row(y), times, width_, samples.data());
    };
    for (int y = std::max(0, begin - radius); y < std::min(height, begin + radius); ++y) add(y, 1);
    for (int y = begin; y < end; ++y) {
      if (y + radius < height) add(y + radius, 1);
      if (y > begin && y - radius - 1 >= 0) add(y - radius - 1, -1);
      filter_row(depth_.row(y), SurfaceRow(surface_, y), alike, {squares.data(), samples.data()},
                 width_, estimate_.depth_m.row(y), estimate_.sigma_m.row(y));
    }
  }

  const DepthImage& depth_;
  const DepthSurface& surface_;
  const DepthNoiseConfig& model_;
  const int width_;
  Image<std::int32_t> squares_, samples_;  ///< of residuals, over windows along the rows
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
