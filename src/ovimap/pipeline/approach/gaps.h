// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Geometry>

#include "ovimap/map/fusion/seen_free.h"

namespace ovimap {

class ConfigFields;

struct GapsConfig {
  float thin_m = 0.006f;        ///< a surface is known too little where its standard error is more
  float least_area_m2 = 0.15f;  ///< smaller gaps are left out
  int most = 24;                ///< so many at most, the largest
};
void list_fields(GapsConfig& config, ConfigFields& fields);

enum class GapKind {
  kUnseen,  ///< space that was looked through ends where nobody looked
  kThin,    ///< surface that few or bad looks show
};

/// Where somebody who scans a place should look next.
struct Gap {
  GapKind kind = GapKind::kUnseen;
  Eigen::Vector3f middle =
      Eigen::Vector3f::Zero();  ///< world, metres: the cell nearest to the mean
  Eigen::AlignedBox3f box;      ///< likewise
  float area_m2 = 0;            ///< a face of a cell for each cell
};

/// The standard error of the surface by block (surface_error_m), by pack_index.
using SurfaceErrors = std::map<std::uint64_t, float>;

/// The gaps of a map, in pieces that hang together in cubes of 16 cells, the largest first. Unseen
/// is a cell beside one that was looked through, in which nobody saw anything and that is not next
/// to surface, where rays graze (frontiers, Yamauchi 1997). `cell_m`: VoxelMapConfig::block_size_m.
/// Without space that was looked through (`run --dynamic off`, old maps) nothing is known to be
/// unseen. The same bits in every run.
std::vector<Gap> find_gaps(const SeenFree& space, const SurfaceErrors& surface, float cell_m,
                           const GapsConfig& config = {});

}  // namespace ovimap
