// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/frames/readers/readers.h"
#include "ovimap/frames/recording/folder_parts.h"
#include "ovimap/frames/recording/number_text.h"
#include "ovimap/image/size_limits.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

const Names kMetadata = {"metadata", "metadata.json"};

bool is_record3d(const fs::path& folder) {
  return fs::is_directory(folder / "rgbd") && !find_one(folder, kMetadata, false).empty();
}

/// What the app writes about a recording; all lists have an entry for each frame.
struct Metadata {
  PinholeCamera color_camera;
  int depth_width = 0, depth_height = 0;
  double frames_per_s = kAssumedFramesPerSecond;
  std::vector<std::vector<double>> poses;      ///< qx qy qz qw px py pz
  std::vector<std::vector<float>> intrinsics;  ///< fx fy cx cy; empty in old recordings
  std::vector<double> times_s;                 ///< empty in old recordings
};

Metadata read_metadata(const fs::path& file) {
  const auto document = read_json(file, kLargeDocument);
  Metadata metadata;
  std::vector<float> k;
  try {
    k = document.at("K").get<std::vector<float>>();
    metadata.color_camera.width = document.at("w").get<int>();
    metadata.color_camera.height = document.at("h").get<int>();
    metadata.depth_width = document.at("dw").get<int>();
    metadata.depth_height = document.at("dh").get<int>();
    metadata.frames_per_s = document.value("fps", kAssumedFramesPerSecond);
    metadata.poses = document.value("poses", metadata.poses);
    metadata.intrinsics =
        document.value("perFrameIntrinsicCoeffs", std::vector<std::vector<float>>{});
    metadata.times_s = document.value("frameTimestamps", std::vector<double>{});
  } catch (const nlohmann::json::exception& fault) {
    throw Error(concat(file.string(), " does not describe a Record3D recording (", fault.what(),
                       "); expected are K, w, h, dw and dh"));
  }
  if (k.size() != 9)
    throw Error(concat(file.string(), ": K has ", k.size(),
                       " numbers; accepted are nine, column by column"));
  metadata.color_camera.fx = k[0];
  metadata.color_camera.fy = k[4];
  metadata.color_camera.cx = k[6];
  metadata.color_camera.cy = k[7];
  if (!metadata.color_camera.valid() || metadata.depth_width <= 0 || metadata.depth_height <= 0)
    throw Error(concat(file.string(), ": K, w, h, dw or dh is not above 0"));
  for (const auto& [width, height] :
       {std::pair(metadata.color_camera.width, metadata.color_camera.height),
        std::pair(metadata.depth_width, metadata.depth_height)})
    if (!plausible_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height)))
      throw Error(concat(file.string(), ": images of ", width, "x", height,
                         " are too large; accepted are sides up to ", kLargestSide_px, " and ",
                         kLargestArea_px, " pixels"));
  return metadata;
}

/// Position and rotation may be missing for single frames; then the frame has no pose.
std::optional<Eigen::Matrix4d> pose_of(const std::vector<double>& stored) {
  if (stored.size() != 7) return std::nullopt;
  const double tum[] = {stored[4], stored[5], stored[6], stored[0],
                        stored[1], stored[2], stored[3]};
  return matrix_from_tum(tum);
}

void describe(const Metadata& metadata, std::size_t number, RecordedFrame& frame) {
  frame.timestamp_s = static_cast<double>(number) /
                      (metadata.frames_per_s > 0 ? metadata.frames_per_s : kAssumedFramesPerSecond);
  if (number < metadata.times_s.size()) frame.timestamp_s = metadata.times_s[number];
  if (number < metadata.poses.size()) {
    frame.pose = pose_of(metadata.poses[number]);
    frame.pose_origin = concat("metadata pose ", number);
  }
  if (number >= metadata.intrinsics.size() || metadata.intrinsics[number].size() < 4) return;
  const std::vector<float>& own = metadata.intrinsics[number];
  const PinholeCamera camera{
      metadata.color_camera.width, metadata.color_camera.height, own[0], own[1], own[2], own[3]};
  if (camera.valid()) frame.camera = camera;
}

Recording list_record3d(const fs::path& folder, const FrameSourceConfig&) {
  Recording recording;
  recording.kind = kRecord3dReader.kind;
  recording.folder = folder;
  recording.depth_encoding = DepthEncoding::kMetres;
  const Metadata metadata = read_metadata(find_one(folder, kMetadata, false));
  CameraRig& rig = recording.rig;
  rig.color_camera = metadata.color_camera;
  // Depth is registered to the colour image, at a size of its own.
  rig.depth_camera = metadata.color_camera.scaled_to(metadata.depth_width, metadata.depth_height);
  rig.poses.axes = PoseConvention::Axes::kOpenGl;
  for (const fs::path& color : list_files(folder / "rgbd", {".jpg", ".jpeg", ".png"})) {
    RecordedFrame frame;
    frame.name = color.stem().string();
    frame.color = color;
    frame.depth = fs::path(color).replace_extension(".depth");
    const fs::path confidence = fs::path(color).replace_extension(".conf");
    if (fs::exists(confidence)) frame.confidence = confidence;
    const auto number = parse_numbers(frame.name);
    if (number && number->size() == 1 && number->front() >= 0)
      describe(metadata, static_cast<std::size_t>(number->front()), frame);
    recording.frames.push_back(std::move(frame));
  }
  if (recording.frames.empty())
    throw Error(concat((folder / "rgbd").string(), " holds no .jpg or .png image"));
  return recording;
}

}  // namespace

const Reader kRecord3dReader = {"record3d",
                                "metadata with rgbd/N.jpg and N.depth (Record3D export)",
                                &is_record3d, &list_record3d};

}  // namespace ovimap
