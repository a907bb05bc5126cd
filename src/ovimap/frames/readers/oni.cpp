// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/frames/frame/field_of_view.h"
#include "ovimap/frames/readers/readers.h"
#include "ovimap/frames/readers/stored_size.h"
#include "ovimap/frames/recording/folder_parts.h"
#include "ovimap/frames/recording/oni_file.h"
#include "ovimap/frames/recording/time_pairs.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

/// Of OniPixelFormat.
constexpr int kDepthMillimetres = 100, kDepthTenthMillimetres = 101, kRgb888 = 200;

bool is_oni(const fs::path& source) {
  return !find_file(source, ".oni").empty();
}

void check_stream(const fs::path& path, const OniStream& stream, const char* name) {
  if (stream.codec.empty() || stream.images.empty())
    throw Error(
        concat(path.string(), " holds no ", name, " images; record depth and colour together"));
  if (stream.width == 0)
    throw Error(concat(path.string(), " does not say how large its ", name, " images are"));
  if (stream.cropped)
    throw Error(concat(path.string(), ": its ", name, " images are cropped; record them whole"));
}

DepthEncoding depth_encoding(const fs::path& path, const OniStream& stream) {
  if (stream.codec == "16zT") return DepthEncoding::kOniTable;
  if (stream.codec == "16zP") return DepthEncoding::kOni;
  if (stream.codec == "NONE") return DepthEncoding::kRawUnits;
  throw Error(concat(path.string(), ": depth is stored as '", stream.codec,
                     "'; accepted are 16zT, 16zP and NONE"));
}

double units_per_m(const fs::path& path, const OniStream& stream) {
  if (stream.pixel_format == 0 || stream.pixel_format == kDepthMillimetres) return 1000;
  if (stream.pixel_format == kDepthTenthMillimetres) return 10000;
  throw Error(concat(path.string(), ": depth has the pixel format ", stream.pixel_format,
                     "; accepted are 100 (millimetres) and 101 (tenths of them)"));
}

ColorEncoding color_encoding(const fs::path& path, const OniStream& stream) {
  if (stream.codec == "JPEG") return ColorEncoding::kImageFile;
  if (stream.codec == "NONE" && (stream.pixel_format == 0 || stream.pixel_format == kRgb888))
    return ColorEncoding::kRgb;
  throw Error(concat(path.string(), ": colour is stored as '", stream.codec,
                     "' of the pixel format ", stream.pixel_format,
                     "; accepted are JPEG and RGB888 (200)"));
}

PinholeCamera camera_of(const OniStream& stream) {
  if (!(stream.horizontal_fov_rad > 0 && stream.vertical_fov_rad > 0))
    return {stream.width, stream.height};
  return camera_of_view(stream.width, stream.height, stream.horizontal_fov_rad,
                        stream.vertical_fov_rad);
}

std::vector<double> times_of(const OniStream& stream) {
  std::vector<double> times(stream.images.size());
  std::transform(stream.images.begin(), stream.images.end(), times.begin(),
                 [](const OniImage& image) { return image.time_s; });
  return times;
}

bool plausible_part(const FilePart& part, const OniStream& stream) {
  return plausible_image_size(part.size, stream.width, stream.height);
}

RecordedFrame frame_of(const fs::path& path, const OniFile& file, std::size_t color,
                       std::size_t depth) {
  RecordedFrame frame;
  frame.name = std::to_string(depth);
  frame.timestamp_s = file.depth.images[depth].time_s;
  frame.color = frame.depth = path;
  frame.color_part = file.color.images[color].part;
  frame.depth_part = file.depth.images[depth].part;
  if (!plausible_part(*frame.color_part, file.color) ||
      !plausible_part(*frame.depth_part, file.depth))
    frame.fault = concat(path.filename().string(), " frame ", depth,
                         ": its images are larger than they can be");
  return frame;
}

Recording list_oni(const fs::path& source, const FrameSourceConfig& config) {
  const fs::path path = find_file(source, ".oni");
  const OniFile file = list_oni_file(path);
  check_stream(path, file.depth, "depth");
  check_stream(path, file.color, "colour");
  Recording recording;
  recording.kind = kOniReader.kind;
  recording.folder = source;
  recording.rig.depth_camera = camera_of(file.depth);
  recording.rig.color_camera = camera_of(file.color);
  recording.rig.depth_units_per_m = units_per_m(path, file.depth);
  recording.depth_encoding = depth_encoding(path, file.depth);
  recording.color_encoding = color_encoding(path, file.color);
  recording.depth_mirrored = file.depth.mirrored;
  recording.color_mirrored = file.color.mirrored;
  for (const auto& [color, depth] :
       pairs_by_time(times_of(file.color), times_of(file.depth), config.max_time_gap_s))
    recording.frames.push_back(frame_of(path, file, color, depth));
  if (recording.frames.empty())
    throw Error(concat(path.string(), ": no image of colour is within ", config.max_time_gap_s,
                       " s of one of depth; raise max_time_gap_s"));
  return recording;
}

}  // namespace

const Reader kOniReader = {"oni", "a .oni file (OpenNI)", &is_oni, &list_oni};

}  // namespace ovimap
