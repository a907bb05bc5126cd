// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/approach/standing_space.h"

#include <array>
#include <set>

#include "ovimap/instance/instance_mesh.h"

namespace ovimap {

namespace {

constexpr std::size_t kMostSamples = 128;

/// One sample (the first) from each cube that holds some; cubes grow until there are few enough.
std::vector<SurfaceSample> thinned(std::vector<SurfaceSample> samples, float cube_m) {
  while (samples.size() > kMostSamples) {
    std::set<std::array<int, 3>> taken;
    std::erase_if(samples, [&](const SurfaceSample& sample) {
      const Eigen::Vector3i cube = (sample.point / cube_m).array().floor().cast<int>();
      return !taken.insert({cube.x(), cube.y(), cube.z()}).second;
    });
    cube_m *= 1.25f;
  }
  return samples;
}

std::map<InstanceId, std::vector<SurfaceSample>> sample_objects(
    const Mesh& mesh, const Eigen::Matrix3f& grid_from_world, float spacing_m) {
  std::map<InstanceId, std::vector<SurfaceSample>> surfaces;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (mesh.labels[i] != 0)
      surfaces[mesh.labels[i]].push_back(
          {grid_from_world * mesh.vertices[i], grid_from_world * mesh.normals[i]});
  for (auto& [id, samples] : surfaces) samples = thinned(std::move(samples), spacing_m);
  return surfaces;
}

}  // namespace

StandingSpace make_standing_space(const MapDocument& document, const OccupancyConfig& config) {
  StandingSpace space;
  const Mesh mesh = extract_instance_mesh(document.map, document.instances);
  space.grid = make_occupancy_grid(document, mesh, config);
  space.sight = SightGrid(mesh, space.grid, document.map.config().voxel_size_m);
  space.surfaces =
      sample_objects(mesh, space.grid.grid_from_world, document.map.config().voxel_size_m);
  return space;
}

}  // namespace ovimap
