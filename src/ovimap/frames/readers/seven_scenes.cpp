// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <map>

#include "ovimap/frames/readers/readers.h"

namespace ovimap {

namespace {

constexpr std::string_view kPrefix = "frame-";

/// The NNNNNN of "frame-NNNNNN.color.jpg" and its kin; nullopt for any other file.
std::optional<std::int64_t> frame_number(const std::string& file_name) {
  if (!file_name.starts_with(kPrefix)) return std::nullopt;
  const char* begin = file_name.data() + kPrefix.size();
  const char* end = file_name.data() + file_name.size();
  std::int64_t number = 0;
  const auto [rest, error] = std::from_chars(begin, end, number);
  if (error != std::errc() || number < 0) return std::nullopt;
  const std::string_view suffix(rest, static_cast<std::size_t>(end - rest));
  const bool known = suffix == ".color.jpg" || suffix == ".color.png" || suffix == ".depth.png" ||
                     suffix == ".pose.txt";
  return known ? std::optional(number) : std::nullopt;
}

bool is_seven_scenes(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (frame_number(entry.path().filename().string())) return true;
  return false;
}

RecordedFrame record(const std::filesystem::path& folder, const std::string& stem,
                     std::int64_t number, bool color_is_png) {
  RecordedFrame frame;
  frame.name = stem + ".color";
  frame.timestamp_s = static_cast<double>(number) / kAssumedFramesPerSecond;
  frame.color = folder / (frame.name + (color_is_png ? ".png" : ".jpg"));
  frame.depth = folder / (stem + ".depth.png");
  frame.pose_file = folder / (stem + ".pose.txt");
  return frame;
}

Recording list_seven_scenes(const std::filesystem::path& folder, const FrameSourceConfig&) {
  Recording recording;
  recording.kind = kSevenScenesReader.kind;
  recording.folder = folder;
  recording.rig.depth_camera = recording.rig.color_camera = {640, 480, 585.f, 585.f, 320.f, 240.f};
  recording.rig.depth_units_per_m = 1000;
  recording.rig.invalid_depth = {0, 65535};

  struct Listed {
    std::string stem;
    bool color_is_png = false;
  };
  std::map<std::int64_t, Listed> listed;  // a frame counts as soon as one of its files is there
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const auto number = frame_number(name);
    if (!number) continue;
    Listed& frame = listed[*number];
    frame.stem = name.substr(0, name.find('.'));
    frame.color_is_png |= name.ends_with(".color.png");
  }
  for (const auto& [number, frame] : listed)
    recording.frames.push_back(record(folder, frame.stem, number, frame.color_is_png));
  return recording;
}

}  // namespace

const Reader kSevenScenesReader = {
    "7scenes", "frame-NNNNNN.color.jpg (or .png), .depth.png and .pose.txt (7-Scenes)",
    &is_seven_scenes, &list_seven_scenes};

}  // namespace ovimap
