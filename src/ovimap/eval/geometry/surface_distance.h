// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/geometry/mesh.h"

namespace ovimap {

/// Exact distance from points to the surface of a mesh (a box tree over its triangles). A mesh
/// without triangles is a set of points.
class SurfaceDistance {
 public:
  /// Copies what it needs.
  explicit SurfaceDistance(const Mesh& mesh);

  /// Metres to the nearest point of the surface; nullopt when it is farther than `limit_m`.
  /// Thread-safe.
  [[nodiscard]] std::optional<float> find(const Eigen::Vector3f& point, float limit_m) const;

 private:
  struct Triangle {
    Eigen::Vector3f a, b, c;
  };
  /// Children are at 2i + 1 and 2i + 2; the triangles of a node are halved between them.
  struct Range {
    std::size_t begin, end;
  };

  void build(std::size_t node, Range range);
  void search(std::size_t node, Range range, const Eigen::Vector3f& point, double& best) const;

  std::vector<Triangle> triangles_;
  std::vector<Eigen::AlignedBox3f> boxes_;
};

/// Squared distance from a point to a triangle, which may be degenerate.
double squared_distance(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace ovimap
