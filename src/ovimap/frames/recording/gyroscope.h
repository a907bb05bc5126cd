// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace ovimap {

/// In the folder of a recording: what its gyroscope measured, a sample a line.
inline constexpr const char* kGyroscopeFile = "gyroscope.txt";

/// A sample of a gyroscope.
struct TurnRate {
  double time_s = 0;
  Eigen::Vector3d rad_per_s = Eigen::Vector3d::Zero();  ///< about the axes of the depth camera
};

/// Reads lines of "time wx wy wz" (seconds; radians a second about the depth camera's x, y and z),
/// in any order; the samples are in order of time. Throws Error naming the first line that is
/// something else, or that no hand could turn a camera by.
std::vector<TurnRate> read_gyroscope(const std::filesystem::path& file);

/// The same file's text.
std::string gyroscope_text(const std::vector<TurnRate>& rates);

/// Where a camera's turns lead it: the rates of its gyroscope, linear from sample to sample,
/// integrated from the first one on.
class OrientationTimeline {
 public:
  explicit OrientationTimeline(std::vector<TurnRate> rates);  ///< in order of time

  /// The camera's rotation then, world_from_camera of a world in which it began without one;
  /// nullopt before the first sample, after the last, and between two that are too far apart.
  std::optional<Eigen::Quaterniond> at(double time_s) const;

 private:
  std::vector<TurnRate> rates_;
  std::vector<Eigen::Quaterniond> orientations_;  ///< at each sample
};

}  // namespace ovimap
