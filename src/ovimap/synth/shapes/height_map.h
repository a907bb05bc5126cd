// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ovimap/image/image.h"
#include "ovimap/synth/shapes/oriented_box.h"
#include "ovimap/synth/shapes/texture.h"

namespace ovimap {

/// The upper side of a piece of furniture in its own frame: where a mug can stand on a table.
class HeightMap {
 public:
  explicit HeightMap(const TexturedMesh& mesh, float cell_m = 0.01f);

  /// The height at which a thing with this footprint (in the furniture's frame) rests, or nothing
  /// where the surface below it ends or is uneven by more than `tolerance_m`.
  [[nodiscard]] std::optional<float> rest(const OrientedBox& footprint, float tolerance_m) const;

 private:
  void add_triangle(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c);

  float cell_m_;
  Eigen::Vector2f origin_m_ = Eigen::Vector2f::Zero();
  Image<float> heights_;  ///< -infinity where nothing is
};

}  // namespace ovimap
