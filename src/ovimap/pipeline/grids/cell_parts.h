// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "ovimap/image/image.h"

namespace ovimap {

/// Whether cells that touch at a corner alone are connected.
enum class Corners { kApart, kConnected };

/// The connected parts of the cells (x, row) with that value, in the order of their first cells;
/// the cells of each from its first one on.
std::vector<std::vector<Eigen::Vector2i>> connected_parts(const Image<std::uint8_t>& cells,
                                                          std::uint8_t value, Corners corners);

}  // namespace ovimap
