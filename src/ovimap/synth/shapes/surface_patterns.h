// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "ovimap/synth/shapes/texture.h"

namespace ovimap {

/// A made texture and the size in metres of one repeat of it.
struct SurfacePattern {
  std::shared_ptr<const Texture> texture;
  float width_m = 1, height_m = 1;
};

/// What a surface that shows the pattern is made of.
inline SurfaceMaterial textured(const SurfacePattern& pattern) {
  SurfaceMaterial material;
  material.texture = pattern.texture;
  return material;
}

/// The same seed gives the same pixels. Repeating ones join without a seam.
/// `style` is one of "oak", "walnut", "pine", "tiles", "carpet", or one of those
/// that only unseen scenes have: "ash", "parquet", "mosaic".
SurfacePattern floor_pattern(const std::string& style, std::uint64_t seed);
/// `style` is one of "plaster", "stripes", "dots"; of unseen scenes "roller", "panels".
SurfacePattern wall_pattern(const std::string& style, Rgb8 color, std::uint64_t seed);
/// A bordered carpet, not repeating.
SurfacePattern rug_pattern(float width_m, float height_m, std::uint64_t seed);
/// Overlapping strokes and shapes, as on a modern painting, not repeating.
SurfacePattern painting_pattern(float width_m, float height_m, std::uint64_t seed);
/// Sky, hills and trees out of focus, as behind a window, not repeating.
SurfacePattern outdoor_pattern(float width_m, float height_m, std::uint64_t seed);

}  // namespace ovimap
