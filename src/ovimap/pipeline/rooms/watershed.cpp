// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/rooms/watershed.h"

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <vector>

namespace ovimap {

namespace {

constexpr std::pair<int, int> kAround[] = {{-1, -1}, {0, -1}, {1, -1}, {-1, 0},
                                           {1, 0},   {-1, 1}, {0, 1},  {1, 1}};
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Regions as trees: a region that was joined to another points to it.
class Regions {
 public:
  std::uint32_t add(float peak) {
    above_.push_back(static_cast<std::uint32_t>(above_.size()));
    peaks_.push_back(peak);
    return above_.back();
  }
  std::uint32_t root(std::uint32_t region) {
    while (above_[region] != region) region = above_[region] = above_[above_[region]];
    return region;
  }
  float peak(std::uint32_t root) const { return peaks_[root]; }
  /// Regions are added by falling peak, so the lower number has the higher one.
  void join(std::uint32_t a, std::uint32_t b) { above_[std::max(a, b)] = std::min(a, b); }

 private:
  std::vector<std::uint32_t> above_;
  std::vector<float> peaks_;
};

}  // namespace

Image<std::uint16_t> watershed(const Image<float>& height, const WatershedConfig& config) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < height.size(); ++i)
    if (height[i] > 0.f) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return height[a] > height[b]; });
  Regions regions;
  Image<std::uint32_t> region(height.width(), height.height(), kNone);
  for (const std::uint32_t i : order) {
    const auto x = static_cast<int>(i) % height.width(), y = static_cast<int>(i) / height.width();
    std::uint32_t mine = kNone;  // of the highest neighbour: regions grow downhill
    float highest = 0.f;
    for (const auto& [dx, dy] : kAround) {
      if (!region.contains(x + dx, y + dy) || region.at(x + dx, y + dy) == kNone) continue;
      const std::uint32_t other = regions.root(region.at(x + dx, y + dy));
      if (mine != kNone && regions.root(mine) != other) {
        const float lower = std::min(regions.peak(regions.root(mine)), regions.peak(other));
        const bool parts = height[i] <= config.widest_pass && height[i] < config.share * lower;
        if (!parts) regions.join(regions.root(mine), other);
      }
      if (height.at(x + dx, y + dy) <= highest) continue;
      highest = height.at(x + dx, y + dy);
      mine = other;
    }
    region[i] = mine == kNone ? regions.add(height[i]) : mine;
  }
  Image<std::uint16_t> result(height.width(), height.height());
  constexpr std::size_t kMost = std::numeric_limits<std::uint16_t>::max();
  std::unordered_map<std::uint32_t, std::uint16_t> numbers;
  for (const std::uint32_t i : order) {
    // The lowest peaks of very many have no region.
    const auto next = static_cast<std::uint16_t>(numbers.size() < kMost ? numbers.size() + 1 : 0);
    result[i] = numbers.try_emplace(regions.root(region[i]), next).first->second;
  }
  return result;
}

}  // namespace ovimap
