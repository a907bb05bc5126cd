// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>

#include <Eigen/Core>

#include "ovimap/synth/shapes/random.h"
#include "ovimap/synth/shapes/surface_patterns.h"
#include "ovimap/synth/shapes/texture.h"

namespace ovimap {

using PaintColor = Eigen::Vector3f;  ///< sRGB 0..1: patterns are designed as seen, not as light

/// 0 up to `low`, 1 from `high` on, smooth between.
float smooth_step(float low, float high, float x);

inline PaintColor mixed(const PaintColor& a, const PaintColor& b, float share_of_b) {
  return a + (b - a) * share_of_b;
}

/// What is left of x after whole numbers: 0..1 also below zero.
inline float part_of(float x) {
  return x - std::floor(x);
}

/// Smooth random values in [0, 1] on a lattice that repeats after `period` cells.
class LatticeNoise {
 public:
  explicit LatticeNoise(std::uint64_t seed) : seed_(seed) {}

  float at(float x, float y, int period_x, int period_y) const;

 private:
  std::uint64_t seed_;
};

/// The colour at (x, y), both 0..1 over the picture, y downwards.
using Paint = std::function<PaintColor(float x, float y)>;

std::shared_ptr<const Texture> painted(int width_px, int height_px, const Paint& color_at);

/// A large repeating surface: floors and walls.
SurfacePattern repeating(const Paint& color_at);

/// Something that is painted once, in pixels of 2.5 mm.
SurfacePattern picture(float width_m, float height_m, const Paint& color_at);

}  // namespace ovimap
