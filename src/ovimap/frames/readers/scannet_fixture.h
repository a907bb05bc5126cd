// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: the analytic room as a ScanNet export folder and as a .sens file.

#include <cstring>
#include <string>

#include <zlib.h>

#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap::fixture {

inline Eigen::Matrix4d intrinsic_matrix(const PinholeCamera& camera) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix(0, 0) = camera.fx;
  matrix(1, 1) = camera.fy;
  matrix(0, 2) = camera.cx;
  matrix(1, 2) = camera.cy;
  return matrix;
}

/// Colour is larger than depth and lies 3 cm beside it, as with a Structure sensor on a tablet.
inline Sequence two_camera_sequence(int frames) {
  Sequence sequence;
  sequence.frames = frames;
  sequence.color_camera = {162, 121, 146.f, 147.f, 80.9f, 60.4f};
  sequence.color_from_depth.linear() =
      Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  sequence.color_from_depth.translation() = Eigen::Vector3d(-0.03, 0.004, 0.001);
  return sequence;
}

/// color/N.jpg, depth/N.png, pose/N.txt, intrinsic/*.txt.
inline void write_scannet(const fs::path& folder, const Sequence& sequence) {
  for (const char* part : {"color", "depth", "pose", "intrinsic"})
    fs::create_directories(folder / part);
  for (int i = 0; i < sequence.frames; ++i) {
    write_file(folder / "color" / concat(i, ".jpg"), encode_jpeg(sequence.color(i), 95));
    write_file(folder / "depth" / concat(i, ".png"), encode_png(sequence.stored_depth(i)));
    write_text(folder / "pose" / concat(i, ".txt"), matrix_text(sequence.pose(i)));
  }
  const auto write_matrix = [&](const char* name, const Eigen::Matrix4d& matrix) {
    write_text(folder / "intrinsic" / name, matrix_text(matrix));
  };
  write_matrix("intrinsic_color.txt", intrinsic_matrix(sequence.color_camera));
  write_matrix("intrinsic_depth.txt", intrinsic_matrix(sequence.depth_camera));
  write_matrix("extrinsic_color.txt", Eigen::Matrix4d::Identity());
  write_matrix("extrinsic_depth.txt", sequence.color_from_depth.matrix());
}

/// A .sens file put together byte by byte; a test may change any field before it is written.
struct SensContent {
  std::uint32_t version = 4;
  std::string sensor = "StructureSensor";
  std::int32_t color_compression = 2, depth_compression = 1;
  float depth_units_per_m = 1000;
  std::uint64_t promised_frames = 0;
  std::uint64_t depth_microseconds = 0;  ///< time stamp of frame 1; frame N has N times that
};

template <class Value>
void append(Bytes& bytes, const Value& value) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof(Value));
}

inline void append_matrix(Bytes& bytes, const Eigen::Matrix4d& matrix) {
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      append(bytes, static_cast<float>(matrix(row, column)));
}

inline Bytes zlib_bytes(const Image<std::uint16_t>& image) {
  const auto size = static_cast<uLong>(image.size() * sizeof(std::uint16_t));
  uLongf packed = compressBound(size);
  Bytes bytes(packed);
  compress(bytes.data(), &packed, reinterpret_cast<const Bytef*>(image.data()), size);
  bytes.resize(packed);
  return bytes;
}

inline Bytes raw_bytes(const Image<std::uint16_t>& image) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(image.data());
  return Bytes(first, first + image.size() * sizeof(std::uint16_t));
}

inline Bytes sens_header(const Sequence& sequence, const SensContent& content) {
  Bytes bytes;
  append(bytes, content.version);
  append(bytes, static_cast<std::uint64_t>(content.sensor.size()));
  bytes.insert(bytes.end(), content.sensor.begin(), content.sensor.end());
  append_matrix(bytes, intrinsic_matrix(sequence.color_camera));
  append_matrix(bytes, Eigen::Matrix4d::Identity());
  append_matrix(bytes, intrinsic_matrix(sequence.depth_camera));
  append_matrix(bytes, sequence.color_from_depth.matrix());
  append(bytes, content.color_compression);
  append(bytes, content.depth_compression);
  for (const PinholeCamera& camera : {sequence.color_camera, sequence.depth_camera}) {
    append(bytes, static_cast<std::uint32_t>(camera.width));
    append(bytes, static_cast<std::uint32_t>(camera.height));
  }
  append(bytes, content.depth_units_per_m);
  append(bytes, content.promised_frames > 0 ? content.promised_frames
                                            : static_cast<std::uint64_t>(sequence.frames));
  return bytes;
}

inline void append_frame(Bytes& bytes, const Sequence& sequence, const SensContent& content,
                         int index) {
  const Bytes color = encode_jpeg(sequence.color(index), 95);
  const Bytes depth = content.depth_compression == 1 ? zlib_bytes(sequence.stored_depth(index))
                                                     : raw_bytes(sequence.stored_depth(index));
  append_matrix(bytes, sequence.pose(index));
  append(bytes, std::uint64_t{0});
  append(bytes, content.depth_microseconds * static_cast<std::uint64_t>(index));
  append(bytes, static_cast<std::uint64_t>(color.size()));
  append(bytes, static_cast<std::uint64_t>(depth.size()));
  bytes.insert(bytes.end(), color.begin(), color.end());
  bytes.insert(bytes.end(), depth.begin(), depth.end());
}

inline Bytes sens_bytes(const Sequence& sequence, const SensContent& content = {}) {
  Bytes bytes = sens_header(sequence, content);
  for (int i = 0; i < sequence.frames; ++i) append_frame(bytes, sequence, content, i);
  append(bytes, std::uint64_t{0});  // no inertial measurements
  return bytes;
}

}  // namespace ovimap::fixture
