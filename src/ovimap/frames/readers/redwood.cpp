// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/frames/readers/readers.h"
#include "ovimap/frames/recording/folder_parts.h"
#include "ovimap/frames/recording/number_text.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

const Names kRedwoodColorFolders = {"color", "image", "rgb"};
const Names kTrajectories = {"trajectory.log", "scene/trajectory.log"};
const Names kIntrinsics = {"camera_intrinsic.json", "intrinsic.json"};

/// trajectory.log, or the folder's only .log file; empty when there is none.
fs::path find_log(const fs::path& folder) {
  if (const fs::path named = find_one(folder, kTrajectories, false); !named.empty()) return named;
  const std::vector<fs::path> logs = list_files(folder, {".log"});
  return logs.size() == 1 ? logs.front() : fs::path();
}

bool is_redwood(const fs::path& folder) {
  return !find_one(folder, kRedwoodColorFolders, true).empty() &&
         fs::is_directory(folder / "depth") && !find_log(folder).empty();
}

struct LogPose {
  double number = 0;  ///< the third of the item's three: the image's rank, from 1
  Eigen::Matrix4d world_from_camera;
  std::string origin;
};

/// Five lines a pose: three whole numbers, then a 4x4 matrix.
std::vector<LogPose> read_log(const fs::path& file) {
  constexpr std::size_t kLinesPerPose = 5;
  const std::vector<TextLine> lines = read_lines(file);
  std::vector<LogPose> poses;
  std::vector<double> matrix;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool is_first = i % kLinesPerPose == 0;
    const auto numbers = parse_numbers(lines[i].text);
    if (!numbers || numbers->size() != (is_first ? 3 : 4))
      throw Error(concat(file.string(), " line ", lines[i].number, " is '", lines[i].text,
                         "'; expected ", is_first ? "three numbers" : "a row of a 4x4 matrix",
                         " (a pose has five lines: three numbers and a 4x4 matrix)"));
    if (is_first) {
      matrix.clear();
      poses.push_back({(*numbers)[2], Eigen::Matrix4d::Identity(),
                       concat(file.filename().string(), " line ", lines[i].number)});
    } else {
      matrix.insert(matrix.end(), numbers->begin(), numbers->end());
      if (matrix.size() == 16) poses.back().world_from_camera = matrix_from_rows(matrix);
    }
  }
  if (poses.empty() || lines.size() % kLinesPerPose != 0)
    throw Error(concat(file.string(), " has ", lines.size(),
                       " lines; a pose has five: three numbers and a 4x4 matrix"));
  return poses;
}

/// The numbers count images when they are distinct whole numbers from 1; files that use them for
/// something else give their poses in order.
bool numbers_are_ranks(const std::vector<LogPose>& poses) {
  std::set<double> seen;
  return std::all_of(poses.begin(), poses.end(), [&](const LogPose& pose) {
    return pose.number >= 1 && pose.number == std::floor(pose.number) &&
           seen.insert(pose.number).second;
  });
}

void assign_poses(const fs::path& file, std::vector<RecordedFrame>& frames) {
  const std::vector<LogPose> poses = read_log(file);
  const bool ranked = numbers_are_ranks(poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double rank = ranked ? poses[i].number - 1 : static_cast<double>(i);
    if (rank >= static_cast<double>(frames.size()))
      throw Error(concat(file.string(), " has a pose for image ", rank + 1, ", but there are only ",
                         frames.size(), " images; give all images that the poses belong to"));
    RecordedFrame& frame = frames[static_cast<std::size_t>(rank)];
    frame.pose = poses[i].world_from_camera;
    frame.pose_origin = poses[i].origin;
  }
}

/// Open3D writes the matrix column by column: fx, 0, 0, 0, fy, 0, cx, cy, 1.
PinholeCamera read_redwood_camera(const fs::path& file) {
  const auto document = read_json(file, kSmallDocument);
  try {
    const auto k = document.at("intrinsic_matrix").get<std::vector<float>>();
    if (k.size() != 9) throw std::invalid_argument("camera");
    PinholeCamera camera{
        document.value("width", 0), document.value("height", 0), k[0], k[4], k[6], k[7]};
    if (!(camera.fx > 0) || !(camera.fy > 0)) throw std::invalid_argument("camera");
    return camera;
  } catch (const std::exception&) {
    throw Error(concat(file.string(),
                       " is no camera of Open3D; expected {\"width\": 640, \"height\": 480, "
                       "\"intrinsic_matrix\": [525, 0, 0, 0, 525, 0, 319.5, 239.5, 1]}"));
  }
}

Recording list_redwood(const fs::path& folder, const FrameSourceConfig&) {
  Recording recording;
  recording.kind = kRedwoodReader.kind;
  recording.folder = folder;
  recording.rig.depth_camera = {640, 480, 525.f, 525.f, 319.5f, 239.5f};  // PrimeSense
  if (const fs::path file = find_one(folder, kIntrinsics, false); !file.empty())
    recording.rig.depth_camera = read_redwood_camera(file);
  recording.rig.color_camera = recording.rig.depth_camera;
  const fs::path color_folder = find_one(folder, kRedwoodColorFolders, true);
  const std::vector<fs::path> colors = list_files(color_folder, {".jpg", ".jpeg", ".png"});
  if (colors.empty()) throw Error(concat(color_folder.string(), " holds no .jpg or .png image"));
  const std::vector<fs::path> depths = partner_files(colors, folder / "depth", ".png");
  for (std::size_t i = 0; i < colors.size(); ++i) {
    RecordedFrame frame;
    frame.name = colors[i].stem().string();
    frame.timestamp_s = static_cast<double>(i) / kAssumedFramesPerSecond;
    frame.color = colors[i];
    frame.depth = depths[i];
    recording.frames.push_back(std::move(frame));
  }
  assign_poses(find_log(folder), recording.frames);
  return recording;
}

}  // namespace

const Reader kRedwoodReader = {
    "redwood", "folders color (or image) and depth with trajectory.log (Redwood, Open3D)",
    &is_redwood, &list_redwood};

}  // namespace ovimap
