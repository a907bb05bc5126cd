// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "ovimap/geometry/camera.h"
#include "ovimap/image/image.h"

namespace ovimap {

struct DepthNoiseConfig;
struct DepthSurface;

/// One number for each half octave of range from 1/8 m: the exponent of a float and its first
/// binary place.
class ByRange {
 public:
  static constexpr std::size_t kRanges = 20;
  static std::size_t range_of(float depth_m) {
    constexpr int kFirst = static_cast<int>(std::bit_cast<std::uint32_t>(0.125f) >> 22);
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(std::bit_cast<std::uint32_t>(depth_m) >> 22) - kFirst, 0,
                   static_cast<int>(kRanges) - 1));
  }

  explicit ByRange(float everywhere) { numbers_.fill(everywhere); }
  float at(float depth_m) const { return numbers_[range_of(depth_m)]; }
  float& operator[](std::size_t range) { return numbers_[range]; }
  float operator[](std::size_t range) const { return numbers_[range]; }

 private:
  std::array<float, kRanges> numbers_;
};

/// How a frame's depth errs, read off the frame itself, most of what is seen being smooth. In
/// multiples of what a model of independent errors gives for the range. Sensors match windows,
/// interpolate and bend, so that neighbours err alike and averages help less than their number
/// promises.
struct FrameNoise {
  ByRange pixel{1.f};   ///< sigma of a pixel, off the plane through its neighbours
  ByRange plane{1.f};   ///< of a plane fitted in a full window, off the planes around it, in
                        ///< sigmas of a pixel: what is left of its pixels' errors, and what these
                        ///< share
  ByRange normal{1.f};  ///< of such a plane's normal (normal_sigma_rad)
};

/// Medians by range; where a range has too few samples those of all ranges. In frames too small to
/// tell the model is believed, but planes are taken to err as pixels do.
///
/// Windows are compared that lie in a row on a surface without breaks. A plane is linear in inverse
/// depth, so those of three windows, one apart from each other, lie on a line there but for their
/// errors: the second difference has 1.5 times the variance of one. Normals of neighbouring windows
/// differ by their errors alone.
FrameNoise read_noise(const DepthImage& depth, const DepthSurface& surface,
                      const PinholeCamera& camera, const DepthNoiseConfig& model);

}  // namespace ovimap
