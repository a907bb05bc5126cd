// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/frames/frame/camera_rig.h"
#include "ovimap/frames/frame/frame_source.h"

namespace ovimap {

/// Where an image lies in a file that holds many.
struct FilePart {
  std::uint64_t offset = 0, size = 0;  ///< bytes
};

/// How a recording stores depth.
enum class DepthEncoding {
  kPng,        ///< 16-bit grey PNG, CameraRig::depth_units_per_m
  kZlibUnits,  ///< the same units as rows of little-endian 16-bit numbers, zlib-compressed
  kRawUnits,   ///< the same uncompressed
  kOni,        ///< the same as OpenNI compresses it (oni_depth.h)
  kOniTable,   ///< likewise, with a table of values
  kMetres,     ///< rows of little-endian 32-bit metres, LZFSE-compressed or plain
};

/// How a recording stores colour.
enum class ColorEncoding {
  kImageFile,  ///< JPEG or PNG
  kRgb,        ///< rows of pixels, a byte each of red, green and blue
};

/// The files of one frame. A path may name a file that does not exist: that is a fault of this
/// frame.
struct RecordedFrame {
  std::string name;  ///< stem of the colour image
  double timestamp_s = 0;
  std::optional<double> depth_time_s;  ///< absent: timestamp_s
  std::filesystem::path color, depth;
  std::optional<FilePart> color_part, depth_part;  ///< absent: the whole file
  std::filesystem::path confidence;     ///< a byte per depth pixel, LZFSE or plain; empty: none
  std::optional<PinholeCamera> camera;  ///< the colour camera's own of this frame (it focuses);
                                        ///< depth is registered to it
  std::filesystem::path pose_file;      ///< 4x4 text read with the frame; empty: `pose` holds it
  std::optional<Eigen::Matrix4d> pose;  ///< as stored, unchecked
  std::string pose_origin;              ///< "traj.txt line 7"; names the pose in a fault
  std::optional<Eigen::Quaterniond> orientation;  ///< as Frame has it
  std::filesystem::path truth;                    ///< true instance ids, 16-bit PNG; empty: none
  std::string fault;                              ///< "FILE: PHRASE" when listing already found one
};

/// Where a layout gives no times, frames are taken to be this far apart; times only inform.
inline constexpr double kAssumedFramesPerSecond = 30;

/// What a reader finds out about a data set: all frames in order, and how to read their files.
struct Recording {
  std::string kind;
  std::filesystem::path folder;
  CameraRig rig;
  DepthEncoding depth_encoding = DepthEncoding::kPng;
  ColorEncoding color_encoding = ColorEncoding::kImageFile;
  bool color_mirrored = false, depth_mirrored = false;  ///< stored with left and right swapped
  std::vector<RecordedFrame> frames;
};

/// The source that reads a recording's frames, with every check of a single frame. Throws Error
/// when no frame has all its parts, or a camera is not known (see complete_cameras).
std::unique_ptr<FrameSource> open_recording(Recording recording, const FrameSourceConfig& config);

}  // namespace ovimap
