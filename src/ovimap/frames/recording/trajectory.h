// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "ovimap/frames/recording/recording.h"

namespace ovimap {

/// One line of a file of poses. `matrix` is as stored, unchecked; absent when the line holds none.
struct TrajectoryPose {
  std::optional<double> time_s;
  std::optional<Eigen::Matrix4d> matrix;
  std::string origin;  ///< "traj.txt line 7"
};
using Trajectory = std::vector<TrajectoryPose>;

/// Reads one pose a line: 16 numbers (4x4 row by row), 12 numbers (KITTI, upper three rows) or 8
/// (TUM: time tx ty tz qx qy qz qw). Throws Error when the file cannot be read or holds no pose at
/// all.
Trajectory read_trajectory(const std::filesystem::path& file);

/// The same; empty where poses are not needed, or may be missing and the file is.
Trajectory read_trajectory_if_needed(const std::filesystem::path& file, PoseNeed need);

/// The poses of a trajectory by time.
class PoseTimeline {
 public:
  explicit PoseTimeline(const Trajectory& trajectory);  ///< must outlive the timeline
  bool empty() const { return by_time_.empty(); }

  /// The pose nearest in time and at most `max_gap_s` away; nullptr when there is none.
  const TrajectoryPose* nearest(double time_s, double max_gap_s) const;
  /// The pose at a time: between the two around it, each at most `max_gap_s` away, in proportion;
  /// the nearest where only one is, nullopt where none is. Keeps the nearest's origin.
  std::optional<TrajectoryPose> at(double time_s, double max_gap_s) const;

 private:
  std::vector<std::pair<double, const TrajectoryPose*>> by_time_;
};

/// Gives each frame its line: the n-th when there are as many lines as frames, else the line of the
/// frame's own `number` (from 0). Frames beyond the last line get none.
void assign_by_line(const Trajectory& trajectory, const std::vector<std::int64_t>& numbers,
                    std::vector<RecordedFrame>& frames);

}  // namespace ovimap
