// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace ovimap::apps {

/// {"min": [x, y, z], "max": ...}; null of a box that holds nothing.
template <typename Json>
Json box_json(const Eigen::AlignedBox3f& box) {
  if (box.isEmpty()) return nullptr;
  const auto corner = [](const Eigen::Vector3f& at) { return Json{at.x(), at.y(), at.z()}; };
  return {{"min", corner(box.min())}, {"max", corner(box.max())}};
}

}  // namespace ovimap::apps
