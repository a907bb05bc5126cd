// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/scattered.h"

#include <algorithm>
#include <vector>

#include <Eigen/Eigenvalues>

#include "ovimap/instance/object_boxes.h"

namespace ovimap {

namespace {

/// Extents along the principal axes of the points that lie in a box: a thing that stands aslant has
/// no larger ones for that.
Eigen::Vector3f principal_sides(const std::vector<Eigen::Vector3f>& points,
                                const Eigen::AlignedBox3f& box) {
  Eigen::Matrix3f spread = Eigen::Matrix3f::Zero();
  const auto for_each = [&](const auto& visit) {
    for (const Eigen::Vector3f& point : points)
      if (box.contains(point)) visit(point - box.center());
  };
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float count = 0;
  for_each([&](const Eigen::Vector3f& point) { sum += point, count += 1; });
  for_each([&](const Eigen::Vector3f& point) {
    spread += (point - sum / count) * (point - sum / count).transpose();
  });
  const Eigen::Matrix3f axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f>(spread).eigenvectors();
  Eigen::AlignedBox3f along;
  for_each([&](const Eigen::Vector3f& point) { along.extend(axes.transpose() * point); });
  return along.sizes();
}

float smallest_face(const Eigen::Vector3f& sides) {
  return sides.prod() / sides.maxCoeff();
}
float largest_face(const Eigen::Vector3f& sides) {
  return sides.prod() / sides.minCoeff();
}

}  // namespace

Eigen::AlignedBox3f box_of(const MapDocument& map, InstanceId id) {
  const auto surface = map.surfaces.find(id);
  if (surface != map.surfaces.end() && !surface->second.empty())
    return box_without_specks(surface->second, surface_spacing_m(map.map.config().voxel_size_m));
  const InstanceSummary* instance = find_instance(map.instances, id);
  return instance ? instance->box : Eigen::AlignedBox3f();
}

bool is_scattered(const MapDocument& map, InstanceId id, float least_filled) {
  const InstanceSummary* instance = find_instance(map.instances, id);
  if (instance == nullptr) return true;
  const float voxel_m = map.map.config().voxel_size_m;
  const float surface_m2 = static_cast<float>(instance->points) * voxel_m * voxel_m;
  const Eigen::AlignedBox3f box = box_of(map, id);
  const Eigen::Array3f voxel = Eigen::Array3f::Constant(voxel_m);  // what is flat has one as well
  Eigen::Vector3f sides = box.sizes().array() + voxel;
  float smallest = smallest_face(sides), largest = largest_face(sides);
  if (const auto surface = map.surfaces.find(id);
      surface != map.surfaces.end() && !surface->second.empty()) {
    sides = principal_sides(surface->second, box).array() + voxel;
    smallest = std::min(smallest, smallest_face(sides));
    largest = std::min(largest, largest_face(sides));
  }
  return surface_m2 < std::max(smallest, least_filled * largest);
}

}  // namespace ovimap
