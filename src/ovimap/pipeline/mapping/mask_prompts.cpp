// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/mask_prompts.h"

#include <algorithm>
#include <map>

namespace ovimap {

namespace {

constexpr std::size_t kStrayDivisor = 100;  // a hundredth at each side may be stray voxels

/// What the colour image shows of a region.
struct ShownRegion {
  Eigen::AlignedBox2f extent_px;
  int area_px = 0;
};

/// Calls visit(region, x, y) for every pixel of a region that the colour image shows.
template <class Visit>
void for_each_color_pixel(const DepthRegions& regions, const Registration& registration,
                          const PinholeCamera& color_camera, const Visit& visit) {
  const Image<std::int32_t>& color_index = registration.color_index();
  for (std::size_t i = 0; i < regions.ids.size(); ++i)
    if (regions.ids[i] != 0 && color_index[i] != Registration::kNoColor)
      visit(regions.ids[i] - 1u, color_index[i] % color_camera.width,
            color_index[i] / color_camera.width);
}

/// With boxes around all pixels.
std::vector<ShownRegion> whole_regions(const DepthRegions& regions,
                                       const Registration& registration,
                                       const PinholeCamera& color_camera) {
  std::vector<ShownRegion> shown(regions.regions.size());
  for_each_color_pixel(regions, registration, color_camera, [&](std::size_t region, int x, int y) {
    shown[region].extent_px.extend(Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)));
    ++shown[region].area_px;
  });
  return shown;
}

/// Its smallest and its largest value but for stray ones.
std::pair<float, float> inner_range(std::vector<int>& values) {
  const std::size_t low = values.size() / kStrayDivisor, high = values.size() - 1 - low;
  const auto at = [&values](std::size_t rank) {
    const auto found = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), found, values.end());
    return static_cast<float>(*found);
  };
  return {at(low), at(high)};
}

/// With boxes around all but stray pixels.
std::vector<ShownRegion> inner_regions(const DepthRegions& regions,
                                       const Registration& registration,
                                       const PinholeCamera& color_camera) {
  std::vector<std::vector<int>> columns(regions.regions.size()), rows(regions.regions.size());
  for_each_color_pixel(regions, registration, color_camera, [&](std::size_t region, int x, int y) {
    columns[region].push_back(x);
    rows[region].push_back(y);
  });
  std::vector<ShownRegion> shown(regions.regions.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (columns[i].empty()) continue;
    const auto [left, right] = inner_range(columns[i]);
    const auto [top, bottom] = inner_range(rows[i]);
    shown[i] = {{Eigen::Vector2f(left, top), Eigen::Vector2f(right, bottom)},
                static_cast<int>(columns[i].size())};
  }
  return shown;
}

std::vector<MaskPrompt> prompts_of(const DepthRegions& regions,
                                   const std::vector<ShownRegion>& shown,
                                   const Registration& registration,
                                   const PinholeCamera& color_camera) {
  const std::vector<Eigen::Vector2i> interiors = deepest_pixels(regions);
  std::vector<MaskPrompt> prompts;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const std::int32_t index =
        registration.color_index().at(interiors[i].x(), interiors[i].y());
    if (shown[i].area_px == 0 || index == Registration::kNoColor) continue;
    prompts.push_back({.interior_px = {static_cast<float>(index % color_camera.width),
                                       static_cast<float>(index / color_camera.width)},
                       .extent_px = shown[i].extent_px,
                       .area_px = shown[i].area_px});
  }
  return prompts;
}

/// Objects numbered in ascending order of their ids.
DepthRegions regions_of(const Image<InstanceId>& instances) {
  std::map<InstanceId, std::uint16_t> numbers;
  for (const InstanceId id : instances)
    if (id != 0) numbers.emplace(id, 0);
  std::uint16_t last = 0;
  for (auto& [id, number] : numbers) number = ++last;
  DepthRegions regions{IdImage(instances.width(), instances.height()), {}};
  regions.regions.resize(numbers.size());
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (instances[i] == 0) continue;
    regions.ids[i] = numbers.at(instances[i]);
    ++regions.regions[regions.ids[i] - 1u].area_px;
  }
  return regions;
}

}  // namespace

std::vector<MaskPrompt> region_prompts(const DepthRegions& regions,
                                       const Registration& registration,
                                       const PinholeCamera& color_camera) {
  return prompts_of(regions, whole_regions(regions, registration, color_camera), registration,
                    color_camera);
}

std::vector<MaskPrompt> object_prompts(const Image<InstanceId>& instances,
                                       const Registration& registration,
                                       const PinholeCamera& color_camera) {
  const DepthRegions regions = regions_of(instances);
  std::vector<MaskPrompt> prompts =
      prompts_of(regions, inner_regions(regions, registration, color_camera), registration,
                 color_camera);
  for (MaskPrompt& prompt : prompts) prompt.known = true;
  return prompts;
}

}  // namespace ovimap
