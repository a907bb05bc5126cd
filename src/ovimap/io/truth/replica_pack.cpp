// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/truth/replica_pack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/mesh/ply.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

fs::path numbered(const fs::path& folder, const char* stem, std::int64_t number,
                  const char* ending) {
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "%06lld", static_cast<long long>(number));
  return folder / concat(stem, digits.data(), ending);
}

struct FrameFiles {
  FrameFiles(const fs::path& results, std::int64_t number)
      : color(numbered(results, "frame", number, ".jpg")),
        depth(numbered(results, "depth", number, ".png")),
        ids(numbered(results, "instance", number, ".png")) {}
  fs::path color, depth, ids;
};

Image<std::uint16_t> depth_units(const DepthImage& depth, float units_per_m) {
  Image<std::uint16_t> units(depth.width(), depth.height());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const float value = std::round(depth[i] * units_per_m);
    if (value > 0 && value <= 65535) units[i] = static_cast<std::uint16_t>(value);
  }
  return units;
}

std::string trajectory_line(const Pose& pose) {
  std::string line;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      std::array<char, 40> number{};
      std::snprintf(number.data(), number.size(), "%.17g", pose.matrix()(row, column));
      line.append(line.empty() ? "" : " ").append(number.data());
    }
  return line.append("\n");
}

std::string camera_json(const PinholeCamera& camera, float depth_units_per_m) {
  nlohmann::ordered_json values;
  values["w"] = camera.width;
  values["h"] = camera.height;
  values["fx"] = camera.fx;
  values["fy"] = camera.fy;
  values["cx"] = camera.cx;
  values["cy"] = camera.cy;
  values["scale"] = depth_units_per_m;
  return nlohmann::ordered_json{{"camera", values}}.dump(2) + "\n";
}

std::string text_of(const fs::path& file) {
  const Bytes bytes = read_file(file);
  return {bytes.begin(), bytes.end()};
}

/// Writes a file that later runs and other scenes rely on, or checks that it says the same already.
void write_once(const fs::path& file, const std::string& text, const char* what) {
  if (!fs::exists(file)) return write_text(file, text);
  if (text_of(file) != text)
    throw Error(concat(
        file.string(), ": describes ", what,
        " than what is to be written; remove it with its frames, or write to another folder"));
}

Frame checked_frame(const FrameSource& source, std::int64_t position) {
  FrameRead read = source.read(position);
  if (!read.frame) throw Error(concat("frame ", position, " of ", source.kind(), ": ", read.fault));
  if (!read.frame->registered())
    throw Error(concat("frame ", position, " of ", source.kind(),
                       ": colour and depth have different cameras; the Replica layout holds one"));
  return std::move(*read.frame);
}

void write_labels(const fs::path& root, const ReplicaPack& pack) {
  nlohmann::ordered_json names;
  std::map<std::uint32_t, std::uint32_t> class_of;
  for (const PackInstance& instance : pack.instances) {
    class_of[instance.id] = instance.class_id;
    names["instances"][std::to_string(instance.id)] = instance.class_name;
    names["classes"][std::to_string(instance.class_id)] = instance.class_name;
    if (!instance.room.empty()) names["rooms"][std::to_string(instance.id)] = instance.room;
    if (!instance.substance.empty())
      names["substances"][std::to_string(instance.id)] = instance.substance;
  }
  if (!pack.unscored.empty()) names["unscored"] = pack.unscored;
  if (!pack.instances.empty()) write_text(root / pack.scene / "labels.json", names.dump(1) + "\n");
  if (pack.truth.vertices.empty()) return;
  std::string instances, classes;
  for (const std::uint32_t label : pack.truth.labels) {
    const auto found = class_of.find(label);
    instances += std::to_string(label) + "\n";
    classes += std::to_string(found == class_of.end() ? 0 : found->second) + "\n";
  }
  write_text(root / concat("instance_labels_", pack.scene, ".txt"), instances);
  write_text(root / concat("semantic_labels_", pack.scene, ".txt"), classes);
  write_ply(root / concat(pack.scene, "_mesh.ply"), pack.truth);
}

