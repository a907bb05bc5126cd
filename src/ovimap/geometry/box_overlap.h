// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace ovimap {

/// Intersection over union of two boxes; 0 where neither has a volume.
template <int kDimensions>
float overlap(const Eigen::AlignedBox<float, kDimensions>& a,
              const Eigen::AlignedBox<float, kDimensions>& b) {
  const auto volume = [](const Eigen::AlignedBox<float, kDimensions>& box) {
    return box.isEmpty() ? 0.f : box.volume();
  };
  const float shared = volume(a.intersection(b)), all = volume(a) + volume(b) - shared;
  return all > 0.f ? shared / all : 0.f;
}

}  // namespace ovimap
