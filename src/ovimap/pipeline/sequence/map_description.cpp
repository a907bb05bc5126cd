// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/map_description.h"

#include "ovimap/instance/instance_mesh.h"
#include "ovimap/instance/object_boxes.h"
#include "ovimap/io/corrections/map_edit_log.h"
#include "ovimap/io/pictures/scene_axes.h"
#include "ovimap/map/surface/incremental_mesh.h"

namespace ovimap {

namespace {

constexpr std::size_t kTriangle = 3;  // points: an object of fewer shows nowhere

}  // namespace

std::vector<InstanceSummary> summarize_objects(const SurfaceExtents& extents,
                                               const LabelForest& forest,
                                               const InstanceRegistry& registry,
                                               const InstanceSummaryConfig& config,
                                               const MapEdits& edits) {
  return summarize_instances(extents, forest, registry, config,
                             corrected_instances(edits, registry.aliases()));
}

void describe_map(const VoxelMap& map, const InstanceRegistry& registry,
                  const InstanceSummaryConfig& config, MapRecord& record) {
  const SurfaceExtents extents = surface_extents(map);
  record.instances = summarize_objects(extents, map.labels(), registry, config, record.edits);
  const std::vector<InstanceId> instance_of = instances_by_label(map, record.instances);
  const float spacing_m = surface_spacing_m(map.config().voxel_size_m);
  SurfaceSampler sampler(spacing_m);
  SurfaceDirections directions;
  for_each_patch(map, [&](Mesh& patch) {
    for (std::uint32_t& label : patch.labels) label = instance_of[label];
    sampler.add(patch);
    directions.add(patch);
  });
  record.surfaces = sampler.take();
  std::erase_if(record.instances, [&](const InstanceSummary& instance) {
    const auto surface = record.surfaces.find(instance.id);
    const bool shows = surface != record.surfaces.end() && surface->second.size() >= kTriangle;
    if (!shows) record.surfaces.erase(instance.id);
    return !shows;
  });
  fit_boxes(record.surfaces, spacing_m, record.instances);
  record.parts = find_parts(extents, record.instances, record.registry.entity_sightings, config);
  std::vector<Pose> poses;
  for (const FrameLogEntry& frame : record.frames) poses.push_back(frame.world_from_camera);
  record.up = guess_up(directions, poses);
}

}  // namespace ovimap
