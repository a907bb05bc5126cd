// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/prepared_frame.h"

#include <algorithm>

#include "ovimap/pipeline/mapping/mask_prompts.h"

namespace ovimap {

namespace {

DepthReading read_depth(const DepthImage& depth, const PinholeCamera& camera,
                        const MapperConfig& config, StageTimers& timers) {
  DepthSurface surface = [&] {
    auto t = timers.measure("surface");
    return fit_depth_surface(depth, camera, config.segment.surface);
  }();
  auto t = timers.measure("estimate");
  DepthEstimate estimate =
      estimate_depth(depth, surface, config.segment.surface.noise, config.depth);
  return {std::move(surface), std::move(estimate)};
}

/// Nothing where nothing was taken out.
std::optional<DepthReading> read_whole(const Frame& frame, const MapperConfig& config,
                                       StageTimers& timers) {
  if (frame.taken_out.empty()) return std::nullopt;
  DepthImage depth = frame.depth;
  for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = std::max(depth[i], frame.taken_out[i]);
  return read_depth(depth, frame.depth_camera, config, timers);
}

Image<float> read_free_depth(const Frame& frame, const DepthReading& read,
                             const MapperConfig& config, StageTimers& timers) {
  const bool asked = config.free_space.enabled || config.motion.mode != DynamicMode::kOff;
  if (!asked || read.estimate.sigma_m.empty()) return {};
  auto t = timers.measure("free_depth");
  return free_depth(config.map,
                    {.depth = read.estimate.depth_m,
                     .camera = frame.depth_camera,
                     .world_from_camera = frame.world_from_camera,
                     .plane_slope = &read.surface.plane_slope,
                     .sigma_m = &read.estimate.sigma_m},
                    config.free_space);
}

/// Each may be a super-point of its own for ever; SAM's grids give some hundred.
constexpr std::size_t kMostEntities = 2000;
constexpr double kAllOfIt = 0.98;  // of a picture: borders may be left out

bool tells_nothing(const Entities& entities) {
  if (entities.scores.size() != 1) return entities.scores.empty();
  const auto shown = std::count_if(entities.ids.begin(), entities.ids.end(),
                                   [](std::uint16_t id) { return id != 0; });
  return static_cast<double>(shown) > kAllOfIt * static_cast<double>(entities.ids.size());
}

}  // namespace

PreparedFrame prepare_frame(std::shared_ptr<const Frame> frame, const MapperConfig& config,
                            StageTimers& timers) {
  Registration registration = [&] {
    auto t = timers.measure("registration");
    return Registration(*frame, config.occlusion_margin_m);
  }();
  DepthReading read = read_depth(frame->depth, frame->depth_camera, config, timers);
  std::optional<DepthReading> whole = read_whole(*frame, config, timers);
  Image<float> free_m = read_free_depth(*frame, whole ? *whole : read, config, timers);
  RgbImage color = registration.color_at_depth(frame->color);
  return {std::move(frame),         std::move(registration), std::move(read.surface),
          std::move(read.estimate), std::move(color),        std::move(whole),
          std::move(free_m)};
}

std::optional<FrameSegments> cut_segments(const PreparedFrame& prepared, MaskSource* masks,
                                          const MapperConfig& config, StageTimers& timers) {
  const Frame& frame = *prepared.frame;
  const DepthRegions regions = [&] {
    auto t = timers.measure("regions");
    return segment_depth(prepared.surface, frame.depth_camera, config.segment);
  }();
  FrameSegments cut;
  cut.regions = static_cast<int>(regions.regions.size());
  if (!masks) {
    cut.segments = segments_of_regions(regions);
    return cut;
  }
  const std::optional<Entities> entities = [&] {
    auto t = timers.measure("masks");
    return masks->entities(frame,
                           region_prompts(regions, prepared.registration, frame.color_camera));
  }();
  if (!entities) return std::nullopt;
  if (!entities->ids.same_size(frame.color))
    throw FrameError(concat("the '", masks->kind(), "' masks of frame ", frame.index, " are ",
                            entities->ids.width(), "x", entities->ids.height(),
                            ", but its colour image is ", frame.color.width(), "x",
                            frame.color.height(), "; give masks of the colour image's size"));
  if (entities->scores.size() > kMostEntities)
    throw FrameError(concat("the '", masks->kind(), "' masks of frame ", frame.index, " name ",
                            entities->scores.size(), " things; more than ", kMostEntities,
                            " in one image are noise"));
  cut.masked = true;
  cut.blank = tells_nothing(*entities);
  cut.entities = static_cast<int>(entities->scores.size());
  auto t = timers.measure("mask_fusion");
  cut.segments = fuse_masks(regions, prepared.registration.ids_at_depth(entities->ids), frame.depth,
                            config.mask_fusion);
  cut.segments.ratings = entities->scores;
  return cut;
}

}  // namespace ovimap
