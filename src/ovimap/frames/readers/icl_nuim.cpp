// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/error.h"
#include "ovimap/frames/readers/readers.h"
#include "ovimap/frames/recording/folder_parts.h"
#include "ovimap/frames/recording/number_text.h"
#include "ovimap/frames/recording/trajectory.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

constexpr double kSameNumber = 0.25;  ///< the file's times are frame numbers

/// "livingRoom2.gt.freiburg", "livingRoom2n.gt.freiburg" or "traj2.gt.freiburg"; empty: none.
fs::path find_ground_truth(const fs::path& folder) {
  const std::vector<fs::path> files = list_files(folder, {".freiburg"});
  return files.empty() ? fs::path() : files.front();
}

bool is_icl_nuim(const fs::path& folder) {
  return fs::is_directory(folder / "rgb") && fs::is_directory(folder / "depth") &&
         !find_ground_truth(folder).empty();
}

/// The renderer works in left-handed frames: both the world and the camera have x right, y up and z
/// forward, hence the published fy of -480. Turning y over in the camera alone would leave a
/// reflection, which is no rigid transform and shows the room mirrored; turning it over in both
/// frames keeps a rotation a rotation, gives fy = 480, and makes the room as it is seen.
Eigen::Matrix4d right_handed(const Eigen::Matrix4d& left_handed) {
  const Eigen::DiagonalMatrix<double, 4> turn_y_over(1, -1, 1, 1);
  return turn_y_over * left_handed * turn_y_over;
}

Recording list_icl_nuim(const fs::path& folder, const FrameSourceConfig&) {
  Recording recording;
  recording.kind = kIclNuimReader.kind;
  recording.folder = folder;
  recording.rig.depth_camera =
      recording.rig.color_camera = {640, 480, 481.2f, 480.f, 319.5f, 239.5f};
  recording.rig.depth_units_per_m = 5000;
  const Trajectory trajectory = read_trajectory(find_ground_truth(folder));
  const PoseTimeline timeline(trajectory);
  for (const fs::path& color : list_files(folder / "rgb", {".png"})) {
    RecordedFrame frame;
    frame.name = color.stem().string();
    frame.color = color;
    frame.depth = folder / "depth" / color.filename();
    const auto number = parse_numbers(frame.name);
    if (!number || number->size() != 1) {
      frame.fault = concat(color.filename().string(), ": is not named by a frame number");
    } else {
      frame.timestamp_s = number->front() / kAssumedFramesPerSecond;
      const TrajectoryPose* pose = timeline.nearest(number->front(), kSameNumber);
      if (pose != nullptr && pose->matrix) frame.pose = right_handed(*pose->matrix);
      if (pose != nullptr) frame.pose_origin = pose->origin;
    }
    recording.frames.push_back(std::move(frame));
  }
  if (recording.frames.empty())
    throw Error(concat((folder / "rgb").string(), " holds no .png image"));
  return recording;
}

}  // namespace

const Reader kIclNuimReader = {"icl-nuim", "rgb/N.png, depth/N.png and *.gt.freiburg (ICL-NUIM)",
                               &is_icl_nuim, &list_icl_nuim};

}  // namespace ovimap
