// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/trajectory_file.h"

#include <algorithm>
#include <fstream>
#include <iomanip>

#include "ovimap/base/error.h"
#include "ovimap/frames/recording/trajectory.h"

namespace ovimap {

void write_trajectory(const std::filesystem::path& file, const std::vector<FrameLogEntry>& frames) {
  const bool timed = std::is_sorted(
      frames.begin(), frames.end(), [](const FrameLogEntry& a, const FrameLogEntry& b) {
        return a.timestamp_s <= b.timestamp_s;  // strictly: equal times tell nothing apart
      });
  std::ofstream stream(file);
  stream << std::fixed;
  for (const FrameLogEntry& frame : frames) {
    const Eigen::Vector3d place = frame.world_from_camera.translation();
    const Eigen::Quaterniond turn(frame.world_from_camera.linear());
    if (timed)
      stream << std::setprecision(6) << frame.timestamp_s;
    else
      stream << frame.index;
    stream << std::setprecision(7) << ' ' << place.x() << ' ' << place.y() << ' ' << place.z()
           << ' ' << turn.x() << ' ' << turn.y() << ' ' << turn.z() << ' ' << turn.w() << '\n';
  }
  if (!stream.flush()) throw Error(concat(file.string(), " cannot be written; give another file"));
}

std::vector<TimedPose> read_timed_poses(const std::filesystem::path& file) {
  std::vector<TimedPose> poses;
  for (const TrajectoryPose& line : read_trajectory(file)) {
    const std::string fault = line.matrix && line.time_s ? pose_fault(*line.matrix) : "not there";
    if (!fault.empty())
      throw Error(concat(line.origin, ": the pose is ", fault,
                         "; accepted is 'time tx ty tz qx qy qz qw'"));
    poses.push_back({*line.time_s, rigid_pose(*line.matrix)});
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const TimedPose& a, const TimedPose& b) { return a.time_s < b.time_s; });
  return poses;
}

}  // namespace ovimap
