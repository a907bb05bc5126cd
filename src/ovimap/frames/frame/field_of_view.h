// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/camera.h"

namespace ovimap {

/// The camera that sees so much, with its axis through the middle of the image. Angles in radians,
/// above 0 and below pi.
PinholeCamera camera_of_view(int width, int height, double horizontal_fov_rad,
                             double vertical_fov_rad);

}  // namespace ovimap
