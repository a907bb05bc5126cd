// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/frame_noise.h"

#include <cmath>
#include <optional>
#include <vector>

#include "ovimap/base/median.h"
#include "ovimap/segment/depth_surface.h"

namespace ovimap {

namespace {

constexpr std::size_t kSampleStep = 7;       // pixels; no divisor of usual widths
constexpr std::size_t kFewestSamples = 500;  // for a median good to some per cent
constexpr float kMedianOfNormal = 0.6745f;   // of |x| where sigma is 1
constexpr float kMedianOfAngle = 1.1774f;    // of the length of two of them
constexpr float kLeastScale = 0.02f;         // exact depth still has a last digit
constexpr float kFullWindow = 0.9f;          // of its pixels

/// Absolute residuals in sigmas of the model, by range.
class Residuals {
 public:
  void add(float depth_m, float sigmas) { by_range_[ByRange::range_of(depth_m)].push_back(sigmas); }

  /// Their medians, which are moved by little but noise, over what they are where sigma is 1.
  /// Nothing where there are too few of them to tell.
  std::optional<ByRange> sigmas(float median_of_one) {
    std::vector<float> all;
    for (const std::vector<float>& some : by_range_)
      all.insert(all.end(), some.begin(), some.end());
    if (all.size() < kFewestSamples) return std::nullopt;
    ByRange found(sigma_of(all, median_of_one));
    for (std::size_t range = 0; range < ByRange::kRanges; ++range)
      if (by_range_[range].size() >= kFewestSamples)
        found[range] = sigma_of(by_range_[range], median_of_one);
    return found;
  }

 private:
  static float sigma_of(std::vector<float>& residuals, float median_of_one) {
    return std::max(kLeastScale, median_of(residuals) / median_of_one);
  }

  std::array<std::vector<float>, ByRange::kRanges> by_range_;
};

Residuals of_pixels(const DepthImage& depth, const DepthSurface& surface,
                    const DepthNoiseConfig& model) {
  Residuals residuals;
  for (std::size_t i = 0; i < depth.size(); i += kSampleStep) {
    if (depth[i] <= 0.f || surface.plane_slope[i] <= 0.f) continue;
    const float smooth = surface.smooth_depth_m[i];
    residuals.add(smooth, std::abs(depth[i] - smooth) / model.sigma_m(smooth));
  }
  return residuals;
}

/// Planes against those of the windows beside them.
class PlaneResiduals {
 public:
  PlaneResiduals(const DepthSurface& surface, const PinholeCamera& camera,
                 const DepthNoiseConfig& model)
      : surface_(surface),
        camera_(camera),
        model_(model),
        side_px_(2 * surface.radius_px + 1),
        fewest_px_(static_cast<int>(kFullWindow * static_cast<float>(side_px_ * side_px_))) {
    const int step = std::max(1, surface.radius_px / 2);
    for (int y = 0; y < surface.normals.height(); y += step)
      for (int x = 0; x < surface.normals.width(); x += step) {
        compare(x, y, 1, 0);
        compare(x, y, 0, 1);
      }
  }

  Residuals depths, normals;

 private:
  /// The windows in a row, two to either side, in the direction (dx, dy).
  void compare(int x, int y, int dx, int dy) {
    dx *= side_px_, dy *= side_px_;
    if (!is_full(x, y) || !is_full(x + dx, y + dy)) return;
    compare_normals(x, y, x + dx, y + dy);
    if (!is_full(x - dx, y - dy) || !is_full(x - 2 * dx, y - 2 * dy) ||
        !is_full(x + 2 * dx, y + 2 * dy))
      return;
    const Image<float>& depth = surface_.smooth_depth_m;
    const float here = depth.at(x, y), line = 0.5f / depth.at(x - 2 * dx, y - 2 * dy) +
                                              0.5f / depth.at(x + 2 * dx, y + 2 * dy);
    constexpr float kDeviation = 1.22474487f;  // of the second difference, sqrt(1.5)
    depths.add(here, here * std::abs(1.f - here * line) / (kDeviation * model_.sigma_m(here)));
  }

  void compare_normals(int x1, int y1, int x2, int y2) {
    const float depth = surface_.smooth_depth_m.at(x1, y1),
                sigma = normal_sigma_rad(depth, surface_.radius_px, camera_, model_);
    constexpr float kDeviation = 1.41421356f;  // of a difference
    normals.add(depth, (surface_.normals.at(x1, y1) - surface_.normals.at(x2, y2)).norm() /
                           (kDeviation * sigma));
  }

  bool is_full(int x, int y) const {
    if (!surface_.plane_slope.contains(x, y) || surface_.plane_slope.at(x, y) <= 0.f) return false;
    const int columns = surface_.left_px.at(x, y) + surface_.right_px.at(x, y) + 1,
              rows = surface_.up_px.at(x, y) + surface_.down_px.at(x, y) + 1;
    return columns * rows >= fewest_px_;
  }

  const DepthSurface& surface_;
  const PinholeCamera& camera_;
  const DepthNoiseConfig& model_;
  const int side_px_, fewest_px_;
};

}  // namespace

FrameNoise read_noise(const DepthImage& depth, const DepthSurface& surface,
                      const PinholeCamera& camera, const DepthNoiseConfig& model) {
  FrameNoise noise;
  if (const auto pixel = of_pixels(depth, surface, model).sigmas(kMedianOfNormal))
    noise.pixel = *pixel;
  PlaneResiduals planes(surface, camera, model);
  noise.plane = planes.depths.sigmas(kMedianOfNormal).value_or(noise.pixel);
  if (const auto normal = planes.normals.sigmas(kMedianOfAngle)) noise.normal = *normal;
  return noise;
}

}  // namespace ovimap
