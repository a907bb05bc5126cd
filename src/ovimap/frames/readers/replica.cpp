// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <map>

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/frames/readers/readers.h"
#include "ovimap/frames/recording/number_text.h"
#include "ovimap/frames/recording/trajectory.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kColor = "frame", kDepth = "depth";

/// The N of an image "frameN" or "depthN"; nullopt for any other file.
std::optional<std::int64_t> number_of(const fs::path& file, std::string_view prefix) {
  const std::string stem = file.stem().string();
  if (!stem.starts_with(prefix) || (file.extension() != ".jpg" && file.extension() != ".png"))
    return std::nullopt;
  std::int64_t number = 0;
  const char* end = stem.data() + stem.size();
  const auto [rest, error] = std::from_chars(stem.data() + prefix.size(), end, number);
  return error == std::errc() && rest == end && number >= 0 ? std::optional(number) : std::nullopt;
}

bool is_replica(const fs::path& folder) {
  if (!fs::is_directory(folder / "results")) return false;
  for (const auto& entry : fs::directory_iterator(folder / "results"))
    if (number_of(entry.path(), kColor)) return true;
  return false;
}

fs::path find_camera_file(const fs::path& folder) {
  const fs::path inside = folder / "cam_params.json";
  const fs::path beside = fs::canonical(folder).parent_path() / "cam_params.json";
  for (const fs::path& file : {inside, beside})
    if (fs::exists(file)) return file;
  throw Error(
      concat(folder.string(), ": no cam_params.json in it or in the folder above; it reads ",
             R"({"camera": {"w": 1200, "h": 680, "fx": 600, "fy": 600, "cx": 599.5, "cy": 339.5, )",
             R"("scale": 6553.5}})"));
}

CameraRig read_rig(const fs::path& file) {
  const auto document = read_json(file, kSmallDocument);
  CameraRig rig;
  try {
    const auto& camera = document.at("camera");
    rig.depth_camera = {camera.at("w").get<int>(),    camera.at("h").get<int>(),
                        camera.at("fx").get<float>(), camera.at("fy").get<float>(),
                        camera.at("cx").get<float>(), camera.at("cy").get<float>()};
    rig.depth_units_per_m = camera.at("scale").get<double>();
  } catch (const nlohmann::json::exception& fault) {
    throw Error(concat(file.string(), " is not a camera description (", fault.what(),
                       R"(); expected {"camera": {"w", "h", "fx", "fy", "cx", "cy", "scale"}})"));
  }
  if (!(rig.depth_units_per_m > 0))
    throw Error(
        concat(file.string(), ": scale is ", rig.depth_units_per_m, "; it must be above 0"));
  if (!rig.depth_camera.valid())
    throw Error(concat(file.string(),
                       ": w, h, fx, fy, cx and cy are of no camera; sizes and focal ",
                       "lengths lie above 0"));
  rig.color_camera = rig.depth_camera;
  return rig;
}

/// The times in seconds of frames 0, 1, ...; none where the recording does not say.
std::vector<double> read_times(const fs::path& file) {
  if (!fs::exists(file)) return {};
  auto times = read_numbers(file);
  if (!times)
    throw Error(concat(file.string(), " holds other text than a time in seconds on each line"));
  return std::move(*times);
}

Recording list_replica(const fs::path& folder, const FrameSourceConfig& config) {
  Recording recording;
  recording.kind = kReplicaReader.kind;
  recording.folder = folder;
  recording.rig = read_rig(find_camera_file(folder));

  std::map<std::int64_t, fs::path> colors;
  std::map<std::int64_t, std::string> digits_of;  // of either image: one may be lost
  for (const auto& entry : fs::directory_iterator(folder / "results")) {
    const fs::path& file = entry.path();
    for (const std::string_view prefix : {kColor, kDepth})
      if (const auto number = number_of(file, prefix))
        digits_of[*number] = file.stem().string().substr(prefix.size());
    if (const auto number = number_of(file, kColor)) colors[*number] = file;
  }
  const std::vector<double> times = read_times(folder / "timestamps.txt");
  std::vector<std::int64_t> numbers;
  for (const auto& [number, digits] : digits_of) {
    RecordedFrame frame;
    frame.name = concat(kColor, digits);
    frame.timestamp_s = number < std::ssize(times)
                            ? times[static_cast<std::size_t>(number)]
                            : static_cast<double>(number) / kAssumedFramesPerSecond;
    const auto color = colors.find(number);
    frame.color =
        color != colors.end() ? color->second : folder / "results" / (frame.name + ".jpg");
    frame.depth = folder / "results" / ("depth" + digits + ".png");
    const fs::path truth = folder / "results" / ("instance" + digits + ".png");
    if (fs::exists(truth)) frame.truth = truth;
    recording.frames.push_back(std::move(frame));
    numbers.push_back(number);
  }
  assign_by_line(read_trajectory_if_needed(folder / "traj.txt", config.poses), numbers,
                 recording.frames);
  return recording;
}

}  // namespace

const Reader kReplicaReader = {
    "replica",
    "results/frameNNNNNN.jpg and depthNNNNNN.png with traj.txt and cam_params.json (Replica)",
    &is_replica, &list_replica};

}  // namespace ovimap
