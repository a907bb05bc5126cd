// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "ovimap/synth/procedural/made_model.h"
#include "ovimap/synth/shapes/mesh_parts.h"
#include "ovimap/synth/shapes/painting.h"
#include "ovimap/synth/shapes/solids.h"

namespace ovimap {

inline constexpr float kGrain_m = 0.64f;  ///< one repeat of wood and cloth

/// What the makers of things share: chance, the split, materials.
struct Craft {
  Split split = Split::kTuned;
  Random& random;

  bool tuned() const { return split == Split::kTuned; }
  float between(float low, float high) { return random.uniform(low, high); }
  bool one_in(std::size_t count) { return random.index(count) == 0; }

  /// Materials; all return their number in the mesh.
  std::uint32_t wood(TexturedMesh& mesh);
  std::uint32_t cloth(TexturedMesh& mesh);    ///< often pale, of low contrast
  std::uint32_t lacquer(TexturedMesh& mesh);  ///< white, grey or a soft colour
  std::uint32_t metal(TexturedMesh& mesh);
  std::uint32_t plastic(TexturedMesh& mesh);  ///< grey to black
  std::uint32_t glaze(TexturedMesh& mesh);    ///< of cups: any colour, with a band or speckles
  std::uint32_t plain(TexturedMesh& mesh, const PaintColor& srgb, float emission = 0,
                      const char* substance = "");
  std::uint32_t print(TexturedMesh& mesh, float width_m, float height_m, const Paint& paint,
                      float emission = 0);
};

/// A picture on the upper side of a flat thing, a hair above it.
void add_top_print(TexturedMesh& mesh, const Eigen::Vector2f& low, const Eigen::Vector2f& high,
                   float top_m, std::uint32_t material);
/// A picture on the front (-y) of a thing.
void add_front_print(TexturedMesh& mesh, float left, float right, float bottom, float top, float y,
                     std::uint32_t material);

}  // namespace ovimap
