// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/thing_look.h"

#include <cmath>
#include <map>

namespace ovimap {

namespace {

constexpr std::size_t kMostPoints = 400;

/// The pieces of a set of cells that touch, at corners as well, each as the indices of its points.
std::vector<std::vector<std::size_t>> pieces_of(std::map<std::uint64_t, std::vector<std::size_t>> cells) {
  std::vector<std::vector<std::size_t>> pieces;
  while (!cells.empty()) {
    std::vector<std::size_t>& piece = pieces.emplace_back();
    std::vector<std::uint64_t> front{cells.begin()->first};
    for (std::size_t i = 0; i < front.size(); ++i) {
      const auto cell = cells.find(front[i]);
      if (cell == cells.end()) continue;
      piece.insert(piece.end(), cell->second.begin(), cell->second.end());
      cells.erase(cell);
      const BlockIndex index = unpack_index(front[i]);
      for (int n = 0; n < 27; ++n)
        front.push_back(pack_index(index + BlockIndex(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
    }
  }
  return pieces;
}

}  // namespace

std::vector<Eigen::Vector3f> large_pieces(const std::vector<Eigen::Vector3f>& points, float gap_m,
                                          float least_share) {
  std::map<std::uint64_t, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < points.size(); ++i)
    cells[pack_index(block_at(points[i], 1.f / gap_m))].push_back(i);
  std::vector<Eigen::Vector3f> large;
  for (const auto& piece : pieces_of(std::move(cells)))
    if (static_cast<float>(piece.size()) >= least_share * static_cast<float>(points.size()))
      for (const std::size_t i : piece) large.push_back(points[i]);
  return large.empty() ? points : large;
}

std::array<std::uint8_t, 3> color_at(VoxelFinder& finder, const Eigen::Vector3f& point) {
  std::array<std::uint8_t, 3> color{};
  if (!finder.seek(point)) return color;
  const auto v = static_cast<std::size_t>(finder.voxel());
  for (std::size_t channel = 0; channel < color.size(); ++channel)
    color[channel] = static_cast<std::uint8_t>(finder.block().color[channel][v] >> 8);
  return color;
}

ThingLook thing_look(const MapDocument& map, InstanceId id, const Eigen::Vector3f& up) {
  ThingLook look;
  const auto surface = map.surfaces.find(id);
  if (surface == map.surfaces.end() || surface->second.empty()) return look;
  const std::size_t step = (surface->second.size() + kMostPoints - 1) / kMostPoints;
  const Eigen::Matrix3f upright =
      Eigen::Quaternionf::FromTwoVectors(up, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  VoxelFinder finder(map.map);
  for (std::size_t i = 0; i < surface->second.size(); i += step) {
    look.points.push_back(upright * surface->second[i]);
    look.colors.push_back(color_at(finder, surface->second[i]));
    mean += look.points.back();
  }
  mean /= static_cast<float>(look.points.size());
  float squares = 0;
  for (Eigen::Vector3f& point : look.points) squares += (point -= mean).squaredNorm();
  look.reach_m = std::sqrt(squares / static_cast<float>(look.points.size()));
  look.world_from_look.linear() = upright.transpose();
  look.world_from_look.translation() = upright.transpose() * mean;
  map.map.trim();
  return look;
}

}  // namespace ovimap
