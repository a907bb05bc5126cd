// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

namespace ovimap {

/// How a lens bends the rays of a pinhole camera. Formulas and the order of coefficients are
/// OpenCV's (cv::projectPoints, cv::fisheye::projectPoints).
struct Lens {
  enum class Model {
    kStraight,       ///< a pinhole's
    kBrownConrady,   ///< k1 k2 p1 p2 k3, and k4 k5 k6 of a rational one
    kKannalaBrandt,  ///< fisheye: k1 k2 k3 k4
  };
  Model model = Model::kStraight;
  std::array<double, 8> coefficients{};  ///< those that a model lacks are 0

  bool operator==(const Lens&) const = default;

  /// Where the straight ray (x/z, y/z) meets the image, in the same unit: focal length 1, principal
  /// point 0.
  Eigen::Vector2d bend(const Eigen::Vector2d& ray) const;
};

}  // namespace ovimap
