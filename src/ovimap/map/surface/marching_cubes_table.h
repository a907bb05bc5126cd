// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace ovimap {

/// Corner i of a cell lies at (i & 1, i >> 1 & 1, i >> 2 & 1). Edge e runs along axis e / 4 from
/// kEdgeStart[e].
inline constexpr std::array<std::uint8_t, 12> kEdgeStart{0, 2, 4, 6, 0, 1, 4, 5, 0, 1, 2, 3};
inline constexpr int edge_axis(int edge) {
  return edge / 4;
}

/// Triangles of a cell: three edges each, counter-clockwise seen from the positive side.
struct CellTriangles {
  std::uint8_t count = 0;
  std::array<std::array<std::uint8_t, 3>, 10> edges{};
};

/// Triangles by the set of corners with negative distance (bit i: corner i).
///
/// Derived rather than typed in: on each face the crossings around every run of inside corners are
/// joined, so an ambiguous face separates its inside corners, in both cells that share it alike;
/// the joined crossings close to loops, which are cut into fans (Lorensen and Cline 1987; the face
/// rule makes the mesh watertight).
const std::array<CellTriangles, 256>& marching_cubes_table();

}  // namespace ovimap