/// With their line ends; none where there is no file.
std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  if (!fs::exists(file)) return lines;
  std::istringstream in(text_of(file));
  for (std::string line; std::getline(in, line);) lines.push_back(line + "\n");
  return lines;
}

std::string time_line(double time_s) {
  std::array<char, 40> number{};
  std::snprintf(number.data(), number.size(), "%.6f\n", time_s);
  return number.data();
}

/// The lines of traj.txt are there exactly for the frames whose files are all there.
class FrameWriter {
 public:
  FrameWriter(const fs::path& root, const ReplicaPack& pack, const ReplicaPackConfig& config)
      : root_(root),
        pack_(pack),
        config_(config),
        trajectory_(root / pack.scene / "traj.txt"),
        times_file_(root / pack.scene / "timestamps.txt") {
    lines_ = lines_of(trajectory_);
    if (pack.timed) times_ = lines_of(times_file_);
  }

  void write(std::int64_t position) {
    const FrameFiles files(root_ / pack_.scene / "results", position);
    const auto line = static_cast<std::size_t>(position);
    const bool listed = line < lines_.size() && (!pack_.timed || line < times_.size());
    if (listed && fs::exists(files.color) && fs::exists(files.depth) && has_ids(files, position))
      return;
    const Frame frame = checked_frame(*pack_.frames, position);
    write_once(root_ / "cam_params.json",
               camera_json(frame.depth_camera, config_.depth_units_per_m), "another camera");
    write_file(files.depth, encode_png(depth_units(frame.depth, config_.depth_units_per_m)));
    if (const auto ids = pack_.frames->truth_ids(position)) write_file(files.ids, encode_png(*ids));
    write_file(files.color, encode_jpeg(frame.color, config_.jpeg_quality));
    if (pack_.timed) write_line(times_file_, times_, line, time_line(frame.timestamp_s));
    write_line(trajectory_, lines_, line, trajectory_line(frame.world_from_camera));
  }

 private:
  bool has_ids(const FrameFiles& files, std::int64_t position) const {
    return fs::exists(files.ids) || !pack_.frames->truth_ids(position).has_value();
  }

  static void write_line(const fs::path& file, std::vector<std::string>& lines, std::size_t number,
                         const std::string& line) {
    lines.resize(std::max(lines.size(), number + 1));
    lines[number] = line;
    std::string text;
    for (const std::string& each : lines) text += each;
    write_text(file, text);
  }

  const fs::path& root_;
  const ReplicaPack& pack_;
  const ReplicaPackConfig& config_;
  fs::path trajectory_, times_file_;
  std::vector<std::string> lines_, times_;
};

}  // namespace

void list_fields(ReplicaPackConfig& config, ConfigFields& fields) {
  fields.add("jpeg_quality", config.jpeg_quality, 1, 100, "quality of the colour images");
  fields.add("depth_units_per_m", config.depth_units_per_m, 1.f, 65535.f,
             "steps a metre of the depth images");
}

void write_replica_pack(const fs::path& root, const ReplicaPack& pack,
                        const ReplicaPackConfig& config, const PackProgress& progress) {
  const fs::path scene = root / pack.scene;
  std::error_code fault;
  fs::create_directories(scene / "results", fault);
  if (fault)
    throw Error(concat((scene / "results").string(), ": cannot be made (", fault.message(),
                       "); choose a folder that can be written to"));
  if (!pack.settings.empty()) write_once(scene / "settings.yaml", pack.settings, "other settings");
  if (!pack.notice.empty()) write_text(scene / "NOTICE.md", pack.notice);
  write_labels(root, pack);
  FrameWriter writer(root, pack, config);
  const std::int64_t total = pack.frames->size();
  for (std::int64_t i = 0; i < total; ++i) {
    writer.write(i);
    if (progress) progress(i + 1, total);
  }
}

}  // namespace ovimap
