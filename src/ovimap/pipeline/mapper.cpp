// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapper.h"

#include <algorithm>

#include "ovimap/frames/registration.h"
#include "ovimap/map/integrate.h"
#include "ovimap/map/surface_lookup.h"

namespace ovimap {

namespace {

/// Where a promptable network should look: every region's place in the colour image.
std::vector<MaskPrompt> prompts_of(const DepthRegions& regions, const Registration& registration,
                                   const PinholeCamera& color_camera) {
  const Image<std::int32_t>& color_index = registration.color_index();
  std::vector<MaskPrompt> prompts(regions.regions.size());
  const int color_width = color_camera.width;
  for (std::size_t i = 0; i < regions.ids.size(); ++i) {
    if (regions.ids[i] == 0 || color_index[i] == Registration::kNoColor) continue;
    MaskPrompt& prompt = prompts[regions.ids[i] - 1u];
    ++prompt.area_px;
    prompt.extent_px.extend(Eigen::Vector2f(static_cast<float>(color_index[i] % color_width),
                                            static_cast<float>(color_index[i] / color_width)));
  }
  for (std::size_t i = 0; i < prompts.size(); ++i) {
    const Eigen::Vector2i& interior = regions.regions[i].interior_px;
    const std::int32_t index = color_index.at(interior.x(), interior.y());
    if (index == Registration::kNoColor) prompts[i].area_px = 0;
    prompts[i].interior_px = Eigen::Vector2f(static_cast<float>(index % color_width),
                                             static_cast<float>(index / color_width));
  }
  std::erase_if(prompts, [](const MaskPrompt& prompt) { return prompt.area_px == 0; });
  return prompts;
}

std::vector<Label> labels_of(std::span<const SegmentAssociation> associations) {
  std::vector<Label> labels;
  for (const SegmentAssociation& segment : associations) labels.push_back(segment.label);
  return labels;
}

}  // namespace

Mapper::Mapper(const MapperConfig& config, std::shared_ptr<MaskSource> masks,
               std::shared_ptr<ImageTextEncoder> encoder)
    : config_(config), masks_(std::move(masks)), map_(config.map), registry_(config.instance) {
  if (config_.view_interval == 0)
    config_.view_interval = encoder ? 1 : config_.stored_view_interval;
  builder_ = std::make_unique<AppearanceBuilder>(config_.semantics, std::move(encoder));
  if (config_.mask_interval == 0)
    config_.mask_interval = masks_ && masks_->is_slow() ? config_.network_mask_interval : 1;
}

FrameReport Mapper::process(const Frame& frame) {
  FrameReport report;
  const bool labelled = frames_ % config_.mask_interval == 0;
  const Registration registration = [&] {
    auto t = timers_.measure("registration");
    return Registration(frame, config_.occlusion_margin_m);
  }();
  const DepthSurface surface = [&] {
    auto t = timers_.measure("surface");
    return fit_depth_surface(frame.depth, frame.depth_camera, config_.segment.surface);
  }();
  const RgbImage color = registration.color_at_depth(frame.color);
  Segments segments;
  std::vector<SegmentAssociation> associations;
  if (labelled) {
    const DepthRegions regions = [&] {
      auto t = timers_.measure("regions");
      return segment_depth(surface, frame.depth_camera, config_.segment);
    }();
    report.regions = static_cast<int>(regions.regions.size());
    segments = cut_segments(frame, regions, registration, report);
    auto t = timers_.measure("associate");
    const Image<VoxelRef> voxels =
        surface_voxels(map_, frame.depth, frame.depth_camera, frame.world_from_camera);
    associations = associate(segments, voxels, map_, config_.association);
  }
  const std::vector<Label> labels = labels_of(associations);
  {
    auto t = timers_.measure("integrate");
    integrate(map_, {.depth = frame.depth,
                     .camera = frame.depth_camera,
                     .world_from_camera = frame.world_from_camera,
                     .color = &color,
                     .normals = &surface.normals,
                     .segment_ids = labelled ? &segments.ids : nullptr,
                     .segment_labels = labels});
  }
  if (labelled) {
    auto t = timers_.measure("registry");
    registry_.observe(segments, associations, frame.index, masks_ != nullptr, map_.labels());
  }
  if ((frames_ + 1) % config_.view_interval == 0) report.views = look_at_objects(frame);
  ++frames_;
  report.labelled = labelled;
  report.segments = static_cast<int>(segments.segments.size());
  report.founded = static_cast<int>(std::count_if(associations.begin(), associations.end(),
                                                  [](const auto& a) { return a.founded; }));
  return report;
}

Segments Mapper::cut_segments(const Frame& frame, const DepthRegions& regions,
                              const Registration& registration, FrameReport& report) {
  if (!masks_) return segments_of_regions(regions);
  Entities entities;
  {
    auto t = timers_.measure("masks");
    entities = masks_->entities(frame, prompts_of(regions, registration, frame.color_camera));
  }
  ++mask_frames_;
  report.entities = static_cast<int>(entities.scores.size());
  auto t = timers_.measure("mask_fusion");
  return fuse_masks(regions, registration.ids_at_depth(entities.ids), frame.depth,
                    config_.mask_fusion);
}

int Mapper::look_at_objects(const Frame& frame) {
  const InstanceView view = project(frame);
  int chosen = 0;
  {
    auto t = timers_.measure("views");
    chosen = builder_->choose(frame,
                              {.depth = view.depth,
                               .instances = view.instances,
                               .sensor_depth = frame.depth,
                               .camera = frame.depth_camera,
                               .world_from_camera = frame.world_from_camera,
                               .frame = frame.index},
                              registry_);
  }
  auto t = timers_.measure("await_encoder");
  builder_->submit();
  return chosen;
}

void Mapper::finish() {
  {
    auto t = timers_.measure("await_encoder");
    builder_->finish(registry_);
  }
  for (const double milliseconds : builder_->take_durations_ms())
    timers_.add("embed", milliseconds);
}

Appearances Mapper::take_appearances() {
  finish();
  return builder_->take();
}

InstanceView Mapper::project(const Frame& frame) {
  auto t = timers_.measure("project");
  const Image<VoxelRef> voxels =
      surface_voxels(map_, frame.depth, frame.depth_camera, frame.world_from_camera);
  Projection seen = cast_rays_with_depth(map_, frame.depth, voxels, frame.depth_camera,
                                         frame.world_from_camera, config_.max_range_m);
  const std::vector<InstanceId> instance_of = registry_.instance_table(map_.labels());
  InstanceView view{std::move(seen.depth),
                    Image<InstanceId>(frame.depth.width(), frame.depth.height())};
  for (std::size_t i = 0; i < seen.labels.size(); ++i)
    view.instances[i] = instance_of[seen.labels[i]];
  return view;
}

}  // namespace ovimap
