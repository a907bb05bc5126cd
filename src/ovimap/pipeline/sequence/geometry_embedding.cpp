// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/geometry_embedding.h"

#include <algorithm>
#include <map>

#include "ovimap/base/parallel.h"
#include "ovimap/base/version.h"
#include "ovimap/frames/frame/registration.h"
#include "ovimap/instance/instance_mesh.h"
#include "ovimap/io/pictures/pictures_raster.h"
#include "ovimap/io/pictures/scene_axes.h"

namespace ovimap {

namespace {

// Ids index tables. Exports mark what is no object by the largest number of their type.
constexpr std::uint32_t kLargestId = (1u << 24) - 1;

void require_labels(const Mesh& mesh) {
  if (mesh.triangles.empty())
    throw Error("the geometry has no triangles; give a mesh, not a point cloud");
  if (mesh.labels.size() != mesh.vertices.size() ||
      std::none_of(mesh.labels.begin(), mesh.labels.end(), [](auto id) { return id != 0; }))
    throw Error(
        "the geometry has no instance ids; give a PLY with a vertex property 'label', or a file "
        "with one id a line");
  const std::uint32_t largest = *std::max_element(mesh.labels.begin(), mesh.labels.end());
  if (largest > kLargestId)
    throw Error(concat("the geometry has instance id ", largest, "; ids go up to ", kLargestId,
                       ", and 0 marks what is no object: number the instances anew"));
}

/// Makes each object one super-point. Nothing of given geometry is ever merged.
void give_labels(std::vector<InstanceSummary>& objects, LabelForest& forest) {
  for (InstanceSummary& object : objects) object.super_points = {forest.create()};
}

/// Knows every object.
InstanceRegistry::State registry_of(const std::vector<InstanceSummary>& objects) {
  constexpr int kSeenOften = 1 << 20;
  InstanceRegistry::State state;
  state.frames = kSeenOften;
  for (const InstanceSummary& object : objects) {
    SuperPoint& point = state.super_points[object.super_points.front()];
    point.frames_seen = kSeenOften;
    point.votes[object.id] = kSeenOften;
    point.seen = FrameRuns({{0, kSeenOften}});
    state.last_id = object.id;
  }
  return state;
}

/// The label of each instance id.
std::vector<Label> label_table(const std::vector<InstanceSummary>& objects) {
  std::vector<Label> table(1, kNoLabel);
  for (const InstanceSummary& object : objects) {
    table.resize(object.id + 1, kNoLabel);  // ids ascend
    table[object.id] = object.super_points.front();
  }
  return table;
}

struct MeshView {
  DepthImage depth;
  Image<InstanceId> instances;
  Image<Label> labels;
};

/// The mesh as the frame's depth camera sees it, without what the measured depth hides.
MeshView look_at_mesh(const Mesh& mesh, const std::vector<Label>& label_of, const Frame& frame,
                      const GeometryEmbeddingConfig& config) {
  RasterView view;
  view.camera = frame.depth_camera;
  view.world_from_camera = frame.world_from_camera;
  view.near_m = config.near_m;
  RasterResult drawn = rasterize(mesh, view);
  const int width = frame.depth.width(), height = frame.depth.height();
  MeshView seen{std::move(drawn.depth_m), Image<InstanceId>(width, height),
                Image<Label>(width, height)};
  constexpr std::size_t kPixelsPerTask = 1 << 14;
  parallel_for(seen.depth.size(), kPixelsPerTask, [&](std::size_t i) {
    if (drawn.triangle[i] == RasterResult::kNoTriangle) return;
    const float measured = frame.depth[i];
    if (measured > 0.f && measured < seen.depth[i] - config.occlusion_margin_m) {
      seen.depth[i] = 0.f;
      return;
    }
    const auto& corners = mesh.triangles[drawn.triangle[i]];
    seen.instances[i] = mesh.labels[corners[0]];
    seen.labels[i] = label_of[seen.instances[i]];
  });
  return seen;
}

/// Feeds every usable frame to the builder.
void look_at_frames(const Mesh& mesh, const FrameSource& source,
                    const std::vector<std::int64_t>& positions,
                    const GeometryEmbeddingConfig& config, const MapDocument& document,
                    AppearanceBuilder& builder, SequenceResult& sequence,
                    const SequenceProgress& progress) {
  const LabelForest& forest = document.map.labels();
  const std::vector<Label> label_of = label_table(document.instances);
  InstanceRegistry registry(document.instance_config);
  registry.restore(InstanceRegistry::State(document.registry));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    FrameRead read = source.read(positions[i]);
    if (read.frame) {
      const Frame& frame = *read.frame;
      const MeshView seen = look_at_mesh(mesh, label_of, frame, config);
      const Registration registration(frame, seen.depth, config.occlusion_margin_m);
      builder.choose(frame,
                     {.depth = seen.depth,
                      .instances = seen.instances,
                      .labels = seen.labels,
                      .sensor_depth = frame.depth,
                      .color_index = registration.color_index(),
                      .camera = frame.depth_camera,
                      .world_from_camera = frame.world_from_camera,
                      .frame = frame.index},
                     registry, forest);
      builder.submit();
      if (sequence.frames.empty()) sequence.depth_camera = frame.depth_camera;
      sequence.frames.push_back(
          {frame.index, frame.timestamp_s, frame.name, frame.world_from_camera, true});
    } else {
      sequence.skipped.push_back({positions[i], read.fault});
    }
    if (progress && !progress(i + 1, positions.size(), nullptr)) break;
  }
  if (sequence.frames.empty())
    throw Error(concat("none of the ", sequence.skipped.size(), " frames is usable",
                       sequence.skipped.empty() ? "" : ": " + sequence.skipped.front().fault));
  builder.finish(forest);
}

}  // namespace

