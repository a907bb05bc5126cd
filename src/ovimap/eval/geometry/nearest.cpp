// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/geometry/nearest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {
constexpr std::size_t kPointsOfLeaf = 12;  // below this a scan is faster than a descent
constexpr std::size_t kQueriesPerTask = 512;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
}  // namespace

struct NearestPoints::Best {
  Eigen::Vector3f query;
  float squared_distance;
  std::uint32_t index = kNone;

  void offer(const Entry& entry) {
    const float d = (entry.point - query).squaredNorm();
    if (d < squared_distance || (d == squared_distance && entry.index < index)) {
      squared_distance = d;
      index = entry.index;
    }
  }
};

NearestPoints::NearestPoints(std::span<const Eigen::Vector3f> points) : split_axis_(points.size()) {
  entries_.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    entries_.push_back({points[i], static_cast<std::uint32_t>(i)});
  build(0, entries_.size());
}

void NearestPoints::build(std::size_t begin, std::size_t end) {
  if (end - begin <= kPointsOfLeaf) return;
  Eigen::AlignedBox3f box;
  for (std::size_t i = begin; i < end; ++i) box.extend(entries_[i].point);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) {
    return entries_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(at(begin), at(middle), at(end), [axis](const Entry& a, const Entry& b) {
    return a.point[axis] < b.point[axis];
  });
  split_axis_[middle] = static_cast<std::uint8_t>(axis);
  build(begin, middle);
  build(middle + 1, end);
}

// Rounding is monotone, so a point behind the split plane is never nearer than the plane in floats
// either: pruning with "farther than the best" loses no point and no tie.
void NearestPoints::search(std::size_t begin, std::size_t end, Best& best) const {
  if (end - begin <= kPointsOfLeaf) {
    for (std::size_t i = begin; i < end; ++i) best.offer(entries_[i]);
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  const int axis = split_axis_[middle];
  const float to_plane = best.query[axis] - entries_[middle].point[axis];
  best.offer(entries_[middle]);
  if (to_plane < 0)
    search(begin, middle, best);
  else
    search(middle + 1, end, best);
  if (to_plane * to_plane > best.squared_distance) return;
  if (to_plane < 0)
    search(middle + 1, end, best);
  else
    search(begin, middle, best);
}

std::optional<NearestPoints::Neighbor> NearestPoints::find(const Eigen::Vector3f& query,
                                                           float radius_m) const {
  Best best{query, radius_m * radius_m};
  search(0, entries_.size(), best);
  if (best.index == kNone) return std::nullopt;
  return Neighbor{best.index, std::sqrt(best.squared_distance)};
}

std::vector<std::optional<NearestPoints::Neighbor>> NearestPoints::find_all(
    std::span<const Eigen::Vector3f> queries, float radius_m) const {
  std::vector<std::optional<Neighbor>> found(queries.size());
  parallel_for(queries.size(), kQueriesPerTask,
               [&](std::size_t i) { found[i] = find(queries[i], radius_m); });
  return found;
}

}  // namespace ovimap
