// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ovimap/geometry/camera.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/image/image.h"
#include "ovimap/map/voxels/voxel_map.h"

namespace ovimap {

class ConfigFields;

struct ObservedSpaceConfig {
  int width_px = 160;       ///< of the images that stand for the frames
  int max_views = 300;      ///< frames looked at, evenly spread, ...
  float area_m2 = 400.f;    ///< ... for every such area of the ground plan that the cameras span
  float max_range_m = 8.f;  ///< further away nothing counts as seen
  float margin_m = 0.05f;   ///< a point counts as seen through when the surface is further behind
  float share = 0.f;        ///< the same as a share of the surface's distance
};
void list_fields(ObservedSpaceConfig& config, ConfigFields& fields);

/// Which space a map's cameras have looked through. A map keeps voxels near surfaces alone, so the
/// free space comes from its frame log: each camera sees the map's surface, and what lies in front
/// of it was empty. Rays that meet no surface tell nothing.
class ObservedSpace {
 public:
  /// Casts the views, a frame of `world_from_camera` each, and lets the map make room in between.
  /// `camera` is the depth camera.
  ObservedSpace(const VoxelMap& map, const PinholeCamera& camera,
                std::span<const Pose> world_from_camera, const ObservedSpaceConfig& config = {});

  /// The views that may see through some point of a ball (world frame, metres): the only ones that
  /// need be asked about points in it.
  std::vector<std::uint32_t> views_into(const Eigen::Vector3f& center_in_world,
                                        float radius_m) const;
  /// In how many of the views the point (world frame, metres) lies clearly in front of the surface;
  /// stops counting at `enough`.
  int seen_through(const Eigen::Vector3f& point_in_world, std::span<const std::uint32_t> views,
                   int enough = 1) const;

  std::size_t views() const { return views_.size(); }

 private:
  struct View {
    Eigen::Isometry3f camera_from_world;
    DepthImage depth;
    Image<float> farthest;  ///< depth in tiles of kTile x kTile pixels
  };
  static constexpr int kTile = 16;

  void cast(const VoxelMap& map, const Pose& world_from_camera, View& view) const;
  bool sees_through(const View& view, const Eigen::Vector3f& point_in_world) const;
  bool may_see_through(const View& view, const Eigen::Vector3f& center_in_world,
                       float radius_m) const;
  float farthest_in(const View& view, const Eigen::Vector3f& center, float radius_m) const;

  ObservedSpaceConfig config_;
  PinholeCamera camera_;
  std::vector<View> views_;
};

}  // namespace ovimap
