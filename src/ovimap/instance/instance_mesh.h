// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "ovimap/geometry/mesh.h"
#include "ovimap/instance/instance_summary.h"

namespace ovimap {

/// By label: the instance that it belongs to, 0 for none of `instances`.
std::vector<InstanceId> instances_by_label(const VoxelMap& map,
                                           std::span<const InstanceSummary> instances);

/// The map's mesh with instance ids as labels. Only the ids of `instances` occur; other surface has
/// 0.
Mesh extract_instance_mesh(const VoxelMap& map, std::span<const InstanceSummary> instances);

/// Points of each object's surface, world frame, metres.
using InstanceSurfaces = std::map<InstanceId, std::vector<Eigen::Vector3f>>;

/// Edge of the cubes of each of which a map keeps one point of an object's surface: what is said of
/// objects needs no finer ones than 2 cm, and a voxel shows none.
inline constexpr float kSurfaceSpacing_m = 0.02f;
inline float surface_spacing_m(float voxel_size_m) {
  return std::max(kSurfaceSpacing_m, voxel_size_m);
}

/// Thins the surfaces of a mesh that comes in parts: of its vertices, one (the first) from each
/// cube of the edge `spacing_m` that holds some.
class SurfaceSampler {
 public:
  explicit SurfaceSampler(float spacing_m) : spacing_m_(spacing_m) {}
  /// Labels are instance ids; 0 is left out.
  void add(const Mesh& part);
  InstanceSurfaces take() { return std::move(surfaces_); }

 private:
  struct Cell {
    InstanceId instance;
    int x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct CellHash {
    std::size_t operator()(const Cell& cell) const;
  };

  float spacing_m_;
  std::unordered_set<Cell, CellHash> taken_;
  InstanceSurfaces surfaces_;
};

/// The mesh's vertices by label, one (the first) from each cube of the edge `spacing_m` that holds
/// some; label 0 is left out. Ordered as the vertices are.
InstanceSurfaces sample_surfaces(const Mesh& mesh, float spacing_m);

/// The same of a map's instances, patch by patch, as its voxels have it (surface_spacing_m).
InstanceSurfaces sample_surfaces(const VoxelMap& map, std::span<const InstanceSummary> instances);

}  // namespace ovimap
