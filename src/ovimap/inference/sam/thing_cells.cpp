// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/thing_cells.h"

#include <algorithm>
#include <cmath>

#include "ovimap/geometry/box_overlap.h"
#include "ovimap/inference/masks/logit_grid.h"

namespace ovimap {

namespace {

constexpr float kSameBoxIou = 0.6f;  // the usual threshold of suppressing lesser detections
constexpr float kMostLogCells = 6;   // e^6 cells are more than any image has

enum Map { kDepth, kLeft, kUpper, kRight, kLower, kFilled };

bool is_peak(const ThingCells& cells, int x, int y) {
  const float here = cells.depth(x, y);
  for (int v = std::max(0, y - 1); v <= std::min(cells.rows() - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(cells.columns() - 1, x + 1); ++u)
      if (cells.depth(u, v) > here) return false;
  return true;
}

struct Middle {
  float depth = 0;
  int x = 0, y = 0;
};

/// The deepest first; among equals in raster order.
std::vector<Middle> middles_of(const ThingCells& cells, float min_depth) {
  std::vector<Middle> middles;
  for (int y = 0; y < cells.rows(); ++y)
    for (int x = 0; x < cells.columns(); ++x)
      if (cells.depth(x, y) >= min_depth && is_peak(cells, x, y))
        middles.push_back({cells.depth(x, y), x, y});
  std::stable_sort(middles.begin(), middles.end(),
                   [](const Middle& a, const Middle& b) { return a.depth > b.depth; });
  return middles;
}

}  // namespace

ThingCells::ThingCells(const FinderMaps& maps, int width_px, int height_px)
    : rows_(maps.rows), columns_(maps.columns), image_from_cell_(maps.image_from_cell) {
  const Eigen::AlignedBox2f image(
      Eigen::Vector2f(0, 0),
      Eigen::Vector2f(static_cast<float>(width_px - 1), static_cast<float>(height_px - 1)));
  const auto count = static_cast<std::size_t>(rows_ * columns_);
  depths_.reserve(count), filled_.reserve(count), boxes_.reserve(count);
  const auto value = [&](Map map, std::size_t i) { return maps.values[map * count + i]; };
  const auto reach = [&](Map side, std::size_t i) {
    return std::exp(std::min(value(side, i), kMostLogCells));
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2f at =
        middle_px(static_cast<int>(i) % columns_, static_cast<int>(i) / columns_);
    const Eigen::Vector2f before(reach(kLeft, i), reach(kUpper, i));
    const Eigen::Vector2f after(reach(kRight, i), reach(kLower, i));
    const Eigen::AlignedBox2f box(at - before.cwiseProduct(image_from_cell_),
                                  at + after.cwiseProduct(image_from_cell_));
    depths_.push_back(logistic(value(kDepth, i)));
    filled_.push_back(logistic(value(kFilled, i)));
    boxes_.push_back(box.intersection(image));
  }
}

Eigen::Vector2f ThingCells::middle_px(int x, int y) const {
  const Eigen::Vector2f cell(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  return cell.cwiseProduct(image_from_cell_).array() - 0.5f;
}

MaskPrompt ThingCells::thing_at(int x, int y) const {
  const Eigen::AlignedBox2f& box = boxes_[index(x, y)];
  const float area_px = filled_[index(x, y)] * box.volume();
  return {middle_px(x, y), box, static_cast<int>(std::lround(area_px)), true};
}

float ThingCells::agreement(std::span<const Eigen::Vector2i> chosen,
                            const Eigen::AlignedBox2f& box) const {
  float sum = 0, weight = 0;
  for (const Eigen::Vector2i& cell : chosen) {
    const std::size_t i = index(cell.x(), cell.y());
    weight += depths_[i];
    sum += depths_[i] * overlap(boxes_[i], box);
  }
  return weight > 0 ? sum / weight : 0;
}

std::vector<Thing> things_in(const ThingCells& cells, const FinderConfig& config) {
  std::vector<Thing> things;
  for (const Middle& middle : middles_of(cells, config.min_depth)) {
    if (static_cast<int>(things.size()) == config.max_prompts) break;
    const MaskPrompt thing = cells.thing_at(middle.x, middle.y);
    const bool is_new = std::none_of(things.begin(), things.end(), [&](const Thing& other) {
      return overlap(thing.extent_px, other.prompt.extent_px) > kSameBoxIou;
    });
    if (thing.extent_px.contains(thing.interior_px) && is_new)
      things.push_back({thing, {middle.x, middle.y}});
  }
  return things;
}

}  // namespace ovimap
