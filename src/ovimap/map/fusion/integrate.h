// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"
#include "ovimap/map/voxels/block_choice.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

/// What one frame adds to the map. All images have the depth camera's size.
struct Observation {
  const DepthImage& depth;      ///< metres, 0 = invalid
  const PinholeCamera& camera;  ///< of the depth
  const Pose& world_from_camera;
  const RgbImage* color = nullptr;            ///< registered to the depth; black = unknown
  const Image<float>* plane_slope = nullptr;  ///< see DepthSurface::plane_slope; 0 = unknown
  const Image<float>* sigma_m = nullptr;  ///< standard deviation of the depth; null: unknown, it
                                          ///< is taken to grow with depth
  const Image<float>* free_m = nullptr;  ///< free_depth of the frame; null: made where it is needed
  const IdImage* segment_ids = nullptr;  ///< segment of each pixel; 0 = none
  std::span<const Label> segment_labels = {};  ///< label of segment id, at [id - 1]
  const BlockChoice* blocks = nullptr;  ///< the only ones that the frame may change; null: all
};

/// The band around a surface is as wide as so many standard deviations of its depth, where that is
/// more than the truncation, and no wider than this: what errs by more tells nothing.
inline constexpr float kBandSigmas = 3.f, kMostBand_m = 1.f;

/// Fuses one frame into the map: distance, colour and label support, one pass over the blocks near
/// the observed surface (method section 5; linear drop-off behind the surface).
///
/// An observation weighs what it tells: the inverse of its variance in squared voxels, to which the
/// voxel's own half is added (Curless and Levoy 1996, section 3.1). So the weight of a voxel is its
/// information, and the square root of its inverse the standard error of its distance, in voxels.
/// Where the deviation is unknown an observation weighs 1/z^2, z in metres, as in voxblox.
///
/// Where a plane was fitted the distance is that to the plane: the difference of depths times the
/// plane's slope, else times the length of the ray. Projective distances alone are too long on
/// surfaces seen at a slant, and differ from view to view.
///
/// Voxels further than the truncation from the surface along their ray keep what they have, where
/// the depth is good. Where it may lie further off than that (kBandSigmas), the band is as wide as
/// its error: else only frames that err towards a voxel would count there, and each would leave a
/// sheet of its own. Distances are stored up to the truncation all the same, so that their mean is
/// that of a robust estimator. Labels go to voxels within one sigma of the surface, or
/// label_band_voxels.
///
/// The only writer of voxels, with vote_labels and clear_free_space. Returns the slots of the
/// blocks it visited, in block-index order.
std::vector<std::uint32_t> integrate(VoxelMap& map, const Observation& observation);
/// The same for whoever has allocated the blocks already: `slots` is what allocate_blocks returned
/// for this depth, camera and pose.
void integrate_in(VoxelMap& map, const Observation& observation,
                  std::span<const std::uint32_t> slots);

/// The frame's label votes alone, for masks that come after their frame was fused: the same voxels
/// as `integrate` would ask, without touching distance, weight or colour. The observation must have
/// segments. Returns likewise.
std::vector<std::uint32_t> vote_labels(VoxelMap& map, const Observation& observation);

/// Creates the blocks within the truncation of the observed surface and returns their slots, and
/// those of other blocks that are there within the band of an uncertain depth, in block-index
/// order; of Observation::blocks alone. Throws FrameError, with the map as it was, where memory has
/// no room for them (VoxelMap::room_bytes): noise in place of depth lies in more blocks than any
/// surface.
std::vector<std::uint32_t> allocate_blocks(VoxelMap& map, const Observation& observation);

}  // namespace ovimap
