// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/surface/marching_cubes_table.h"

#include <vector>

namespace ovimap {

namespace {

constexpr int kNone = -1;

/// Edge between two corners that differ in one axis.
int edge_between(int a, int b) {
  const int low = a < b ? a : b, axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
  for (int e = 4 * axis; e < 4 * axis + 4; ++e)
    if (kEdgeStart[static_cast<std::size_t>(e)] == low) return e;
  return kNone;
}

/// Corners of the face `side` (0 or 1) of `axis`, counter-clockwise seen from outside the cell.
std::array<int, 4> face_corners(int axis, int side) {
  const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
  if (side == 1) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

/// For every crossed edge, the crossed edge that follows it around the surface; kNone elsewhere.
std::array<int, 12> link_crossings(int inside) {
  std::array<int, 12> next;
  next.fill(kNone);
  for (int face = 0; face < 6; ++face) {
    const std::array<int, 4> corners = face_corners(face / 2, face % 2);
    for (std::size_t k = 0; k < 4; ++k) {
      const int corner = corners[k], before = corners[(k + 3) % 4];
      const bool enters = (inside >> corner & 1) && !(inside >> before & 1);
      if (!enters) continue;
      std::size_t last = k;  // walk to the end of this run of inside corners
      while (inside >> corners[(last + 1) % 4] & 1) last = (last + 1) % 4;
      const int exit_edge = edge_between(corners[last], corners[(last + 1) % 4]);
      next[static_cast<std::size_t>(edge_between(before, corner))] = exit_edge;
    }
  }
  return next;
}

CellTriangles triangulate(int inside) {
  CellTriangles result;
  std::array<int, 12> next = link_crossings(inside);
  for (std::size_t start = 0; start < 12; ++start) {
    std::vector<std::uint8_t> loop;
    for (std::size_t edge = start; next[edge] != kNone;) {
      loop.push_back(static_cast<std::uint8_t>(edge));
      const auto following = static_cast<std::size_t>(next[edge]);
      next[edge] = kNone;
      edge = following;
    }
    for (std::size_t i = 2; i < loop.size(); ++i)
      result.edges[result.count++] = {loop[0], loop[i - 1], loop[i]};
  }
  return result;
}

}  // namespace

const std::array<CellTriangles, 256>& marching_cubes_table() {
  static const auto table = [] {
    std::array<CellTriangles, 256> cells;
    for (int inside = 0; inside < 256; ++inside)
      cells[static_cast<std::size_t>(inside)] = triangulate(inside);
    return cells;
  }();
  return table;
}

}  // namespace ovimap
