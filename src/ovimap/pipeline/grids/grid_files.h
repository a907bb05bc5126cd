// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "ovimap/pipeline/grids/occupancy_grid.h"

namespace ovimap {

/// Writes a slice as ROS map_server reads it: `path` (.yaml) beside STEM_grid.png (8-bit grey), and
/// the distances as STEM_esdf.png (16-bit grey, millimetres, 65535: 65.5 m or more, or no
/// obstacle). The YAML names that picture, the heights and the turn of the world under keys of its
/// own, which map_server passes over. Throws Error naming what cannot be written.
void write_grid_slice(const std::filesystem::path& path, const OccupancyGrid& grid,
                      const GridSlice& slice);

/// STEM_0.50m.yaml of STEM.yaml: the slice at a height.
std::filesystem::path layer_path(const std::filesystem::path& path, float height_m);

}  // namespace ovimap
