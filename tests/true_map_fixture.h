// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: maps of rendered places, made from exact depth and true objects.

#include "ovimap/instance/instance_summary.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/map/fusion/integrate.h"
#include "ovimap/synth/camera/walk.h"
#include "ovimap/synth/render/renderer.h"

namespace ovimap::fixture {

/// The poses of a walk through the place, so many a second.
inline std::vector<Pose> walk_through(const SynthRoom& room, const RayScene& scene,
                                      const PinholeCamera& camera, double per_second) {
  const Walk walk = plan_walk(room, scene, camera);
  std::vector<Pose> poses;
  for (double time = 0; time < walk.seconds(); time += 1 / per_second)
    poses.push_back(walk.at(time));
  return poses;
}

/// Fuses what a camera at the poses sees; an object's id in the map is that in the room.
inline MapDocument true_map(const SynthRoom& room, const Renderer& renderer,
                            const PinholeCamera& camera, const std::vector<Pose>& poses,
                            float voxel_size_m) {
  VoxelMapConfig config;
  config.voxel_size_m = voxel_size_m;
  MapDocument document{{}, VoxelMap(config)};
  std::vector<Label> labels;
  for (std::size_t i = 0; i < room.objects.size(); ++i) {
    labels.push_back(document.map.labels().create());
    InstanceSummary instance;
    instance.id = room.objects[i].id;
    instance.super_points = {labels.back()};
    document.instances.push_back(std::move(instance));
  }
  for (const Pose& pose : poses) {
    const RenderedView view = renderer.render(camera, pose, false);
    integrate(document.map, {.depth = view.depth,
                             .camera = camera,
                             .world_from_camera = pose,
                             .segment_ids = &view.ids,
                             .segment_labels = labels});
    FrameLogEntry frame;
    frame.index = static_cast<std::int64_t>(document.frames.size());
    frame.world_from_camera = pose;
    document.frames.push_back(std::move(frame));
  }
  document.depth_camera = camera;
  measure_instances(document.map, document.instances);
  return document;
}

}  // namespace ovimap::fixture
