// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// The map as a camera sees it.
struct Projection {
  DepthImage depth;     ///< along the optical axis, metres; 0 = the ray met no surface
  Image<Label> labels;  ///< super-point at the surface, merges resolved; 0 = none
};

/// Casts a ray through every pixel to the first zero crossing of the map, leaping over empty blocks
/// (method section 8). `max_range_m` is along the ray.
Projection cast_rays(const VoxelMap& map, const PinholeCamera& camera,
                     const Pose& world_from_camera, float max_range_m);

/// The same, with the sensor's depth as a guide: where `sensor_depth` is valid and the map has its
/// surface there (surface_voxels), that voxel is taken; only the other pixels are marched.
/// `surface` is the result of surface_voxels for that depth.
Projection cast_rays_with_depth(const VoxelMap& map, const DepthImage& sensor_depth,
                                const Image<VoxelRef>& surface, const PinholeCamera& camera,
                                const Pose& world_from_camera, float max_range_m);

}  // namespace ovimap
