// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/mask_prompts.h"

namespace ovimap {

namespace {

/// What the colour image shows of a region.
struct ShownRegion {
  Eigen::AlignedBox2f extent_px;
  int area_px = 0;
};

std::vector<ShownRegion> shown_regions(const DepthRegions& regions,
                                       const Registration& registration,
                                       const PinholeCamera& color_camera) {
  const Image<std::int32_t>& color_index = registration.color_index();
  std::vector<ShownRegion> shown(regions.regions.size());
  for (std::size_t i = 0; i < regions.ids.size(); ++i) {
    if (regions.ids[i] == 0 || color_index[i] == Registration::kNoColor) continue;
    ShownRegion& region = shown[regions.ids[i] - 1u];
    region.extent_px.extend(
        Eigen::Vector2f(static_cast<float>(color_index[i] % color_camera.width),
                        static_cast<float>(color_index[i] / color_camera.width)));
    ++region.area_px;
  }
  return shown;
}

}  // namespace

std::vector<MaskPrompt> region_prompts(const DepthRegions& regions,
                                       const Registration& registration,
                                       const PinholeCamera& color_camera) {
  const std::vector<ShownRegion> shown = shown_regions(regions, registration, color_camera);
  const std::vector<Eigen::Vector2i> interiors = deepest_pixels(regions);
  std::vector<MaskPrompt> prompts;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const std::int32_t index = registration.color_index().at(interiors[i].x(), interiors[i].y());
    if (shown[i].area_px == 0 || index == Registration::kNoColor) continue;
    prompts.push_back({.interior_px = {static_cast<float>(index % color_camera.width),
                                       static_cast<float>(index / color_camera.width)},
                       .extent_px = shown[i].extent_px,
                       .area_px = shown[i].area_px});
  }
  return prompts;
}

}  // namespace ovimap
