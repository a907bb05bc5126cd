// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "ovimap/base/error.h"
#include "ovimap/frames/readers/readers.h"
#include "ovimap/frames/readers/stored_size.h"
#include "ovimap/frames/recording/folder_parts.h"
#include "ovimap/image/size_limits.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, ".sens files are little-endian");

constexpr std::uint32_t kVersion = 4;
constexpr std::uint64_t kLongestName = 4096;
constexpr std::uint64_t kMostFrames = std::uint64_t{1} << 22;  ///< 38 hours
constexpr double kSensTicksPerSecond = 1e6;  ///< of the time stamps, which many files leave 0

/// Numbers of the file's header.
enum class ColorCompression : std::int32_t { kRaw = 0, kPng = 1, kJpeg = 2 };
enum class DepthCompression : std::int32_t { kRawUnits = 0, kZlibUnits = 1, kOcciUnits = 2 };

/// Reads a .sens file from its begin to its end, without the images.
class SensFile {
 public:
  explicit SensFile(const fs::path& path)
      : path_(path), stream_(path, std::ios::binary), size_(fs::file_size(path)) {
    if (!stream_) throw Error(concat(path.string(), " cannot be read"));
  }

  const fs::path& path() const { return path_; }
  std::uint64_t position() const { return position_; }
  bool has(std::uint64_t bytes) const { return bytes <= size_ - position_; }

  template <class Value>
  Value read() {
    Value value;
    if (!has(sizeof(Value))) throw Error(concat(path_.string(), " ends within its header"));
    stream_.read(reinterpret_cast<char*>(&value), sizeof(Value));
    if (!stream_) throw Error(concat(path_.string(), " cannot be read to its end"));
    position_ += sizeof(Value);
    return value;
  }

  void skip(std::uint64_t bytes) {
    OVIMAP_ASSERT(has(bytes));
    position_ += bytes;
    stream_.seekg(static_cast<std::streamoff>(position_));
  }

 private:
  fs::path path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0, position_ = 0;
};

using StoredMatrix = std::array<float, 16>;  ///< row by row

Eigen::Matrix4d matrix_of(const StoredMatrix& stored) {
  return Eigen::Map<const Eigen::Matrix<float, 4, 4, Eigen::RowMajor>>(stored.data())
      .cast<double>();
}

struct StoredCamera {
  PinholeCamera camera;
  Eigen::Matrix4d extrinsic;
};

StoredCamera read_camera(SensFile& file) {
  const Eigen::Matrix4d k = matrix_of(file.read<StoredMatrix>());
  StoredCamera stored;
  stored.camera = {0, 0, float(k(0, 0)), float(k(1, 1)), float(k(0, 2)), float(k(1, 2))};
  stored.extrinsic = matrix_of(file.read<StoredMatrix>());
  return stored;
}

Pose extrinsic_pose(const SensFile& file, const StoredCamera& camera, const char* name) {
  if (const std::string fault = pose_fault(camera.extrinsic); !fault.empty())
    throw Error(concat(file.path().string(), ": the extrinsic of the ", name,
                       " camera is no rigid transform (", fault, ")"));
  return rigid_pose(camera.extrinsic);
}

void read_size(SensFile& file, const char* name, PinholeCamera& camera) {
  const auto width = file.read<std::uint32_t>(), height = file.read<std::uint32_t>();
  if (!plausible_size(width, height))
    throw Error(concat(file.path().string(), ": ", name, " images are ", width, "x", height,
                       "; accepted are sides from 1 to ", kLargestSide_px, " and up to ",
                       kLargestArea_px, " pixels"));
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
}

void read_version_and_name(SensFile& file) {
  const auto version = file.read<std::uint32_t>();
  if (version != kVersion)
    throw Error(concat(file.path().string(), " has version ", version,
                       "; accepted are .sens files of version ", kVersion));
  const auto length = file.read<std::uint64_t>();
  if (length > kLongestName || !file.has(length))
    throw Error(concat(file.path().string(), ": the sensor's name is ", length,
                       " characters long; this is no .sens file"));
  file.skip(length);
}

