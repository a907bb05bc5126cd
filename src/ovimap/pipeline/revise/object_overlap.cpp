// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/object_overlap.h"

#include <algorithm>

#include "ovimap/eval/geometry/nearest.h"

namespace ovimap {

namespace {

/// The surface points of all listed objects, and whose each is.
struct LabelledPoints {
  std::vector<Eigen::Vector3f> points;
  std::vector<InstanceId> owner;

  LabelledPoints(const MapRecord& map, const Pose& target_from_map) {
    const Eigen::Isometry3f pose = target_from_map.cast<float>();
    for (const InstanceSummary& instance : map.instances) {
      const auto surface = map.surfaces.find(instance.id);
      if (surface == map.surfaces.end()) continue;
      for (const Eigen::Vector3f& point : surface->second) points.push_back(pose * point);
      owner.resize(points.size(), instance.id);
    }
  }
};

/// How many points of the objects of one map lie at objects of the other.
struct SharedPoints {
  std::map<std::pair<InstanceId, InstanceId>, float> at;  ///< by (object, object of the other)
  std::map<InstanceId, float> anywhere;                   ///< at any object of the other
};

SharedPoints shared_points(const LabelledPoints& from, const LabelledPoints& to,
                           float tolerance_m) {
  SharedPoints counts;
  if (from.points.empty() || to.points.empty()) return counts;
  const auto nearest = NearestPoints(to.points).find_all(from.points, tolerance_m);
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (!nearest[i]) continue;
    ++counts.at[{from.owner[i], to.owner[nearest[i]->index]}];
    ++counts.anywhere[from.owner[i]];
  }
  return counts;
}

float point_count(const MapRecord& map, InstanceId id) {
  return static_cast<float>(map.surfaces.at(id).size());
}

float iou_of(float shared, float points_a, float points_b) {
  return shared / std::max(points_a + points_b - shared, 1.f);
}

}  // namespace

ObjectOverlaps overlaps(const MapRecord& a, const MapRecord& b, const Pose& a_from_b,
                        float tolerance_m) {
  const LabelledPoints in_a(a, Pose::Identity()), in_b(b, a_from_b);
  const SharedPoints of_a = shared_points(in_a, in_b, tolerance_m),
                     of_b = shared_points(in_b, in_a, tolerance_m);
  ObjectOverlaps result;
  for (const auto& [pair, count] : of_a.at)
    result[pair].share_a = count / point_count(a, pair.first);
  for (const auto& [pair, count] : of_b.at)
    result[{pair.second, pair.first}].share_b = count / point_count(b, pair.first);
  const auto common = [](const SharedPoints& points, InstanceId id) {
    const auto found = points.anywhere.find(id);
    return found == points.anywhere.end() ? 0.f : found->second;
  };
  for (auto& [pair, overlap] : result) {
    const float points_a = point_count(a, pair.first), points_b = point_count(b, pair.second);
    const float shared = 0.5f * (overlap.share_a * points_a + overlap.share_b * points_b);
    overlap.shared_points = shared;
    overlap.iou = iou_of(shared, points_a, points_b);
    overlap.common_iou = iou_of(shared, common(of_a, pair.first), common(of_b, pair.second));
  }
  return result;
}

}  // namespace ovimap
