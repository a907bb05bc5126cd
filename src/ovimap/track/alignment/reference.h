// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ovimap/base/lanes.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/map/voxels/voxel_map.h"
#include "ovimap/segment/depth_surface.h"
#include "ovimap/track/images/track_pyramid.h"

namespace ovimap {

/// A piece of surface that frames are aligned to, in the camera frame of its reference.
struct ReferencePoint {
  Eigen::Vector3f point;
  Eigen::Vector3f normal;  ///< unit; 0: the surface bends or breaks here, or is the sensor's alone
  float intensity = -1;    ///< -1: unknown
  Eigen::Vector2f gradient;  ///< of the intensity, per pixel of this level
};

/// Eight reference points side by side, as lanes take them. A place without a point is harmless to
/// calculate with.
struct EightPoints {
  float x[kLanes] = {}, y[kLanes] = {}, z[kLanes] = {1, 1, 1, 1, 1, 1, 1, 1};
  float normal_x[kLanes] = {}, normal_y[kLanes] = {}, normal_z[kLanes] = {};
  float intensity[kLanes] = {-1, -1, -1, -1, -1, -1, -1, -1};
  float gradient_x[kLanes] = {}, gradient_y[kLanes] = {};
};

/// Many points, eight and eight.
class ReferencePoints {
 public:
  void push_back(const ReferencePoint& point);
  ReferencePoint operator[](std::size_t index) const;
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// All of them; the last may not be full.
  const std::vector<EightPoints>& eights() const { return eights_; }

 private:
  std::vector<EightPoints> eights_;
  std::size_t size_ = 0;
};

/// The points of one level.
struct ReferenceLevel {
  PinholeCamera camera;
  ReferencePoints points;
};

/// What frames are aligned to: the map's surface as one pose sees it, with the intensities of the
/// frame that was taken there.
struct Reference {
  Pose world_from_camera = Pose::Identity();
  std::vector<ReferenceLevel> levels;  ///< as the frame's pyramid
  float median_depth_m = 1;
};

/// The map's inverse depth seen by a level's camera, where the map has a surface.
Image<float> cast_inverse_depth(const VoxelMap& map, const PinholeCamera& camera,
                                const Pose& world_from_camera, float max_range_m);

/// Takes depth out of a level where the map (`model`, as cast_inverse_depth gives it) has no
/// surface, so that only what both have holds the frame in place. Returns the share of its depth
/// that is left.
double keep_what_map_has(const Image<float>& model, TrackLevel& level);

/// Settles where a map (`model`, as cast_inverse_depth gives it for the level) and the depth of the
/// frame that was aligned to it contradict each other. Where the frame sees through the map, or has
/// the same surface elsewhere, the map is wrong and goes: about a thing that went, or a thin one
/// that was seen from its other side before, whose band of distances reaches through it and out on
/// this one. Where something stands before the map's surface both go: it may move.
///
/// They contradict each other by more than three standard deviations of both, and by more than
/// three times what they differ by in this view (1.4826 times the median, as of a normal
/// distribution): a pose that is off makes all of it differ, and contradicts nothing.
void settle_contradictions(const DepthNoiseConfig& noise, float model_sigma_m, Image<float>& model,
                           TrackLevel& level);

/// The reference of a frame at a pose. `model`: inverse depth of the map at the pyramid's level 1
/// (cast_inverse_depth), empty: the frame's own depth is the surface. Where the model has none, the
/// frame's depth is taken. A pyramid without its finest image gives no points there.
Reference make_reference(const TrackPyramid& pyramid, const Image<float>& model,
                         const Pose& world_from_camera);

/// The level whose pixels are the surface's pieces.
inline constexpr std::size_t kSurfaceLevel = kFewestLevels - 1;

}  // namespace ovimap
