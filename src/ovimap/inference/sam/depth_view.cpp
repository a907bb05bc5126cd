// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/depth_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ovimap/frames/frame/registration.h"

namespace ovimap {

namespace {

// As tools/models/finder_data.py has them.
constexpr float kMiddle = 5;    ///< brings pixels of some millimetres to about 0
constexpr float kSteepest = 2;  ///< of half a slope

/// Means of inverse depth, 1/m, over the depth pixels that a pixel of the grid covers in the colour
/// image.
class InverseDepth {
 public:
  InverseDepth(int rows, int columns) : sums_(columns, rows), counts_(columns, rows) {}

  void add(const Frame& frame, const Eigen::Vector2f& grid_from_image) {
    const Registration registration(frame);
    // A coarse depth image leaves no gaps: a pixel of it fills what it is wide.
    const float scale = grid_from_image.x() * frame.color_camera.fx / frame.depth_camera.fx;
    const int around = static_cast<int>(0.5f * std::max(0.f, scale));
    for (int v = 0; v < frame.depth.height(); ++v)
      for (int u = 0; u < frame.depth.width(); ++u) {
        const std::int32_t index = registration.color_index().at(u, v);
        if (index == Registration::kNoColor) continue;
        const Eigen::Vector2i pixel(index % frame.color.width(), index / frame.color.width());
        const Eigen::Vector2f at = (pixel.cast<float>().array() + 0.5f) * grid_from_image.array();
        add(static_cast<int>(at.x()), static_cast<int>(at.y()), around, 1 / frame.depth.at(u, v));
      }
  }

  /// Logarithms of depth in metres; NaN where none is known.
  Image<float> log_depth() const {
    Image<float> logs(sums_.width(), sums_.height(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < logs.size(); ++i)
      if (counts_[i] > 0) logs[i] = std::log(static_cast<float>(counts_[i]) / sums_[i]);
    return logs;
  }

 private:
  void add(int x, int y, int around, float inverse) {
    for (int v = std::max(0, y - around); v <= std::min(sums_.height() - 1, y + around); ++v)
      for (int u = std::max(0, x - around); u <= std::min(sums_.width() - 1, x + around); ++u) {
        sums_.at(u, v) += inverse;
        counts_.at(u, v) += 1;
      }
  }

  Image<float> sums_;
  Image<int> counts_;
};

/// Half of what the neighbours on both sides say, or the one whose depth is known.
float half_slope(float before, float here, float after, float focal_px) {
  float steps = 0;
  int known = 0;
  for (const float step : {here - before, after - here})
    if (!std::isnan(step)) steps += step, ++known;
  if (known == 0) return 0;
  return std::clamp(0.5f * focal_px * steps / static_cast<float>(known), -kSteepest, kSteepest);
}

}  // namespace

FloatTensor depth_view(const Frame& frame, const Eigen::Vector2f& grid_from_image, int rows,
                       int columns) {
  const auto plane = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  FloatTensor view{{1, kDepthMaps, rows, columns}, std::vector<float>(kDepthMaps * plane, 0.f)};
  if (frame.depth.width() == 0) return view;
  InverseDepth inverse(rows, columns);
  inverse.add(frame, grid_from_image);
  const Image<float> logs = inverse.log_depth();
  const auto log_at = [&](int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < columns && y < rows;
    return inside ? logs.at(x, y) : std::numeric_limits<float>::quiet_NaN();
  };
  const float focal_px = frame.color_camera.fx * grid_from_image.x();
  std::size_t at = 0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x, ++at) {
      const float here = logs.at(x, y);
      if (std::isnan(here)) continue;
      view.values[at] = here - std::log(focal_px) + kMiddle;
      view.values[plane + at] = half_slope(log_at(x - 1, y), here, log_at(x + 1, y), focal_px);
      view.values[2 * plane + at] = half_slope(log_at(x, y - 1), here, log_at(x, y + 1), focal_px);
      view.values[3 * plane + at] = 1;
    }
  return view;
}

}  // namespace ovimap
