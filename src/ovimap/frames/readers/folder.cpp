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

const Names kColorFolders = {"color", "rgb", "image", "images", "colour"};
const Names kDepthFolders = {"depth", "depths"};
const Names kPoseFolders = {"pose", "poses"};
const Names kPoseFiles = {"poses.txt", "traj.txt", "trajectory.txt", "groundtruth.txt", "pose.txt"};
const Names kDepthIntrinsics = {
    "intrinsic/intrinsic_depth.txt", "intrinsics.txt",        "intrinsic.txt",
    "camera-intrinsics.txt",         "camera_intrinsics.txt", "K.txt"};
const Names kColorIntrinsics = {"intrinsic/intrinsic_color.txt"};

bool is_plain_folder(const fs::path& folder) {
  return !find_one(folder, kColorFolders, true).empty() &&
         !find_one(folder, kDepthFolders, true).empty();
}

/// With times a line belongs to the frame whose file name is that time; without, to the frame of
/// its rank or, when there are more lines than frames, to the frame whose file name is its number
/// (from 0).
void assign_trajectory(const Trajectory& trajectory, double max_gap_s,
                       std::vector<RecordedFrame>& frames) {
  const PoseTimeline timeline(trajectory);
  const auto lines = static_cast<double>(trajectory.size());
  std::vector<std::int64_t> numbers;
  std::size_t near = 0;
  bool numbered = true;
  std::vector<RecordedFrame> by_time = frames;
  for (RecordedFrame& frame : by_time) {
    const auto stem = parse_numbers(frame.name);
    const double number = stem && stem->size() == 1 ? stem->front() : -1;
    numbered &= number >= 0 && number < lines;
    numbers.push_back(numbered ? static_cast<std::int64_t>(number) : -1);
    if (number < 0 || timeline.empty()) continue;
    if (const auto pose = timeline.at(number, max_gap_s)) {
      frame.timestamp_s = number;
      frame.pose = pose->matrix;
      frame.pose_origin = pose->origin;
      ++near;
    }
  }
  // Names that count 0, 1, 2 ... hit a time by chance now and then. They are times when nearly all
  // hit, or when most do and the lines are not one for each image.
  const bool as_many = trajectory.size() == frames.size();
  if (near * 10 >= frames.size() * 9 || (!as_many && near * 2 > frames.size())) {
    frames = std::move(by_time);
    return;
  }
  if (trajectory.size() != frames.size() && (!numbered || !timeline.empty()))
    throw Error(concat(frames.front().color.parent_path().string(), " has ", frames.size(),
                       " images, but the pose file ", trajectory.size(),
                       " lines; give one line for each ",
                       "image, or name the images by the times in the pose file"));
  assign_by_line(trajectory, numbers, frames);
}

void find_poses(const fs::path& folder, const FrameSourceConfig& config,
                const std::vector<fs::path>& colors, std::vector<RecordedFrame>& frames) {
  if (const fs::path pose_folder = find_one(folder, kPoseFolders, true); !pose_folder.empty()) {
    const std::vector<fs::path> files = partner_files(colors, pose_folder, ".txt");
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i].pose_file = files[i];
  } else if (const fs::path pose_file = find_one(folder, kPoseFiles, false); !pose_file.empty()) {
    assign_trajectory(read_trajectory(pose_file), config.max_time_gap_s, frames);
  } else if (config.poses == PoseNeed::kAll) {
    throw Error(concat(
        folder.string(), ": no poses; give poses.txt (a line for each image: 16 numbers, 12 as ",
        "KITTI, or 'time tx ty tz qx qy qz qw' as TUM) or poses/NAME.txt with 4x4 matrices, ",
        "world_from_camera; `ovimap run` finds them itself"));
  }
}

Recording list_plain_folder(const fs::path& folder, const FrameSourceConfig& config) {
  Recording recording;
  recording.kind = kFolderReader.kind;
  recording.folder = folder;
  const fs::path color_folder = find_one(folder, kColorFolders, true);
  const std::vector<fs::path> colors = list_files(color_folder, {".jpg", ".jpeg", ".png"});
  if (colors.empty()) throw Error(concat(color_folder.string(), " holds no .jpg or .png image"));
  const std::vector<fs::path> depths =
      partner_files(colors, find_one(folder, kDepthFolders, true), ".png");
  for (std::size_t i = 0; i < colors.size(); ++i) {
    RecordedFrame frame;
    frame.name = colors[i].stem().string();
    frame.timestamp_s = static_cast<double>(i) / kAssumedFramesPerSecond;
    frame.color = colors[i];
    frame.depth = depths[i];
    recording.frames.push_back(std::move(frame));
  }
  if (config.poses != PoseNeed::kNone) find_poses(folder, config, colors, recording.frames);
  if (const fs::path file = find_one(folder, kDepthIntrinsics, false); !file.empty())
    read_text_intrinsics(file, recording.rig.depth_camera);
  if (const fs::path file = find_one(folder, kColorIntrinsics, false); !file.empty())
    read_text_intrinsics(file, recording.rig.color_camera);
  return recording;
}

}  // namespace

const Reader kFolderReader = {
    "folder", "folders color (or rgb, images) and depth, with poses and camera.yaml",
    &is_plain_folder, &list_plain_folder};

}  // namespace ovimap
