// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/frames/frame/frame.h"

namespace ovimap {

/// A frame at one size, for tracking. Colour is brought to the depth camera, so that one camera and
/// one pose serve both.
struct TrackLevel {
  PinholeCamera camera;
  Image<float> intensity;      ///< 0 to 255; -1 where the colour camera saw nothing
  Image<float> inverse_depth;  ///< 1/metres; 0 = invalid
};

/// Halved again and again, the finest level first.
using TrackPyramid = std::vector<TrackLevel>;

inline constexpr int kFinestWidth_px = 320;      ///< at most so wide is the finest level, as a rule
inline constexpr int kCoarsestWidth_px = 40;     ///< no further level is narrower
inline constexpr std::size_t kFewestLevels = 2;  ///< of images of any size
inline constexpr float kOneSurface = 0.05f;  ///< depths that differ by a smaller share are averaged

/// The frame's depth and colour, shrunk by averages of what is one surface.
TrackPyramid make_pyramid(const Frame& frame);

/// Adds levels until there are kFewestLevels and the next would be narrower than kCoarsestWidth_px.
void add_coarser_levels(TrackPyramid& pyramid);

/// Intensity between pixels, bilinear; -1 where a neighbour is unknown or outside.
inline float intensity_at(const Image<float>& image, float u, float v) {
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  if (!(u >= 0 && v >= 0) || x + 1 >= image.width() || y + 1 >= image.height()) return -1;
  const float* upper = image.row(y) + x;
  const float* lower = image.row(y + 1) + x;
  if (upper[0] < 0 || upper[1] < 0 || lower[0] < 0 || lower[1] < 0) return -1;
  const float right = u - static_cast<float>(x), down = v - static_cast<float>(y);
  const float top = upper[0] + right * (upper[1] - upper[0]);
  const float bottom = lower[0] + right * (lower[1] - lower[0]);
  return top + down * (bottom - top);
}

}  // namespace ovimap
