// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "ovimap/semantics/relations/object_shape.h"

namespace ovimap {

/// How large an object is and where, in metres, and how its surface is spread.
struct ObjectMeasures {
  float height_m = 0;
  float length_m = 0, depth_m = 0;  ///< sides of the smallest upright box around it
  float bottom_m = 0;               ///< above the floor
  /// Shares of its surface: within kSurfaceStep_m of its top, and farther than that below surface
  /// of its own. A table is mostly top, a cabinet hangs below its own. Negative: not known.
  float top_share = -1, covered_share = -1;

  float top_m() const { return bottom_m + height_m; }
};
inline constexpr float kSurfaceStep_m = 0.05f;

/// Without the 5 % of the surface that lie farthest out at each end, which often are not its own.
/// The floor is where 2 % of all surface is lower. All shapes in one ground frame.
std::vector<ObjectMeasures> measure_objects(std::span<const ObjectShape> shapes);

}  // namespace ovimap
