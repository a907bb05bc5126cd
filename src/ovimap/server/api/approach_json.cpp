// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/approach_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace ovimap {

namespace {

using nlohmann::json;

/// To a tenth of a millimetre.
double rounded(float value) {
  constexpr double kSteps = 1e4;
  return std::round(double{value} * kSteps) / kSteps;
}

/// A vector of the grid frame, in the world.
json in_world(const OccupancyGrid& grid, const Eigen::Vector3f& vector) {
  const Eigen::Vector3f turned = grid.grid_from_world.transpose() * vector;
  return {rounded(turned.x()), rounded(turned.y()), rounded(turned.z())};
}

json on_floor(const OccupancyGrid& grid, const Eigen::Vector2f& place) {
  return in_world(grid, {place.x(), place.y(), grid.floor_m});
}

json pose_json(const ApproachPose& pose, const OccupancyGrid& grid) {
  const float level = std::cos(pose.tilt_rad);
  json way = json::array(), way_in_world = json::array();
  for (const Eigen::Vector2f& corner : pose.way) {
    way.push_back({rounded(corner.x()), rounded(corner.y())});
    way_in_world.push_back(on_floor(grid, corner));
  }
  return {{"x", rounded(pose.place_m.x())},
          {"y", rounded(pose.place_m.y())},
          {"yaw", rounded(pose.yaw_rad)},
          {"tilt", rounded(pose.tilt_rad)},
          {"seen", rounded(pose.seen)},
          {"distance_m", rounded(pose.distance_m)},
          {"position", on_floor(grid, pose.place_m)},
          {"direction", in_world(grid, {level * std::cos(pose.yaw_rad),
                                        level * std::sin(pose.yaw_rad), std::sin(pose.tilt_rad)})},
          {"way_m", rounded(pose.way_m)},
          {"way", way},
          {"way_in_world", way_in_world}};
}

}  // namespace

json approach_json(const Approach& approach, const OccupancyGrid& grid) {
  json poses = json::array();
  for (const ApproachPose& pose : approach.poses) poses.push_back(pose_json(pose, grid));
  return {{"poses", poses}, {"reason", approach.reason}};
}

json gaps_json(const std::vector<Gap>& gaps) {
  const auto point = [](const Eigen::Vector3f& at) -> json {
    return {rounded(at.x()), rounded(at.y()), rounded(at.z())};
  };
  json list = json::array();
  for (const Gap& gap : gaps)
    list.push_back({{"kind", gap.kind == GapKind::kUnseen ? "unseen" : "thin"},
                    {"middle", point(gap.middle)},
                    {"box", {{"min", point(gap.box.min())}, {"max", point(gap.box.max())}}},
                    {"area_m2", rounded(gap.area_m2)}});
  return {{"gaps", list}};
}

}  // namespace ovimap
