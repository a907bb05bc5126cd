// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/trajectory.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/frames/recording/number_text.h"

namespace ovimap {

namespace {

TrajectoryPose parse_pose(const TextLine& line, const std::string& file_name) {
  TrajectoryPose pose;
  pose.origin = concat(file_name, " line ", line.number);
  const auto numbers = parse_numbers(line.text);
  if (!numbers) return pose;
  if (numbers->size() == 16 || numbers->size() == 12) pose.matrix = matrix_from_rows(*numbers);
  if (numbers->size() == 8) {
    pose.time_s = numbers->front();
    pose.matrix = matrix_from_tum(numbers->data() + 1);
  }
  return pose;
}

bool usable(const TrajectoryPose& pose) {
  return pose.matrix && pose_fault(*pose.matrix).empty();
}

Pose between(const Pose& from, const Pose& to, double share) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(from.linear())
                      .slerp(share, Eigen::Quaterniond(to.linear()))
                      .toRotationMatrix();
  pose.translation() = (1 - share) * from.translation() + share * to.translation();
  return pose;
}

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& file) {
  Trajectory trajectory;
  bool any_pose = false;
  for (const TextLine& line : read_lines(file)) {
    trajectory.push_back(parse_pose(line, file.filename().string()));
    any_pose |= trajectory.back().matrix.has_value();
  }
  if (!any_pose)
    throw Error(concat(file.string(),
                       " holds no pose; accepted is one a line: 16 numbers (4x4 matrix), 12 "
                       "(KITTI) or 8 (TUM: time tx ty tz qx qy qz qw)"));
  return trajectory;
}

Trajectory read_trajectory_if_needed(const std::filesystem::path& file, PoseNeed need) {
  std::error_code unreadable;
  const bool there = std::filesystem::exists(file, unreadable);
  if (need == PoseNeed::kNone || (need == PoseNeed::kAllOrNone && !there)) return {};
  if (!there)
    throw Error(
        concat("no poses: there is no ", file.string(),
               "; `ovimap run` finds them itself, what else it takes is in docs/sources.md"));
  return read_trajectory(file);
}

PoseTimeline::PoseTimeline(const Trajectory& trajectory) {
  for (const TrajectoryPose& pose : trajectory)
    if (pose.time_s && std::isfinite(*pose.time_s)) by_time_.emplace_back(*pose.time_s, &pose);
  std::stable_sort(by_time_.begin(), by_time_.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
}

const TrajectoryPose* PoseTimeline::nearest(double time_s, double max_gap_s) const {
  const auto after =
      std::lower_bound(by_time_.begin(), by_time_.end(), time_s,
                       [](const auto& pose, double time) { return pose.first < time; });
  const TrajectoryPose* nearest = nullptr;
  double smallest_s = max_gap_s;
  for (const auto candidate : {after == by_time_.begin() ? by_time_.end() : after - 1, after}) {
    if (candidate == by_time_.end() || std::abs(candidate->first - time_s) > smallest_s) continue;
    smallest_s = std::abs(candidate->first - time_s);
    nearest = candidate->second;
  }
  return nearest;
}

std::optional<TrajectoryPose> PoseTimeline::at(double time_s, double max_gap_s) const {
  const TrajectoryPose* near = nearest(time_s, max_gap_s);
  if (!near) return std::nullopt;
  const auto after =
      std::lower_bound(by_time_.begin(), by_time_.end(), time_s,
                       [](const auto& pose, double time) { return pose.first < time; });
  if (after == by_time_.begin() || after == by_time_.end()) return *near;
  const auto before = after - 1;
  const double gap_s = after->first - before->first;
  const bool bracketed = time_s - before->first <= max_gap_s && after->first - time_s <= max_gap_s;
  if (!bracketed || gap_s <= 0 || !usable(*before->second) || !usable(*after->second)) return *near;
  TrajectoryPose pose = *near;
  pose.matrix = between(rigid_pose(*before->second->matrix), rigid_pose(*after->second->matrix),
                        (time_s - before->first) / gap_s)
                    .matrix();
  return pose;
}

void assign_by_line(const Trajectory& trajectory, const std::vector<std::int64_t>& numbers,
                    std::vector<RecordedFrame>& frames) {
  OVIMAP_ASSERT(numbers.size() == frames.size());
  const bool in_order = trajectory.size() == frames.size();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto line = in_order ? static_cast<std::int64_t>(i) : numbers[i];
    if (line < 0 || line >= static_cast<std::int64_t>(trajectory.size())) continue;
    frames[i].pose = trajectory[static_cast<std::size_t>(line)].matrix;
    frames[i].pose_origin = trajectory[static_cast<std::size_t>(line)].origin;
  }
}

}  // namespace ovimap
