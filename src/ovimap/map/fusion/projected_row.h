// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "ovimap/base/lanes.h"
#include "ovimap/geometry/camera.h"
#include "ovimap/map/voxels/voxel_block.h"

namespace ovimap {

static_assert(kBlockSide == kLanes, "a row of voxels is worked on at once");

/// Where eight voxels in a row along x lie in the image.
struct ProjectedRow {
  Floats z_m;            ///< of the voxel's centre along the optical axis
  Floats range_squared;  ///< of the voxel's centre from the camera, m^2
  Ints pixel;            ///< index of the nearest pixel, 0 outside the image
  Ints inside;           ///< mask
};

/// `start`: camera coordinates of the first; `steps`: FusionView::voxel_steps.
OVIMAP_INLINE void project(const PinholeCamera& camera, const Eigen::Vector3f& start,
                           const Eigen::Matrix3f& steps, ProjectedRow& row) {
  const Floats along = counted_from(0);
  const Floats x = start.x() + along * steps(0, 0), y = start.y() + along * steps(1, 0);
  row.z_m = start.z() + along * steps(2, 0);
  row.range_squared = x * x + y * y + row.z_m * row.z_m;
  const Floats inverse = 1.f / larger(row.z_m, broadcast(1e-6f));
  const Floats u = camera.fx * (x * inverse) + (camera.cx + 0.5f);
  const Floats v = camera.fy * (y * inverse) + (camera.cy + 0.5f);
  row.inside = (row.z_m > 1e-3f) & (u >= 0.f) & (v >= 0.f) &
               (u < static_cast<float>(camera.width)) & (v < static_cast<float>(camera.height));
  row.pixel = __builtin_convertvector(row.inside ? v : Floats{}, Ints) * camera.width +
              __builtin_convertvector(row.inside ? u : Floats{}, Ints);
}

}  // namespace ovimap
