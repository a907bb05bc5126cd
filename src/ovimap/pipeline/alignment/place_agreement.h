// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"

namespace ovimap {

class ConfigFields;

struct PlaceConfig {
  int width_px = 80;          ///< of the images that stand for frames
  int max_views = 48;         ///< frames that are looked at, evenly spread
  float max_range_m = 8.f;    ///< farther surface does not count
  float tolerance_m = 0.05f;  ///< surfaces nearer to each other agree
};
void list_fields(PlaceConfig& config, ConfigFields& fields);

/// What a map's cameras see of its surface: small depth images, ray cast from the poses of its
/// frames.
struct PlaceView {
  PinholeCamera camera;
  Pose world_from_camera = Pose::Identity();
  DepthImage depth;                ///< along the optical axis, metres; 0: no surface
  Image<Eigen::Vector3f> normals;  ///< of the surface, camera frame, unit; 0: it bends or breaks
  Image<std::uint8_t> telling;     ///< whether a pixel counts
};

/// Level surface does not count where there is enough of other: floors and table tops lie on each
/// other wherever one map is put on the other.
std::vector<PlaceView> place_views(const MapDocument& map, const PlaceConfig& config);

/// How well what cameras see agrees with a map that they are held against, in pixels that count.
struct PlaceAgreement {
  double pixels = 0;        ///< that show surface
  double meeting = 0;       ///< the map has the same surface there
  double seen_through = 0;  ///< the map has surface in front of it
  PlaceAgreement& operator+=(const PlaceAgreement& other);
  /// Share of what is seen that is the map's.
  double overlap() const { return pixels > 0 ? meeting / pixels : 0; }
};

/// Holds one view against a map, in whose world its camera is said to be, as a lost camera is held
/// against a place. What lies in front of the map's surface says nothing, for the map may not have
/// looked there; whether it did, its own views say when they are held against the other map.
PlaceAgreement agreement(const PlaceView& view, const VoxelMap& map, const Pose& map_from_camera,
                         const PlaceConfig& config);

}  // namespace ovimap
