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

}  // namespace ovimap
