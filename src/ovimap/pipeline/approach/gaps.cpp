// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/approach/gaps.h"

#include <algorithm>
#include <set>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

using Cells = std::set<std::uint64_t>;

template <class Visit>
void for_neighbours(const BlockIndex& cell, const Visit& visit) {
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if (x != 0 || y != 0 || z != 0) visit(BlockIndex(cell + BlockIndex(x, y, z)));
}

bool near_surface(const SurfaceErrors& surface, const BlockIndex& cell) {
  bool near = surface.contains(pack_index(cell));
  for_neighbours(
      cell, [&](const BlockIndex& other) { near = near || surface.contains(pack_index(other)); });
  return near;
}

Cells unseen_cells(const SeenFree& space, const SurfaceErrors& surface) {
  Cells unseen;
  SpaceFinder finder(space);
  for (const auto& [key, region] : space.regions())
    for (std::size_t i = 0; i < region.size(); ++i) {
      if (region[i].looks == 0) continue;
      const BlockIndex cell = BlockRegion::block_at(unpack_index(key), i);
      for (int side = 0; side < 6; ++side) {
        BlockIndex next = cell;
        next[side / 2] += side % 2 == 0 ? -1 : 1;
        if (unseen.contains(pack_index(next)) || finder.at(next) != SpaceCell{}) continue;
        if (!near_surface(surface, next)) unseen.insert(pack_index(next));
      }
    }
  return unseen;
}

/// Cubes of so many cells: somebody who scans goes to one place after another.
bool in_one_cube(const BlockIndex& a, const BlockIndex& b) {
  constexpr int kCubeShift = 4;
  for (int axis = 0; axis < 3; ++axis)
    if (a[axis] >> kCubeShift != b[axis] >> kCubeShift) return false;
  return true;
}

/// The cells in pieces that hang together in a cube, by their corners too.
std::vector<std::vector<BlockIndex>> pieces_of(Cells cells) {
  std::vector<std::vector<BlockIndex>> pieces;
  while (!cells.empty()) {
    std::vector<BlockIndex>& piece = pieces.emplace_back();
    piece.push_back(unpack_index(*cells.begin()));
    cells.erase(cells.begin());
    for (std::size_t i = 0; i < piece.size(); ++i)
      for_neighbours(BlockIndex(piece[i]), [&](const BlockIndex& next) {
        if (in_one_cube(piece[i], next) && cells.erase(pack_index(next)) > 0) piece.push_back(next);
      });
  }
  return pieces;
}

Gap gap_of(const std::vector<BlockIndex>& piece, GapKind kind, float cell_m) {
  Gap gap;
  gap.kind = kind;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const BlockIndex& cell : piece) {
    gap.box.extend(cell.cast<float>() * cell_m);
    gap.box.extend((cell.array() + 1).cast<float>().matrix() * cell_m);
    mean += cell.cast<double>() / static_cast<double>(piece.size());
  }
  const auto nearest =
      std::min_element(piece.begin(), piece.end(), [&](const BlockIndex& a, const BlockIndex& b) {
        return (a.cast<double>() - mean).squaredNorm() < (b.cast<double>() - mean).squaredNorm();
      });
  gap.middle = (nearest->cast<float>().array() + 0.5f) * cell_m;
  gap.area_m2 = static_cast<float>(piece.size()) * cell_m * cell_m;
  return gap;
}

}  // namespace

void list_fields(GapsConfig& config, ConfigFields& fields) {
  fields.add("thin_m", config.thin_m, 0.f, 1.f,
             "a surface is known too little where its standard error is more, metres");
  fields.add("least_area_m2", config.least_area_m2, 0.f, 1000.f,
             "smaller gaps are left out, square metres");
  fields.add("most", config.most, 1, 10000, "so many gaps at most, the largest");
}

std::vector<Gap> find_gaps(const SeenFree& space, const SurfaceErrors& surface, float cell_m,
                           const GapsConfig& config) {
  Cells thin;
  for (const auto& [key, error_m] : surface)
    if (error_m > config.thin_m) thin.insert(key);
  std::vector<Gap> gaps;
  for (const auto& piece : pieces_of(unseen_cells(space, surface)))
    gaps.push_back(gap_of(piece, GapKind::kUnseen, cell_m));
  for (const auto& piece : pieces_of(std::move(thin)))
    gaps.push_back(gap_of(piece, GapKind::kThin, cell_m));
  std::erase_if(gaps, [&](const Gap& gap) { return gap.area_m2 < config.least_area_m2; });
  std::stable_sort(gaps.begin(), gaps.end(),
                   [](const Gap& a, const Gap& b) { return a.area_m2 > b.area_m2; });
  if (gaps.size() > static_cast<std::size_t>(config.most))
    gaps.resize(static_cast<std::size_t>(config.most));
  return gaps;
}

}  // namespace ovimap
