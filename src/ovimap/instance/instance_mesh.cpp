// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_mesh.h"

#include "ovimap/map/surface/incremental_mesh.h"
#include "ovimap/map/surface/mesh_extraction.h"

namespace ovimap {

std::vector<InstanceId> instances_by_label(const VoxelMap& map,
                                           std::span<const InstanceSummary> instances) {
  std::vector<InstanceId> instance_of(map.labels().roots().size(), 0);
  for (const InstanceSummary& instance : instances)
    for (Label root : instance.super_points) instance_of[root] = instance.id;
  return instance_of;
}

Mesh extract_instance_mesh(const VoxelMap& map, std::span<const InstanceSummary> instances) {
  const std::vector<InstanceId> instance_of = instances_by_label(map, instances);
  Mesh mesh = extract_mesh(map);
  for (std::uint32_t& label : mesh.labels) label = instance_of[label];
  return mesh;
}

std::size_t SurfaceSampler::CellHash::operator()(const Cell& cell) const {
  std::uint64_t hash = cell.instance;
  for (const int place : {cell.x, cell.y, cell.z}) {
    hash = (hash ^ static_cast<std::uint32_t>(place)) * 0x9e3779b97f4a7c15ull;
    hash ^= hash >> 32;
  }
  return static_cast<std::size_t>(hash);
}

void SurfaceSampler::add(const Mesh& part) {
  for (std::size_t i = 0; i < part.labels.size(); ++i) {
    if (part.labels[i] == 0) continue;
    const Eigen::Vector3i cell = (part.vertices[i] / spacing_m_).array().floor().cast<int>();
    if (taken_.insert({part.labels[i], cell.x(), cell.y(), cell.z()}).second)
      surfaces_[part.labels[i]].push_back(part.vertices[i]);
  }
}

InstanceSurfaces sample_surfaces(const Mesh& mesh, float spacing_m) {
  SurfaceSampler sampler(spacing_m);
  sampler.add(mesh);
  return sampler.take();
}

InstanceSurfaces sample_surfaces(const VoxelMap& map, std::span<const InstanceSummary> instances) {
  const std::vector<InstanceId> instance_of = instances_by_label(map, instances);
  SurfaceSampler sampler(surface_spacing_m(map.config().voxel_size_m));
  for_each_patch(map, [&](Mesh& patch) {
    for (std::uint32_t& label : patch.labels) label = instance_of[label];
    sampler.add(patch);
  });
  return sampler.take();
}

}  // namespace ovimap
