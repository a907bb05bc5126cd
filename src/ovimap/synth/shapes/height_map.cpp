// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/shapes/height_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace ovimap {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();

}  // namespace

HeightMap::HeightMap(const TexturedMesh& mesh, float cell_m) : cell_m_(cell_m) {
  Eigen::AlignedBox2f extent;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    extent.extend(Eigen::Vector2f(vertex.head<2>()));
  if (extent.isEmpty()) return;
  origin_m_ = extent.min();
  const Eigen::Vector2f cells = extent.sizes() / cell_m_;
  heights_ =
      Image<float>(static_cast<int>(cells.x()) + 1, static_cast<int>(cells.y()) + 1, kNothing);
  for (const auto& [a, b, c] : mesh.triangles)
    add_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
}

void HeightMap::add_triangle(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                             const Eigen::Vector3f& c) {
  const auto cross = [](const Eigen::Vector2f& s, const Eigen::Vector2f& t) {
    return s.x() * t.y() - s.y() * t.x();
  };
  const Eigen::Vector2f pa = a.head<2>(), pb = b.head<2>(), pc = c.head<2>();
  const float area = cross(pb - pa, pc - pa);
  if (area == 0) return;
  const Eigen::Vector2f low = (pa.cwiseMin(pb).cwiseMin(pc) - origin_m_) / cell_m_;
  const Eigen::Vector2f high = (pa.cwiseMax(pb).cwiseMax(pc) - origin_m_) / cell_m_;
  for (int y = std::max(0, static_cast<int>(low.y()));
       y <= std::min<int>(high.y(), heights_.height() - 1); ++y)
    for (int x = std::max(0, static_cast<int>(low.x()));
         x <= std::min<int>(high.x(), heights_.width() - 1); ++x) {
      const Eigen::Vector2f p = origin_m_ + cell_m_ * Eigen::Vector2f(static_cast<float>(x) + 0.5f,
                                                                      static_cast<float>(y) + 0.5f);
      const float wa = cross(pb - p, pc - p) / area, wb = cross(pc - p, pa - p) / area;
      if (wa < 0 || wb < 0 || wa + wb > 1) continue;
      heights_.at(x, y) =
          std::max(heights_.at(x, y), wa * a.z() + wb * b.z() + (1 - wa - wb) * c.z());
    }
}

std::optional<float> HeightMap::rest(const OrientedBox& footprint, float tolerance_m) const {
  float lowest = std::numeric_limits<float>::infinity(), highest = kNothing;
  const int steps_x = std::max(1, static_cast<int>(std::ceil(2 * footprint.half_m.x() / cell_m_)));
  const int steps_y = std::max(1, static_cast<int>(std::ceil(2 * footprint.half_m.y() / cell_m_)));
  const Eigen::Vector2f x_axis = footprint.x_axis(), y_axis = footprint.y_axis();
  for (int j = 0; j <= steps_y; ++j)
    for (int i = 0; i <= steps_x; ++i) {
      const Eigen::Vector2f part(static_cast<float>(2 * i) / static_cast<float>(steps_x) - 1,
                                 static_cast<float>(2 * j) / static_cast<float>(steps_y) - 1);
      const Eigen::Vector2f point = part.cwiseProduct(footprint.half_m);
      const Eigen::Vector2f p = footprint.center_m + point.x() * x_axis + point.y() * y_axis;
      const Eigen::Vector2f cell = (p - origin_m_) / cell_m_;
      const int x = static_cast<int>(std::floor(cell.x())),
                y = static_cast<int>(std::floor(cell.y()));
      if (!heights_.contains(x, y)) return std::nullopt;
      lowest = std::min(lowest, heights_.at(x, y));
      highest = std::max(highest, heights_.at(x, y));
      if (!(highest - lowest <= tolerance_m)) return std::nullopt;  // also where nothing is
    }
  return highest;
}

}  // namespace ovimap
