// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/thing_look.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ovimap/eval/geometry/nearest.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/map/rays/surface_lookup.h"

namespace ovimap {

namespace {

constexpr int kTurns = 36;
constexpr double kNearShare = 0.8;  // of the points; the others were hidden from the other visit
constexpr std::size_t kMostPoints = 400;

/// The colours of a map's voxels at points.
std::array<float, 64> colors_at(const VoxelMap& map, const std::vector<Eigen::Vector3f>& points) {
  std::array<float, 64> shares{};
  VoxelFinder finder(map);
  float known = 0;
  for (const Eigen::Vector3f& point : points) {
    if (!finder.seek(point)) continue;
    const auto v = static_cast<std::size_t>(finder.voxel());
    std::size_t cell = 0;
    int sum = 0;
    for (const auto& channel : finder.block().color) {
      cell = 4 * cell + (channel[v] >> 14);
      sum += channel[v];
    }
    if (sum == 0) continue;
    shares[cell] += 1;
    known += 1;
  }
  for (float& share : shares) share /= std::max(known, 1.f);
  return shares;
}

/// Mean distance of the nearer points of `from`, turned, to `to`.
double distance_to(const std::vector<Eigen::Vector3f>& from, const NearestPoints& to,
                   const Eigen::Matrix3f& turn, float most_m) {
  std::vector<double> distances;
  for (const Eigen::Vector3f& point : from) {
    const auto near = to.find(turn * point, most_m);
    distances.push_back(static_cast<double>(near ? near->distance_m : most_m));
  }
  const auto kept =
      static_cast<std::ptrdiff_t>(std::ceil(kNearShare * static_cast<double>(distances.size())));
  std::nth_element(distances.begin(), distances.begin() + kept - 1, distances.end());
  double sum = 0;
  for (auto distance = distances.begin(); distance != distances.begin() + kept; ++distance)
    sum += *distance;
  return sum / static_cast<double>(kept);
}

}  // namespace

ThingLook thing_look(const MapDocument& map, InstanceId id, const Eigen::Vector3f& up) {
  ThingLook look;
  const auto surface = map.surfaces.find(id);
  if (surface == map.surfaces.end() || surface->second.empty()) return look;
  look.colors = colors_at(map.map, surface->second);
  map.map.trim();
  const std::size_t step = (surface->second.size() + kMostPoints - 1) / kMostPoints;
  const Eigen::Matrix3f upright = shortest_turn(up, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < surface->second.size(); i += step) {
    look.points.push_back(upright * surface->second[i]);
    mean += look.points.back();
  }
  mean /= static_cast<float>(look.points.size());
  float squares = 0;
  for (Eigen::Vector3f& point : look.points) squares += (point -= mean).squaredNorm();
  look.reach_m = std::sqrt(squares / static_cast<float>(look.points.size()));
  return look;
}

float shape_distance(const ThingLook& a, const ThingLook& b) {
  const float reach_m = std::max(a.reach_m, b.reach_m);
  if (a.points.empty() || b.points.empty() || reach_m <= 0.f) return 1.f;
  const NearestPoints in_a(a.points), in_b(b.points);
  double best = static_cast<double>(reach_m);
  for (int i = 0; i < kTurns; ++i) {
    const auto angle = static_cast<float>(2 * std::numbers::pi * i / kTurns);
    const Eigen::Matrix3f turn =
        Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()).toRotationMatrix();
    best = std::min(best, std::max(distance_to(a.points, in_b, turn, reach_m),
                                   distance_to(b.points, in_a, turn.transpose(), reach_m)));
  }
  return static_cast<float>(best) / reach_m;
}

float common_colors(const ThingLook& a, const ThingLook& b) {
  float common = 0, in_a = 0, in_b = 0;
  for (std::size_t i = 0; i < a.colors.size(); ++i) {
    common += std::min(a.colors[i], b.colors[i]);
    in_a += a.colors[i];
    in_b += b.colors[i];
  }
  return in_a == 0.f || in_b == 0.f ? 1.f : common;
}

}  // namespace ovimap
