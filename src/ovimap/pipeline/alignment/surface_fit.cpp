// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/alignment/surface_fit.h"

#include <algorithm>
#include <array>

#include "ovimap/map/voxels/voxel_block.h"
#include "ovimap/track/alignment/normal_equations.h"

namespace ovimap {

SurfacePoints thinned_surface(const Mesh& mesh, float spacing_m) {
  std::vector<std::pair<std::array<int, 3>, std::uint32_t>> cells(mesh.vertices.size());
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const Eigen::Vector3i cell = floor_to_int(mesh.vertices[i] / spacing_m);
    cells[i] = {{cell.x(), cell.y(), cell.z()}, i};
  }
  std::sort(cells.begin(), cells.end());
  SurfacePoints surface;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0 && cells[i].first == cells[i - 1].first) continue;
    surface.points.push_back(mesh.vertices[cells[i].second]);
    surface.normals.push_back(mesh.normals[cells[i].second]);
  }
  return surface;
}

Pose SurfaceFit::refine(Pose a_from_b, std::span<const float> reaches_m, int rounds) const {
  for (const float reach : reaches_m)
    for (int i = 0; i < rounds; ++i) a_from_b = step(a_from_b, reach);
  return a_from_b;
}

Pose SurfaceFit::step(const Pose& a_from_b, float reach_m) const {
  const Eigen::Isometry3f pose = a_from_b.cast<float>();
  std::vector<Eigen::Vector3f> moved(b_.points.size());
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = pose * b_.points[i];
  const auto found = nearest_.find_all(moved, reach_m);
  Matrix6d normal = Matrix6d::Identity() * 1e-6;
  Vector6d right = Vector6d::Zero();
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (!found[i]) continue;
    const Eigen::Vector3f& plane = a_.normals[found[i]->index];
    if (plane.dot(pose.linear() * b_.normals[i]) < kSameSurfaceCosine) continue;
    const Eigen::Vector3d p = moved[i].cast<double>(), n = plane.cast<double>();
    Vector6d row;
    row << n, p.cross(n);
    normal += row * row.transpose();
    right += row * n.dot(a_.points[found[i]->index].cast<double>() - p);
  }
  const Vector6d change = normal.ldlt().solve(right);
  if (!change.allFinite()) return a_from_b;
  return rigid_pose((small_motion(change) * a_from_b).matrix());  // products drift
}

}  // namespace ovimap