std::vector<InstanceSummary> summarize_mesh(const Mesh& mesh) {
  std::map<InstanceId, std::pair<InstanceSummary, Eigen::Vector3d>> objects;
  for (std::size_t i = 0; i < mesh.labels.size(); ++i) {
    if (mesh.labels[i] == 0) continue;
    auto& [object, sum] =
        objects.try_emplace(mesh.labels[i], InstanceSummary{}, Eigen::Vector3d::Zero())
            .first->second;
    object.box.extend(mesh.vertices[i]);
    sum += mesh.vertices[i].cast<double>();
    ++object.points;
  }
  std::vector<InstanceSummary> result;
  for (auto& [id, entry] : objects) {
    entry.first.id = id;
    entry.first.centroid = (entry.second / static_cast<double>(entry.first.points)).cast<float>();
    result.push_back(std::move(entry.first));
  }
  return result;
}

MapDocument embed_geometry(const Mesh& mesh, const FrameSource& source,
                           const std::vector<std::int64_t>& positions,
                           const GeometryEmbeddingConfig& config,
                           std::shared_ptr<ImageTextEncoder> encoder, SequenceResult& sequence,
                           const SequenceProgress& progress,
                           std::shared_ptr<const ThingRecognizer> recognizer) {
  require_labels(mesh);
  MapDocument document;
  document.instances = summarize_mesh(mesh);
  give_labels(document.instances, document.map.labels());
  document.registry = registry_of(document.instances);
  AppearanceBuilder builder(config.semantics, std::move(encoder));
  builder.recognize_with(std::move(recognizer));
  look_at_frames(mesh, source, positions, config, document, builder, sequence, progress);
  document.semantics = {builder.encoder() ? builder.encoder()->identity() : EncoderIdentity{},
                        config.semantics.views, config.semantics.crops, builder.take()};
  document.semantics.recognizer = builder.recognizer();
  for (InstanceSummary& object : document.instances)
    object.views = appearance_of(document.semantics.looks, object.super_points).offered;
  document.surfaces = sample_surfaces(mesh, kSurfaceSpacing_m);
  document.up = guess_up(mesh, poses_of(sequence.frames));
  document.frames = sequence.frames;
  document.depth_camera = sequence.depth_camera;
  document.version = concat(version(), " (", commit(), ")");
  return document;
}

}  // namespace ovimap
