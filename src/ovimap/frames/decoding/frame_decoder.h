// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ovimap/frames/frame/camera_rig.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/frames/frame/rectification.h"

namespace ovimap {

/// Colour and stored depth of a camera: JPEG or PNG; 16-bit grey PNG. Throw Error, a predicate ("is
/// 640x480, expected 320x240"), where that is not what the bytes are.
RgbImage decode_color(std::span<const std::uint8_t> bytes, const PinholeCamera& camera);
Image<std::uint16_t> decode_stored_depth(std::span<const std::uint8_t> bytes,
                                         const PinholeCamera& camera);

/// Whether a depth image has any; one without is of no use to a map.
bool has_depth(const DepthImage& depth);

/// Metres for each stored depth value.
class DepthUnits {
 public:
  /// Values that the rig calls invalid, and depth beyond the limits of `config`, become 0.
  DepthUnits(const CameraRig& rig, const FrameSourceConfig& config);

  DepthImage metres(const Image<std::uint16_t>& stored) const;

 private:
  std::vector<float> metres_;
};

/// Makes frames of what a camera's driver hands over: encoded images and poses as the rig's
/// convention gives them, rectified. Thread-safe.
class FrameDecoder {
 public:
  /// Throws Error when a camera of the rig is not known whole or its distortion cannot be its own.
  /// One that is missing is taken to be the other, where both have images of one size.
  FrameDecoder(const CameraRig& rig, const FrameSourceConfig& config = {});

  /// `color`: JPEG or PNG; `depth`: 16-bit grey PNG; `pose`: as CameraRig::world_from_depth_camera
  /// takes it; nullopt: not known. The frame has no index, name and time. Throws Error with one
  /// sentence when an image cannot be decoded, is of another size or holds no depth, or the pose is
  /// no rigid transform.
  Frame decode(std::span<const std::uint8_t> color, std::span<const std::uint8_t> depth,
               const std::optional<Eigen::Matrix4d>& pose) const;

  const CameraRig& rig() const { return rig_; }

 private:
  CameraRig rig_;
  FrameSourceConfig config_;
  DepthUnits units_;
  RigRectification rectification_;
};

}  // namespace ovimap
