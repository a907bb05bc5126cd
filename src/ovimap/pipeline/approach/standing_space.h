// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include <Eigen/Core>

#include "ovimap/instance/instance_registry.h"
#include "ovimap/pipeline/approach/sight_grid.h"
#include "ovimap/pipeline/grids/occupancy_grid.h"

namespace ovimap {

/// A place on an object's surface, grid frame, metres.
struct SurfaceSample {
  Eigen::Vector3f point;
  Eigen::Vector3f normal;  ///< unit length, outward
};

/// What is asked again and again where to stand: free space, what hides what, objects. It needs a
/// few MB for a house, and neither the map's voxels nor its mesh.
struct StandingSpace {
  OccupancyGrid grid;
  SightGrid sight;
  std::map<InstanceId, std::vector<SurfaceSample>> surfaces;  ///< evenly spread, at most 128 each
};

/// `document`: a corrected map. Throws what make_occupancy_grid throws.
StandingSpace make_standing_space(const MapDocument& document, const OccupancyConfig& config = {});

}  // namespace ovimap
