// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/mask_prompts.h"

#include <algorithm>
#include <map>

namespace ovimap {

namespace {

constexpr std::size_t kStrayDivisor = 100;  ///< a hundredth at each side may be stray voxels

/// From the (values.size() / divisor)-th smallest value to the one as far from the largest.
std::pair<float, float> inner_range(std::vector<int>& values, std::size_t divisor) {
  const std::size_t low = divisor == 0 ? 0 : values.size() / divisor,
                    high = values.size() - 1 - low;
  const auto at = [&values](std::size_t rank) {
    const auto found = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), found, values.end());
    return static_cast<float>(*found);
  };
  return {at(low), at(high)};
}

/// `stray_divisor`: 0 when every pixel of a region counts for its box.
std::vector<MaskPrompt> prompts_of(const DepthRegions& regions, const Registration& registration,
                                   const PinholeCamera& color_camera, std::size_t stray_divisor) {
  struct Pixels {
    std::vector<int> columns, rows;
  };
  const Image<std::int32_t>& color_index = registration.color_index();
  std::vector<Pixels> pixels(regions.regions.size());
  for (std::size_t i = 0; i < regions.ids.size(); ++i) {
    if (regions.ids[i] == 0 || color_index[i] == Registration::kNoColor) continue;
    pixels[regions.ids[i] - 1u].columns.push_back(color_index[i] % color_camera.width);
    pixels[regions.ids[i] - 1u].rows.push_back(color_index[i] / color_camera.width);
  }
  const std::vector<Eigen::Vector2i> interiors = deepest_pixels(regions);
  std::vector<MaskPrompt> prompts;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::int32_t index = color_index.at(interiors[i].x(), interiors[i].y());
    if (pixels[i].columns.empty() || index == Registration::kNoColor) continue;
    const auto [left, right] = inner_range(pixels[i].columns, stray_divisor);
    const auto [top, bottom] = inner_range(pixels[i].rows, stray_divisor);
    prompts.push_back({.interior_px = {static_cast<float>(index % color_camera.width),
                                       static_cast<float>(index / color_camera.width)},
                       .extent_px = Eigen::AlignedBox2f(Eigen::Vector2f(left, top),
                                                        Eigen::Vector2f(right, bottom)),
                       .area_px = static_cast<int>(pixels[i].columns.size())});
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
  return prompts_of(regions, registration, color_camera, 0);
}

std::vector<MaskPrompt> object_prompts(const Image<InstanceId>& instances,
                                       const Registration& registration,
                                       const PinholeCamera& color_camera) {
  std::vector<MaskPrompt> prompts =
      prompts_of(regions_of(instances), registration, color_camera, kStrayDivisor);
  for (MaskPrompt& prompt : prompts) prompt.known = true;
  return prompts;
}

}  // namespace ovimap
