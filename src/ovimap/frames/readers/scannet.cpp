// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/error.h"
#include "ovimap/frames/readers/readers.h"
#include "ovimap/frames/recording/folder_parts.h"
#include "ovimap/frames/recording/number_text.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

bool is_scannet(const fs::path& folder) {
  for (const char* part : {"color", "depth", "pose", "intrinsic"})
    if (!fs::is_directory(folder / part)) return false;
  return true;
}

PinholeCamera read_scannet_camera(const fs::path& file) {
  if (!fs::is_regular_file(file))
    throw Error(concat(file.string(),
                       " is missing; a ScanNet export has intrinsic/intrinsic_color.txt and "
                       "intrinsic_depth.txt with a 4x4 matrix each"));
  PinholeCamera camera;
  read_text_intrinsics(file, camera);
  if (!(camera.fx > 0) || !(camera.fy > 0))
    throw Error(concat(file.string(), ": focal lengths are ", camera.fx, " and ", camera.fy,
                       "; both must be above 0"));
  return camera;
}

/// The identity when there is no such file.
Pose read_extrinsic(const fs::path& file) {
  if (!fs::is_regular_file(file)) return Pose::Identity();
  const auto numbers = read_numbers(file);
  if (!numbers || numbers->size() != 16)
    throw Error(concat(file.string(), " does not hold a 4x4 matrix"));
  const Eigen::Matrix4d matrix = matrix_from_rows(*numbers);
  if (const std::string fault = pose_fault(matrix); !fault.empty())
    throw Error(concat(file.string(), " holds no rigid transform (", fault, ")"));
  return rigid_pose(matrix);
}

/// The published 2D annotation, whose values are object ids from 1; the filtered one goes first.
fs::path find_truth(const fs::path& folder, const std::string& name) {
  for (const char* part : {"instance-filt", "instance"})
    if (fs::path file = folder / part / (name + ".png"); fs::exists(file)) return file;
  return {};
}

Recording list_scannet(const fs::path& folder, const FrameSourceConfig&) {
  Recording recording;
  recording.kind = kScanNetReader.kind;
  recording.folder = folder;
  CameraRig& rig = recording.rig;
  const fs::path cameras = folder / "intrinsic";
  rig.depth_camera = read_scannet_camera(cameras / "intrinsic_depth.txt");
  rig.color_camera = read_scannet_camera(cameras / "intrinsic_color.txt");
  // Each extrinsic leads into a frame common to both cameras: the toolkit projects a depth point
  // into the colour image by extrinsic_depth alone, with extrinsic_color the identity.
  rig.color_from_depth = read_extrinsic(cameras / "extrinsic_color.txt").inverse() *
                         read_extrinsic(cameras / "extrinsic_depth.txt");
  const std::vector<fs::path> colors = list_files(folder / "color", {".jpg", ".jpeg", ".png"});
  if (colors.empty())
    throw Error(concat((folder / "color").string(), " holds no .jpg or .png image"));
  for (const fs::path& color : colors) {
    RecordedFrame frame;
    frame.name = color.stem().string();
    frame.timestamp_s = static_cast<double>(recording.frames.size()) / kAssumedFramesPerSecond;
    if (const auto number = parse_numbers(frame.name); number && number->size() == 1)
      frame.timestamp_s = number->front() / kAssumedFramesPerSecond;
    frame.color = color;
    frame.depth = folder / "depth" / (frame.name + ".png");
    frame.pose_file = folder / "pose" / (frame.name + ".txt");
    frame.truth = find_truth(folder, frame.name);
    recording.frames.push_back(std::move(frame));
  }
  return recording;
}

}  // namespace

const Reader kScanNetReader = {"scannet",
                               "folders color, depth, pose and intrinsic (ScanNet export)",
                               &is_scannet, &list_scannet};

}  // namespace ovimap
