// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "ovimap/map/fusion/free_tiles.h"
#include "ovimap/map/fusion/seen_free.h"

namespace ovimap::plain {

/// Whether every corner of a box around a cell's sphere shows in the image, and every pixel of the
/// tiles (LeastTiles) between the outermost of them runs free to behind the sphere; pixel by pixel.
inline bool looks_through(const PinholeCamera& camera, const Pose& world_from_camera,
                          const Image<float>& free_m, const BlockIndex& cell, float cell_m) {
  const Eigen::Vector3d middle =
      (cell.cast<double>() + Eigen::Vector3d::Constant(0.5)) * static_cast<double>(cell_m);
  const Eigen::Vector3f center = (world_from_camera.inverse() * middle).cast<float>();
  const float radius = cell_m * 0.8660254f;
  Eigen::Vector2f low = Eigen::Vector2f::Constant(1e9f), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f sides(corner & 1 ? 1.f : -1.f, corner & 2 ? 1.f : -1.f,
                                corner & 4 ? 1.f : -1.f);
    const Eigen::Vector3f point = center + radius * sides;
    if (point.z() < 0.05f) return false;
    const Eigen::Vector2f pixel = camera.project(point);
    low = low.cwiseMin(pixel), high = high.cwiseMax(pixel);
  }
  if (low.minCoeff() < 0.f || high.x() > static_cast<float>(camera.width - 1) ||
      high.y() > static_cast<float>(camera.height - 1))
    return false;
  constexpr int kTile = LeastTiles::kTile_px;
  const auto tile = [](float pixel) { return static_cast<int>(pixel + 0.5f) / kTile; };
  for (int y = tile(low.y()) * kTile; y < std::min((tile(high.y()) + 1) * kTile, camera.height);
       ++y)
    for (int x = tile(low.x()) * kTile; x < std::min((tile(high.x()) + 1) * kTile, camera.width);
         ++x)
      if (free_m.at(x, y) <= center.z() + radius) return false;
  return true;
}

}  // namespace ovimap::plain
