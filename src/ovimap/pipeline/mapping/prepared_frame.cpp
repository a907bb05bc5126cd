// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/prepared_frame.h"

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
  const std::vector<Eigen::Vector2i> interiors = deepest_pixels(regions);
  for (std::size_t i = 0; i < prompts.size(); ++i) {
    const Eigen::Vector2i& interior = interiors[i];
    const std::int32_t index = color_index.at(interior.x(), interior.y());
    if (index == Registration::kNoColor) prompts[i].area_px = 0;
    prompts[i].interior_px = Eigen::Vector2f(static_cast<float>(index % color_width),
                                             static_cast<float>(index / color_width));
  }
  std::erase_if(prompts, [](const MaskPrompt& prompt) { return prompt.area_px == 0; });
  return prompts;
}

}  // namespace

PreparedFrame prepare_frame(std::shared_ptr<const Frame> frame, const MapperConfig& config,
                            StageTimers& timers) {
  Registration registration = [&] {
    auto t = timers.measure("registration");
    return Registration(*frame, config.occlusion_margin_m);
  }();
  DepthSurface surface = [&] {
    auto t = timers.measure("surface");
    return fit_depth_surface(frame->depth, frame->depth_camera, config.segment.surface);
  }();
  DepthEstimate estimate = [&] {
    auto t = timers.measure("estimate");
    return estimate_depth(frame->depth, surface, config.segment.surface.noise, config.depth);
  }();
  RgbImage color = registration.color_at_depth(frame->color);
  return {std::move(frame), std::move(registration), std::move(surface), std::move(estimate), std::move(color)};
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
    return masks->entities(frame, prompts_of(regions, prepared.registration, frame.color_camera));
  }();
  if (!entities) return std::nullopt;
  if (!entities->ids.same_size(frame.color))
    throw FrameError(concat("the '", masks->kind(), "' masks of frame ", frame.index, " are ",
                            entities->ids.width(), "x", entities->ids.height(),
                            ", but its colour image is ", frame.color.width(), "x",
                            frame.color.height(), "; give masks of the colour image's size"));
  cut.masked = true;
  cut.entities = static_cast<int>(entities->scores.size());
  auto t = timers.measure("mask_fusion");
  cut.segments = fuse_masks(regions, prepared.registration.ids_at_depth(entities->ids), frame.depth,
                            config.mask_fusion);
  return cut;
}

}  // namespace ovimap
