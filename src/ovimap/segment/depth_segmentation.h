// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ovimap/segment/depth_surface.h"

namespace ovimap {

struct SegmentDepthConfig {
  DepthSurfaceConfig surface;
  float concave_angle_rad = 0.26f;  ///< a concave fold sharper than this is an edge (15 degrees)
  float concave_sigmas = 3.f;  ///< ... and sharper than this many sigmas of the fitted normals,
                               ///< which the frame itself tells (FrameNoise)
  int min_region_px = 100;     ///< smaller regions are dropped
  int regrow_px = 4;           ///< edge pixels take the nearest region within this many pixels
  float regrow_m = 0.05f;      ///< ... and within this distance in 3D
};
void list_fields(SegmentDepthConfig& config, ConfigFields& fields);

/// The thresholds of Furrer et al. 2018 as the original library ships them, for comparing label
/// maps.
SegmentDepthConfig reference_segment_depth_config();

struct DepthRegion {
  int area_px = 0;
  Eigen::AlignedBox2i extent_px;  ///< inclusive pixel box
};

/// A depth image cut into smooth or convex pieces.
struct DepthRegions {
  IdImage ids;                       ///< depth image size; 0 = none (invalid depth or too small)
  std::vector<DepthRegion> regions;  ///< regions[id - 1]; ids in raster order of first pixels
};

/// Geometric segmentation of a depth image (metres, 0 = invalid): regions bounded by depth
/// discontinuities and concave folds (method section 1; Furrer et al. 2018). Pure; the same bits
/// for every thread count.
DepthRegions segment_depth(const DepthImage& depth, const PinholeCamera& camera,
                           const SegmentDepthConfig& config);

/// The same for a surface already fitted with `config.surface`.
DepthRegions segment_depth(const DepthSurface& surface, const PinholeCamera& camera,
                           const SegmentDepthConfig& config);

/// For each region the pixel farthest from pixels of other ids, counted in steps along rows and
/// columns: where a promptable network should look. By region, [id - 1].
std::vector<Eigen::Vector2i> deepest_pixels(const DepthRegions& regions);

}  // namespace ovimap
