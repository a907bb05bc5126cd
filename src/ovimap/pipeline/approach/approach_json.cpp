// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/approach/approach_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "ovimap/io/exports/json_values.h"
namespace ovimap {

namespace {

using nlohmann::json;

/// A vector of the grid frame, in the world.
json in_world(const OccupancyGrid& grid, const Eigen::Vector3f& vector) {
  const Eigen::Vector3f turned = grid.grid_from_world.transpose() * vector;
  return rounded_point(turned);
}

json on_floor(const OccupancyGrid& grid, const Eigen::Vector2f& place) {
  return in_world(grid, {place.x(), place.y(), grid.floor_m});
}

json pose_json(const ApproachPose& pose, const OccupancyGrid& grid) {
  const float level = std::cos(pose.tilt_rad);
  json way = json::array(), way_in_world = json::array();
  for (const Eigen::Vector2f& corner : pose.way) {
    way.push_back({rounded_json(corner.x()), rounded_json(corner.y())});
    way_in_world.push_back(on_floor(grid, corner));
  }
  return {{"x", rounded_json(pose.place_m.x())},
          {"y", rounded_json(pose.place_m.y())},
          {"yaw", rounded_json(pose.yaw_rad)},
          {"tilt", rounded_json(pose.tilt_rad)},
          {"seen", rounded_json(pose.seen)},
          {"distance_m", rounded_json(pose.distance_m)},
          {"position", on_floor(grid, pose.place_m)},
          {"direction", in_world(grid, {level * std::cos(pose.yaw_rad),
                                        level * std::sin(pose.yaw_rad), std::sin(pose.tilt_rad)})},
          {"way_m", rounded_json(pose.way_m)},
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
    return {rounded_json(at.x()), rounded_json(at.y()), rounded_json(at.z())};
  };
  json list = json::array();
  for (const Gap& gap : gaps)
    list.push_back({{"kind", gap.kind == GapKind::kUnseen ? "unseen" : "thin"},
                    {"middle", point(gap.middle)},
                    {"box", {{"min", point(gap.box.min())}, {"max", point(gap.box.max())}}},
                    {"area_m2", rounded_json(gap.area_m2)}});
  return {{"gaps", list}};
}

}  // namespace ovimap