DepthEncoding read_compressions(SensFile& file) {
  const auto color = file.read<ColorCompression>();
  if (color != ColorCompression::kJpeg && color != ColorCompression::kPng)
    throw Error(concat(file.path().string(), ": colour has compression ",
                       static_cast<std::int32_t>(color), "; accepted are 1 (PNG) and 2 (JPEG)"));
  const auto depth = file.read<DepthCompression>();
  if (depth != DepthCompression::kZlibUnits && depth != DepthCompression::kRawUnits)
    throw Error(concat(file.path().string(), ": depth has compression ",
                       static_cast<std::int32_t>(depth), "; accepted are 0 (none) and 1 (zlib)"));
  return depth == DepthCompression::kZlibUnits ? DepthEncoding::kZlibUnits
                                               : DepthEncoding::kRawUnits;
}

void read_header(SensFile& file, Recording& recording) {
  read_version_and_name(file);
  const StoredCamera color = read_camera(file), depth = read_camera(file);
  CameraRig& rig = recording.rig;
  rig.color_camera = color.camera;
  rig.depth_camera = depth.camera;
  // As in the export folder: both extrinsics lead into one frame.
  rig.color_from_depth =
      extrinsic_pose(file, color, "colour").inverse() * extrinsic_pose(file, depth, "depth");
  recording.depth_encoding = read_compressions(file);
  read_size(file, "colour", rig.color_camera);
  read_size(file, "depth", rig.depth_camera);
  rig.depth_units_per_m = file.read<float>();
  if (!(rig.depth_units_per_m > 0))
    throw Error(concat(file.path().string(), ": the depth scale is ", rig.depth_units_per_m,
                       " units per metre; it must be above 0"));
}

struct FrameHeader {
  StoredMatrix world_from_camera;
  std::uint64_t color_ticks, depth_ticks, color_size, depth_size;
};
static_assert(sizeof(FrameHeader) == 96);

bool plausible_part(std::uint64_t bytes, const PinholeCamera& camera) {
  return plausible_image_size(bytes, camera.width, camera.height);
}

/// Notes where the frame's images lie. False when the file ends within the frame.
bool index_frame(SensFile& file, const CameraRig& rig, RecordedFrame& frame) {
  frame.fault = concat(file.path().filename().string(), " frame ", frame.name, ": is cut off");
  if (!file.has(sizeof(FrameHeader))) return false;
  const auto header = file.read<FrameHeader>();
  if (!file.has(header.color_size)) return false;
  frame.color_part = {file.position(), header.color_size};
  file.skip(header.color_size);
  if (!file.has(header.depth_size)) return false;
  frame.depth_part = {file.position(), header.depth_size};
  file.skip(header.depth_size);
  frame.pose = matrix_of(header.world_from_camera);
  if (header.depth_ticks > 0)
    frame.timestamp_s = static_cast<double>(header.depth_ticks) / kSensTicksPerSecond;
  frame.fault.clear();
  if (!plausible_part(header.color_size, rig.color_camera) ||
      !plausible_part(header.depth_size, rig.depth_camera))
    frame.fault = concat(frame.pose_origin, ": its images are larger than they can be");
  return true;
}

bool is_sens(const fs::path& source) {
  return !find_file(source, ".sens").empty();
}

Recording list_sens(const fs::path& source, const FrameSourceConfig&) {
  Recording recording;
  recording.kind = kSensReader.kind;
  recording.folder = source;
  SensFile file(find_file(source, ".sens"));
  read_header(file, recording);
  const auto promised = file.read<std::uint64_t>();
  bool whole = true;
  for (std::uint64_t i = 0; i < promised && whole; ++i) {
    if (i == kMostFrames)
      throw Error(concat(file.path().string(), " holds more than ", kMostFrames,
                         " frames; cut it into several"));
    RecordedFrame frame;
    frame.name = std::to_string(i);
    frame.timestamp_s = static_cast<double>(i) / kAssumedFramesPerSecond;
    frame.color = frame.depth = file.path();
    frame.pose_origin = concat(file.path().filename().string(), " frame ", i);
    whole = index_frame(file, recording.rig, frame);
    recording.frames.push_back(std::move(frame));
  }
  return recording;
}

}  // namespace

const Reader kSensReader = {"sens", "a .sens file (ScanNet)", &is_sens, &list_sens};

}  // namespace ovimap
