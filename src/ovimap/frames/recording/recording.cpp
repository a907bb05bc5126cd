// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/recording.h"

#include <algorithm>
#include <fstream>
#include <limits>

#include "ovimap/frames/decoding/depth_decoding.h"
#include "ovimap/frames/decoding/frame_decoder.h"
#include "ovimap/frames/decoding/oni_depth.h"
#include "ovimap/frames/frame/rectification.h"
#include "ovimap/frames/recording/number_text.h"
#include "ovimap/frames/recording/rig_completion.h"
#include "ovimap/image/codec.h"

namespace ovimap {

namespace {

/// Why a frame cannot be used: "FILE: PHRASE". Caught within this file.
struct FrameFault {
  std::string text;
};

[[noreturn]] void fail(const std::string& thing, const std::string& phrase) {
  throw FrameFault{thing + ": " + phrase};
}

/// What a fault calls the file of a frame.
std::string label(const std::filesystem::path& file, const std::optional<FilePart>& part,
                  const RecordedFrame& record) {
  const std::string name = file.filename().string();
  return part ? concat(name, " frame ", record.name) : name;
}

Bytes read_part(const std::filesystem::path& file, const std::optional<FilePart>& part) {
  if (!part) return read_file(file);
  // A handle of its own for each read: sources are read from several threads.
  std::ifstream stream(file, std::ios::binary);
  Bytes bytes(part->size);
  stream.seekg(static_cast<std::streamoff>(part->offset));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw Error("cut off");
  return bytes;
}

/// Runs `decode` on the bytes; whatever is wrong becomes a fault that begins with `name`.
template <class Decode>
auto load(const std::string& name, const std::filesystem::path& file,
          const std::optional<FilePart>& part, Decode&& decode) {
  std::error_code unreadable;
  if (!std::filesystem::exists(file, unreadable)) fail(name, "is missing");
  Bytes bytes;
  try {
    bytes = read_part(file, part);
  } catch (const Error&) {
    fail(name, "cannot be read");
  }
  try {
    return decode(bytes);
  } catch (const Error& fault) {
    fail(name, fault.what());
  }
}

/// Swaps left and right.
template <class Pixel>
void mirror(Image<Pixel>& image) {
  for (int v = 0; v < image.height(); ++v) std::reverse(image.row(v), image.row(v) + image.width());
}

class RecordingSource : public FrameSource {
 public:
  RecordingSource(Recording recording, const FrameSourceConfig& config, bool posed)
      : recording_(std::move(recording)),
        config_(config),
        units_(recording_.rig, config),
        rectification_(recording_.rig),
        posed_(posed) {}

  std::string kind() const override { return recording_.kind; }
  std::int64_t size() const override { return static_cast<std::int64_t>(recording_.frames.size()); }
  bool posed() const override { return posed_; }
  bool rectified() const override { return recording_.rig.color_lens != Lens{}; }

  FrameRead read(std::int64_t position) const override {
    const RecordedFrame& record = at(position);
    FrameRead read;
    try {
      read.frame = load_frame(record, position);
    } catch (const FrameFault& fault) {
      read.fault = fault.text;
    }
    return read;
  }

  std::optional<IdImage> truth_ids(std::int64_t position) const override {
    const RecordedFrame& record = at(position);
    if (record.truth.empty()) return std::nullopt;
    IdImage ids = read_gray(record.truth).values;
    const PinholeCamera& camera = recording_.rig.color_camera;
    if (ids.width() != camera.width || ids.height() != camera.height)
      throw Error(concat(record.truth.string(), " is ", ids.width(), "x", ids.height(),
                         ", expected ", camera.width, "x", camera.height,
                         " like the colour images"));
    return rectification_.color_ids(std::move(ids));
  }

 private:
  const RecordedFrame& at(std::int64_t position) const {
    OVIMAP_ASSERT(position >= 0 && position < size());
    return recording_.frames[static_cast<std::size_t>(position)];
  }

  Frame load_frame(const RecordedFrame& record, std::int64_t position) const {
    if (!record.fault.empty()) throw FrameFault{record.fault};
    Frame frame;
    frame.index = position;
    frame.name = record.name;
    frame.timestamp_s = record.timestamp_s;
    frame.color_camera = recording_.rig.color_camera;
    frame.depth_camera = recording_.rig.depth_camera;
    frame.color_from_depth = recording_.rig.color_from_depth;
    if (record.camera) {
      frame.color_camera = *record.camera;
      frame.depth_camera =
          record.camera->scaled_to(frame.depth_camera.width, frame.depth_camera.height);
    }
    frame.orientation = record.orientation;
    frame.posed = posed_;
    if (posed_)
      frame.world_from_camera = recording_.rig.world_from_depth_camera(stored_pose(record));
    frame.depth = load_depth(record);
    const std::string name = label(record.color, record.color_part, record);
    frame.color = load(name, record.color, record.color_part, [&](const Bytes& bytes) {
      const PinholeCamera& camera = frame.color_camera;
      return recording_.color_encoding == ColorEncoding::kRgb
                 ? decode_raw_color(bytes, camera.width, camera.height)
                 : decode_color(bytes, camera);
    });
    if (recording_.color_mirrored) mirror(frame.color);
    rectification_.apply(frame);
    return frame;
  }

