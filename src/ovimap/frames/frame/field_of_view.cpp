// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/frame/field_of_view.h"

#include <cmath>

namespace ovimap {

PinholeCamera camera_of_view(int width, int height, double horizontal_fov_rad,
                             double vertical_fov_rad) {
  const auto focal_px = [](int side, double fov) {
    return static_cast<float>(side / 2. / std::tan(fov / 2));
  };
  return {width,
          height,
          focal_px(width, horizontal_fov_rad),
          focal_px(height, vertical_fov_rad),
          static_cast<float>(width - 1) / 2,
          static_cast<float>(height - 1) / 2};
}

}  // namespace ovimap
