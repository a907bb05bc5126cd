// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace ovimap {

/// Squared distance of a cell from which no obstacle can be reached: there is none.
inline constexpr float kNoObstacle = 1e20f;

/// The exact squared Euclidean distance of every cell's centre to that of the nearest obstacle, in
/// cells. Cells lie x fastest, then y, then z; `size` is how many there are along each axis (a flat
/// grid has size.z() = 1), `obstacle` has one entry a cell, not 0 at obstacles. Linear in the
/// number of cells: one lower envelope of parabolas per line and axis (Felzenszwalb and
/// Huttenlocher, "Distance Transforms of Sampled Functions", 2012).
std::vector<float> squared_distances(std::span<const std::uint8_t> obstacle,
                                     const Eigen::Vector3i& size);

}  // namespace ovimap
