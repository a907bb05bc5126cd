// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/object_boxes.h"

#include <algorithm>
#include <numeric>

#include <tsl/robin_map.h>

#include "ovimap/base/parallel.h"
#include "ovimap/map/voxels/voxel_block.h"

namespace ovimap {

namespace {

constexpr float kCubeSpacings = 2.f;    // then points of one surface lie in cubes that touch
constexpr std::size_t kLeastPiece = 5;  // that part of the largest, a fifth
constexpr std::size_t kObjectsPerTask = 4;

/// Cubes that hold points, and which of them hang together.
class Pieces {
 public:
  Pieces(std::span<const Eigen::Vector3f> points, float edge_m) : points_(points) {
    cube_of_.reserve(points.size());
    for (const Eigen::Vector3f& point : points) {
      const Eigen::Vector3i cube = floor_to_int(point / edge_m);
      const auto [found, first] = known_.try_emplace(pack_index(cube), cubes_.size());
      if (first) cubes_.push_back(cube);
      cube_of_.push_back(found->second);
    }
    parent_.resize(cubes_.size());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t i = 0; i < cubes_.size(); ++i) join_neighbours(i);
  }

  Eigen::AlignedBox3f box_of_large_ones() {
    std::vector<std::size_t> counts(cubes_.size(), 0);
    for (const std::size_t cube : cube_of_) ++counts[root(cube)];
    const std::size_t largest = *std::max_element(counts.begin(), counts.end());
    Eigen::AlignedBox3f box;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (kLeastPiece * counts[root(cube_of_[i])] >= largest) box.extend(points_[i]);
    return box;
  }

 private:
  void join_neighbours(std::size_t i) {
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const auto found = known_.find(pack_index(cubes_[i] + Eigen::Vector3i(x, y, z)));
          if (found != known_.end()) parent_[root(found->second)] = root(i);
        }
  }

  std::size_t root(std::size_t cube) {
    while (parent_[cube] != cube) cube = parent_[cube] = parent_[parent_[cube]];
    return cube;
  }

  std::span<const Eigen::Vector3f> points_;
  tsl::robin_map<std::uint64_t, std::size_t, PackedIndexHash> known_;
  std::vector<Eigen::Vector3i> cubes_;
  std::vector<std::size_t> cube_of_, parent_;
};

}  // namespace

Eigen::AlignedBox3f box_without_specks(std::span<const Eigen::Vector3f> surface, float spacing_m) {
  if (surface.empty()) return {};
  return Pieces(surface, kCubeSpacings * spacing_m).box_of_large_ones();
}

void fit_boxes(const InstanceSurfaces& surfaces, float spacing_m,
               std::vector<InstanceSummary>& instances) {
  parallel_for(instances.size(), kObjectsPerTask, [&](std::size_t i) {
    const auto surface = surfaces.find(instances[i].id);
    if (surface == surfaces.end() || surface->second.empty()) return;
    give_box(box_without_specks(surface->second, spacing_m), instances[i]);
  });
}

InstanceSurfaces surfaces_and_boxes(const VoxelMap& map, std::vector<InstanceSummary>& instances) {
  InstanceSurfaces surfaces = sample_surfaces(map, instances);
  fit_boxes(surfaces, surface_spacing_m(map.config().voxel_size_m), instances);
  return surfaces;
}

}  // namespace ovimap
