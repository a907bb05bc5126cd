// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "ovimap/geometry/mesh.h"

namespace ovimap::fixture {

inline float sheet_height(float x, float y) {
  return 0.3f + 0.05f * std::sin(3.f * x) * std::cos(2.f * y);
}

/// A sheet of side x side squares over x, y >= 0.1, seen from above, in two objects.
inline Mesh wavy_sheet(int side, float step) {
  Mesh mesh;
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x) {
      const float u = 0.1f + static_cast<float>(x) * step, v = 0.1f + static_cast<float>(y) * step;
      mesh.vertices.emplace_back(u, v, sheet_height(u, v));
      const float du = 0.15f * std::cos(3.f * u) * std::cos(2.f * v),
                  dv = -0.1f * std::sin(3.f * u) * std::sin(2.f * v);
      mesh.normals.push_back(Eigen::Vector3f(-du, -dv, 1.f).normalized());
      mesh.colors.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 90});
      mesh.labels.push_back(x < side / 2 ? 1 : 70000);
    }
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(x + y * (side + 1)); };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  return mesh;
}

}  // namespace ovimap::fixture
