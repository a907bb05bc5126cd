// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/frames/readers/readers.h"
#include "ovimap/frames/recording/number_text.h"
#include "ovimap/frames/recording/time_pairs.h"
#include "ovimap/frames/recording/trajectory.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

/// One line of rgb.txt or depth.txt.
struct TimedImage {
  double time_s = 0;
  fs::path file;
};

bool is_tum(const fs::path& folder) {
  return fs::is_regular_file(folder / "rgb.txt") && fs::is_regular_file(folder / "depth.txt");
}

/// What a list names must lie in its recording: no other file of the machine gets into a map.
bool is_inside(const fs::path& name) {
  const fs::path plain = name.lexically_normal();
  return !plain.empty() && !plain.is_absolute() && *plain.begin() != "..";
}

std::vector<TimedImage> read_list(const fs::path& file) {
  std::vector<TimedImage> images;
  for (const TextLine& line : read_lines(file)) {
    const std::size_t blank = std::min(line.text.find_first_of(" \t"), line.text.size());
    const std::size_t name = line.text.find_first_not_of(" \t", blank);
    const auto time = parse_numbers(std::string_view(line.text).substr(0, blank));
    if (!time || time->size() != 1 || !std::isfinite(time->front()) || name == std::string::npos)
      throw Error(concat(file.string(), " line ", line.number, " is '", line.text,
                         "'; expected a time in seconds and a file name"));
    if (!is_inside(line.text.substr(name)))
      throw Error(concat(file.string(), " line ", line.number, " names '", line.text.substr(name),
                         "', which is not in the recording; name files in its folder"));
    images.push_back({time->front(), file.parent_path() / line.text.substr(name)});
  }
  std::stable_sort(images.begin(), images.end(),
                   [](const TimedImage& a, const TimedImage& b) { return a.time_s < b.time_s; });
  return images;
}

std::vector<double> times_of(const std::vector<TimedImage>& images) {
  std::vector<double> times(images.size());
  std::transform(images.begin(), images.end(), times.begin(),
                 [](const TimedImage& image) { return image.time_s; });
  return times;
}

Recording list_tum(const fs::path& folder, const FrameSourceConfig& config) {
  Recording recording;
  recording.kind = kTumReader.kind;
  recording.folder = folder;
  recording.rig.depth_camera =
      recording.rig.color_camera = {640, 480, 525.f, 525.f, 319.5f, 239.5f};
  recording.rig.depth_units_per_m = 5000;

  const auto colors = read_list(folder / "rgb.txt"), depths = read_list(folder / "depth.txt");
  const Trajectory trajectory = read_trajectory_if_needed(folder / "groundtruth.txt", config.poses);
  const PoseTimeline timeline(trajectory);
  for (const auto& [i, j] :
       pairs_by_time(times_of(colors), times_of(depths), config.max_time_gap_s)) {
    RecordedFrame frame;
    frame.name = colors[i].file.stem().string();
    frame.timestamp_s = colors[i].time_s;
    frame.depth_time_s = depths[j].time_s;
    frame.color = colors[i].file;
    frame.depth = depths[j].file;
    if (const auto pose = timeline.at(depths[j].time_s, config.max_time_gap_s)) {
      frame.pose = pose->matrix;
      frame.pose_origin = pose->origin;
    }
    recording.frames.push_back(std::move(frame));
  }
  if (recording.frames.empty())
    throw Error(concat(folder.string(), ": none of the ", colors.size(), " images of rgb.txt and ",
                       depths.size(), " of depth.txt are within ", config.max_time_gap_s,
                       " s of each other; check that both use one clock, or raise max_time_gap_s"));
  return recording;
}

}  // namespace

const Reader kTumReader = {"tum", "rgb.txt, depth.txt and groundtruth.txt (TUM RGB-D)", &is_tum,
                           &list_tum};

}  // namespace ovimap
