// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ovimap/frames/frame/lens.h"
#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"

namespace ovimap {

/// How a recording writes down its poses.
struct PoseConvention {
  enum class Direction { kWorldFromCamera, kCameraFromWorld };
  /// The camera's axes: x right, y down, z forward; x right, y up, z backward; x forward, y left, z
  /// up.
  enum class Axes { kOpenCv, kOpenGl, kRos };
  enum class Camera { kDepth, kColor };  ///< whose pose it is
  Direction direction = Direction::kWorldFromCamera;
  Axes axes = Axes::kOpenCv;
  Camera camera = Camera::kDepth;
};

/// world_from_camera with our axes (OpenCV's) of the camera whose pose is stored by the convention.
Pose pose_by_convention(const PoseConvention& convention, const Pose& stored);

/// The two cameras of a recording and how to read their files.
struct CameraRig {
  PinholeCamera color_camera, depth_camera;
  Lens color_lens, depth_lens;  ///< of the stored images; those of frames are rectified
  Pose color_from_depth = Pose::Identity();        ///< x_in_color = color_from_depth * x_in_depth
  double depth_units_per_m = 1000;                 ///< stored depth values per metre
  std::vector<std::uint16_t> invalid_depth = {0};  ///< stored values that mean "no depth"
  PoseConvention poses;

  /// The pose of the depth camera, from a matrix without pose_fault as the recording stores it.
  Pose world_from_depth_camera(const Eigen::Matrix4d& stored) const;
};

/// Overrides what the YAML file gives. Every key is optional; rotation vectors are in radians,
/// lengths in metres; `camera` sets both cameras at once.
///
///     camera: {width: 640, height: 480, fx: 525, fy: 525, cx: 319.5, cy: 239.5, depth_scale: 1000}
///     depth_camera: {width, height, fx, fy, cx, cy, depth_scale: 1000, invalid: [0, 65535]}
///     color_camera: {width, height, fx, fy, cx, cy}
///         each also with distortion: {model: brown_conrady, coefficients: [k1, k2, p1, p2, k3]}
///     color_from_depth: {rotation_vector: [0, 0, 0], translation: [0, 0, 0]}
///     poses: {direction: world_from_camera, axes: opencv, camera: depth}
///
/// Pose directions are world_from_camera and camera_from_world; axes opencv, opengl and ros;
/// cameras depth and color; distortion models brown_conrady (5 or 8 coefficients), kannala_brandt
/// (4) and none. Throws Error naming file, key, value and what is accepted.
void apply_calibration(const std::filesystem::path& file, CameraRig& rig);

/// The same for what a file, or a message, says. `name` is what messages of Error call it.
void apply_calibration(const std::string& yaml, const std::string& name, CameraRig& rig);

/// The same file's text for a rig, so that reading it back gives the rig.
std::string calibration_text(const CameraRig& rig);

}  // namespace ovimap
