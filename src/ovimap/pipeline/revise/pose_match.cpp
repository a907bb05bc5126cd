// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/pose_match.h"

#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/frames/recording/trajectory.h"

namespace ovimap {

namespace {

/// The pose of a frame; nullopt: it has none.
class Lines {
 public:
  Lines(const Trajectory& trajectory, std::size_t frames, double max_gap_s)
      : trajectory_(trajectory),
        timeline_(trajectory),
        in_order_(trajectory.size() == frames),
        max_gap_s_(max_gap_s) {}

  std::optional<TrajectoryPose> of(const FrameLogEntry& frame, std::size_t position) const {
    if (!timeline_.empty()) return timeline_.at(frame.timestamp_s, max_gap_s_);
    const std::int64_t line = in_order_ ? static_cast<std::int64_t>(position) : frame.index;
    if (line < 0 || line >= static_cast<std::int64_t>(trajectory_.size())) return std::nullopt;
    return trajectory_[static_cast<std::size_t>(line)];
  }

  bool by_time() const { return !timeline_.empty(); }

 private:
  const Trajectory& trajectory_;
  PoseTimeline timeline_;
  bool in_order_;
  double max_gap_s_;
};

}  // namespace

std::vector<Pose> match_poses(const std::vector<FrameLogEntry>& frames,
                              const std::filesystem::path& file, double max_gap_s) {
  const Trajectory trajectory = read_trajectory(file);
  const Lines lines(trajectory, frames.size(), max_gap_s);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameLogEntry& frame = frames[i];
    const std::optional<TrajectoryPose> line = lines.of(frame, i);
    if (!line && lines.by_time())
      throw Error(concat("frame '", frame.name, "' of the map was taken at ", frame.timestamp_s,
                         " s, and ", file.string(), " has no pose within ", max_gap_s,
                         " s of that; give the poses of this recording, or a wider --max-gap"));
    if (!line)
      throw Error(concat("frame '", frame.name, "' of the map is number ", frame.index,
                         " of its recording, and ", file.string(), " has ", trajectory.size(),
                         " lines; give a pose for each of the map's ", frames.size(),
                         " frames, or for each frame of the recording"));
    const std::string fault = line->matrix ? pose_fault(*line->matrix) : "not there";
    if (!fault.empty())
      throw Error(concat("the pose of frame '", frame.name, "' (", line->origin, ") is ", fault,
                         "; mend that line"));
    poses.push_back(rigid_pose(*line->matrix));
  }
  return poses;
}

}  // namespace ovimap
