// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "ovimap/base/lanes.h"

namespace ovimap {

/// Eight vectors side by side.
struct EightVectors {
  Floats x, y, z;
};

OVIMAP_INLINE Floats dot(const EightVectors& a, const EightVectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

OVIMAP_INLINE EightVectors cross(const EightVectors& a, const EightVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

OVIMAP_INLINE EightVectors turned(const Eigen::Isometry3f& pose, const EightVectors& v) {
  return {pose(0, 0) * v.x + pose(0, 1) * v.y + pose(0, 2) * v.z,
          pose(1, 0) * v.x + pose(1, 1) * v.y + pose(1, 2) * v.z,
          pose(2, 0) * v.x + pose(2, 1) * v.y + pose(2, 2) * v.z};
}

OVIMAP_INLINE EightVectors transformed(const Eigen::Isometry3f& target_from_source,
                                       const EightVectors& points) {
  const EightVectors t = turned(target_from_source, points);
  return {t.x + target_from_source(0, 3), t.y + target_from_source(1, 3),
          t.z + target_from_source(2, 3)};
}

}  // namespace ovimap
