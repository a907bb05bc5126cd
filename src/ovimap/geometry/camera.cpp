// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/geometry/camera.h"

#include <cmath>

#include "ovimap/geometry/camera_limits.h"

namespace ovimap {

bool PinholeCamera::valid() const {
  const auto is_focal = [](float length) { return length > 0 && length <= kMostFocal_px; };
  const auto is_place = [](float place) { return std::abs(place) <= kMostFocal_px; };
  return width > 0 && height > 0 && is_focal(fx) && is_focal(fy) && is_place(cx) && is_place(cy);
}

PinholeCamera PinholeCamera::scaled_to(int new_width, int new_height) const {
  const float sx = static_cast<float>(new_width) / static_cast<float>(width);
  const float sy = static_cast<float>(new_height) / static_cast<float>(height);
  // Pixel centres are integers, so the image spans [-0.5, width - 0.5].
  return {
      new_width, new_height, fx * sx, fy * sy, (cx + 0.5f) * sx - 0.5f, (cy + 0.5f) * sy - 0.5f};
}

}  // namespace ovimap