  static Eigen::Matrix4d stored_pose(const RecordedFrame& record) {
    std::string origin = record.pose_origin;
    std::optional<Eigen::Matrix4d> pose = record.pose;
    if (!record.pose_file.empty()) {
      origin = record.pose_file.filename().string();
      pose = load(origin, record.pose_file, {}, [](const Bytes& bytes) {
        const auto numbers =
            parse_numbers({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        if (!numbers || numbers->size() != 16) throw Error("does not hold a 4x4 matrix");
        return matrix_from_rows(*numbers);
      });
    }
    if (!pose && !origin.empty()) fail(origin, "holds no pose");
    if (!pose) fail(record.name, "has no pose");
    const std::string fault = pose_fault(*pose);
    if (!fault.empty()) fail(origin, "has a bad pose (" + fault + ")");
    return *pose;
  }

  Image<std::uint16_t> decode_depth_units(const Bytes& bytes) const {
    const PinholeCamera& camera = recording_.rig.depth_camera;
    switch (recording_.depth_encoding) {
      case DepthEncoding::kZlibUnits:
        return decode_zlib_depth(bytes, camera.width, camera.height);
      case DepthEncoding::kRawUnits:
        return decode_raw_depth(bytes, camera.width, camera.height);
      case DepthEncoding::kOni:
        return decode_oni_depth(bytes, camera.width, camera.height, false);
      case DepthEncoding::kOniTable:
        return decode_oni_depth(bytes, camera.width, camera.height, true);
      default:
        return decode_stored_depth(bytes, camera);
    }
  }

  DepthImage depth_of_metres(const RecordedFrame& record, const std::string& name) const {
    const PinholeCamera& camera = recording_.rig.depth_camera;
    DepthImage depth = load(name, record.depth, record.depth_part, [&](const Bytes& bytes) {
      return decode_float_depth(bytes, camera.width, camera.height);
    });
    // Written so that what is not a number is invalid as well.
    for (float& metres : depth)
      if (!(metres >= config_.min_depth_m && metres <= config_.max_depth_m)) metres = 0;
    if (record.confidence.empty()) return depth;
    const auto confidence =
        load(record.confidence.filename().string(), record.confidence, {},
             [&](const Bytes& bytes) { return decode_bytes(bytes, camera.width, camera.height); });
    for (std::size_t i = 0; i < depth.size(); ++i)
      if (confidence[i] < config_.min_confidence) depth[i] = 0;
    return depth;
  }

  /// " from 0.1 to 10 m", or "" where all depth is taken.
  std::string range_text() const {
    if (config_.max_depth_m >= std::numeric_limits<float>::max()) return "";
    return concat(" from ", config_.min_depth_m, " to ", config_.max_depth_m, " m");
  }

  DepthImage load_depth(const RecordedFrame& record) const {
    const std::string name = label(record.depth, record.depth_part, record);
    DepthImage depth =
        recording_.depth_encoding == DepthEncoding::kMetres
            ? depth_of_metres(record, name)
            : units_.metres(load(name, record.depth, record.depth_part,
                                 [&](const Bytes& bytes) { return decode_depth_units(bytes); }));
    if (recording_.depth_mirrored) mirror(depth);
    if (!has_depth(depth)) fail(name, "has no depth" + range_text());
    return depth;
  }

  Recording recording_;
  FrameSourceConfig config_;
  DepthUnits units_;
  RigRectification rectification_;
  bool posed_;
};

/// A pose that is stored but means "unknown" (not finite, as some trackers write) is none.
bool has_pose(const RecordedFrame& frame) {
  std::error_code unreadable;
  if (frame.pose) return frame.pose->allFinite();
  return !frame.pose_file.empty() && std::filesystem::exists(frame.pose_file, unreadable);
}

bool read_poses(const Recording& recording, PoseNeed need) {
  if (need != PoseNeed::kAllOrNone) return need == PoseNeed::kAll;
  return std::any_of(recording.frames.begin(), recording.frames.end(), has_pose);
}

std::string missing_part(const RecordedFrame& frame, bool posed) {
  if (!frame.fault.empty()) return frame.fault;
  std::error_code unreadable;
  const auto absent = [&](const std::filesystem::path& file) {
    return !std::filesystem::exists(file, unreadable);
  };
  for (const auto& file : {frame.color, frame.depth})
    if (absent(file)) return file.filename().string() + " is missing";
  if (frame.pose || !posed) return {};
  if (frame.pose_file.empty()) return frame.name + " has no pose";
  if (absent(frame.pose_file)) return frame.pose_file.filename().string() + " is missing";
  return {};
}

void check_any_complete(const Recording& recording, bool posed) {
  std::string first_fault = "there are no frames";
  for (const RecordedFrame& frame : recording.frames) {
    const std::string missing = missing_part(frame, posed);
    if (missing.empty()) return;
    if (&frame == &recording.frames.front()) first_fault = missing;
  }
  throw Error(concat(recording.folder.string(), ": none of ", recording.frames.size(),
                     " frames has colour", posed ? ", depth and pose (" : " and depth (",
                     first_fault,
                     posed ? "); `ovimap run --poses track` finds poses itself" : ")"));
}

}  // namespace

std::unique_ptr<FrameSource> open_recording(Recording recording, const FrameSourceConfig& config) {
  const bool posed = read_poses(recording, config.poses);
  check_any_complete(recording, posed);
  complete_cameras(recording);
  return std::make_unique<RecordingSource>(std::move(recording), config, posed);
}

}  // namespace ovimap
