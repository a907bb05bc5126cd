// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/mask_pool.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "ovimap/base/parallel.h"
#include "ovimap/inference/masks/entity_ids.h"

namespace ovimap {

namespace {

constexpr std::size_t kPooledRowsPerTask = 16;

std::size_t square(int size) {
  return static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
}

float iou(const AcceptedMask& a, const AcceptedMask& b) {
  const int both = a.mask.overlap(b.mask);
  return static_cast<float>(both) / static_cast<float>(a.area + b.area - both);
}

}  // namespace

MaskPool::MaskPool(const SamConfig& config, const LogitGrid& grid, std::optional<ThingCells> cells)
    : config_(config), grid_(grid), cells_(std::move(cells)) {}

std::optional<AcceptedMask> MaskPool::test(const MaskProposals& proposals, int token,
                                           float min_predicted_iou) const {
  const float predicted = proposals.predicted_iou[static_cast<std::size_t>(token)];
  if (predicted < min_predicted_iou) return std::nullopt;
  const std::size_t offset = static_cast<std::size_t>(token) * square(grid_.size);
  const std::span<const float> logits(proposals.logits.data() + offset, square(grid_.size));

  AcceptedMask found;
  found.mask = BitMask(grid_.width, grid_.height);
  int strict = 0, loose = 0;
  for (int y = 0; y < grid_.height; ++y) {
    const float* row =
        logits.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.size);
    for (int x = 0; x < grid_.width; ++x) {
      strict += row[x] > config_.stability_offset;
      loose += row[x] > -config_.stability_offset;
      if (row[x] > 0) found.mask.set(x, y);
    }
  }
  found.area = found.mask.count();
  found.stability = loose > 0 ? static_cast<float>(strict) / static_cast<float>(loose) : 0.f;
  const float area_px = static_cast<float>(found.area) * grid_.image_px_per_grid_px();
  const float share =
      static_cast<float>(found.area) / static_cast<float>(grid_.width * grid_.height);
  if (found.stability < config_.min_stability ||
      area_px < static_cast<float>(config_.min_mask_px) || share > config_.max_mask_share)
    return std::nullopt;
  found.score = std::min(predicted, 1.f) * found.stability;
  found.logits.assign(logits.begin(), logits.end());
  return found;
}

bool MaskPool::offer(const MaskProposals& proposals, const MaskPrompt* region, bool boxed) {
  std::vector<AcceptedMask> passed;
  for (int token = 0; token < proposals.tokens; ++token) {
    std::optional<AcceptedMask> mask = test(proposals, token, config_.min_predicted_iou);
    if (!mask || (boxed && share_inside(*mask, *region) < config_.part_inside_share)) continue;
    passed.push_back(std::move(*mask));
  }
  if (passed.empty()) return false;
  AcceptedMask& chosen = passed[region ? best_for_region(passed, *region) : largest_stable(passed)];
  chosen.own_region = region && fills(chosen, *region);
  if (region && region->known && !chosen.own_region) return false;
  const float area_px = static_cast<float>(chosen.area) * grid_.image_px_per_grid_px();
  if (cells_) chosen.score *= config_.finder.decoder_trust;
  add(std::move(chosen));
  if (!region) return true;
  const auto region_px = static_cast<float>(region->area_px);
  return area_px >= config_.explained_share * region_px &&
         area_px <= config_.explained_ratio * region_px;
}

bool MaskPool::offer_unasked(const MaskProposals& proposal, const MaskPrompt& thing) {
  std::optional<AcceptedMask> mask = test(proposal, 0, config_.finder.min_mask_iou);
  if (!mask || share_inside(*mask, thing) < config_.part_inside_share || !fills(*mask, thing))
    return false;
  mask->own_region = true;
  add(std::move(*mask));
  return true;
}

std::size_t MaskPool::largest_stable(const std::vector<AcceptedMask>& passed) const {
  const auto stable = [this](const AcceptedMask& mask) {
    return mask.stability >= config_.whole_stability;
  };
  const auto chosen = std::max_element(passed.begin(), passed.end(),
                                       [&stable](const AcceptedMask& a, const AcceptedMask& b) {
                                         if (stable(a) != stable(b)) return stable(b);
                                         return stable(a) ? a.area < b.area : a.score < b.score;
                                       });
  return static_cast<std::size_t>(chosen - passed.begin());
}

std::size_t MaskPool::best_for_region(const std::vector<AcceptedMask>& passed,
                                      const MaskPrompt& region) const {
  std::vector<float> scores;
  for (const AcceptedMask& mask : passed) {
    const float ratio = static_cast<float>(mask.area) * grid_.image_px_per_grid_px() /
                        static_cast<float>(region.area_px);
    scores.push_back(mask.score - config_.region_size_penalty * std::abs(std::log2(ratio)));
  }
  return static_cast<std::size_t>(std::max_element(scores.begin(), scores.end()) - scores.begin());
}

float MaskPool::share_inside(const AcceptedMask& mask, const MaskPrompt& region) const {
  const Eigen::Vector2f min = grid_.from_image(region.extent_px.min());
  const Eigen::Vector2f max = grid_.from_image(region.extent_px.max());
  const int y_end = std::min(grid_.height - 1, static_cast<int>(std::ceil(max.y())) + 1);
  const int x_end = std::min(grid_.width - 1, static_cast<int>(std::ceil(max.x())) + 1);
  int inside = 0;
  for (int y = std::max(0, static_cast<int>(min.y()) - 1); y <= y_end; ++y)
    for (int x = std::max(0, static_cast<int>(min.x()) - 1); x <= x_end; ++x)
      inside += mask.mask.at(x, y);
  return static_cast<float>(inside) / static_cast<float>(mask.area);
}

bool MaskPool::fills(const AcceptedMask& mask, const MaskPrompt& region) const {
  const float inside_px =
      share_inside(mask, region) * static_cast<float>(mask.area) * grid_.image_px_per_grid_px();
  const float mask_px = static_cast<float>(mask.area) * grid_.image_px_per_grid_px();
  // The region's pixels are unknown here; at best all of them lie in the part of the mask in its
  // box.
  const float both_px = std::min(inside_px, static_cast<float>(region.area_px));
  return both_px >
         config_.own_region_iou * (mask_px + static_cast<float>(region.area_px) - both_px);
}

void MaskPool::add(AcceptedMask mask) {
  locate(mask);
  for (AcceptedMask& held : masks_) {
    if (iou(held, mask) <= config_.duplicate_iou) continue;
    if (mask.score > held.score) held = std::move(mask);
    return;
  }
  masks_.push_back(std::move(mask));
}

void MaskPool::locate(AcceptedMask& mask) const {
  for (int y = 0; y < grid_.height; ++y)
    for (int x = 0; x < grid_.width; ++x)
      if (mask.mask.at(x, y)) {
        const Eigen::Vector2f middle = Eigen::Vector2i(x, y).cast<float>();
        mask.extent_px.extend(grid_.to_image(middle.array() - 0.5f));
        mask.extent_px.extend(grid_.to_image(middle.array() + 0.5f));
      }
  if (!cells_) return;
  for (int y = 0; y < cells_->rows(); ++y)
    for (int x = 0; x < cells_->columns(); ++x) {
      const Eigen::Vector2i at =
          grid_.from_image(cells_->middle_px(x, y)).array().round().cast<int>();
      if (at.x() >= grid_.width || at.y() >= grid_.height) continue;
      if (mask.mask.at(at.x(), at.y())) mask.cells.push_back({x, y});
    }
}

/// Asks the places in the smaller one which box is theirs: those in a mug say the mug's and not the
/// table's, those in a sofa's seat the sofa's. Where no finder tells, the configured margins
/// decide.
bool MaskPool::is_part(const AcceptedMask& mask, const AcceptedMask& larger) const {
  const auto inside = static_cast<float>(mask.mask.overlap(larger.mask));
  if (inside <= config_.part_inside_share * static_cast<float>(mask.area)) return false;
  if (!mask.cells.empty())
    return mask.score * cells_->agreement(mask.cells, mask.extent_px) <
           larger.score * cells_->agreement(mask.cells, larger.extent_px);
  const float margin = mask.own_region ? -config_.own_region_margin : config_.better_margin;
  return mask.score < larger.score + margin;
}

/// Of these, those that are no part of a larger one.
std::vector<std::size_t> MaskPool::whole_of(std::vector<std::size_t> largest_first) const {
  std::vector<std::size_t> whole;
  for (const std::size_t i : largest_first) {
    const bool part = std::any_of(whole.begin(), whole.end(), [&](std::size_t larger) {
      return is_part(masks_[i], masks_[larger]);
    });
    if (!part) whole.push_back(i);
  }
  return whole;
}

/// Those of which smaller ones leave less in sight than config_.min_shown_share.
std::vector<std::size_t> MaskPool::hidden_of(const std::vector<std::size_t>& largest_first) const {
  std::vector<std::size_t> hidden;
  BitMask smaller(grid_.width, grid_.height);
  for (auto i = largest_first.rbegin(); i != largest_first.rend(); ++i) {
    const AcceptedMask& mask = masks_[*i];
    const auto shown = static_cast<float>(mask.area - mask.mask.overlap(smaller));
    if (shown < config_.min_shown_share * static_cast<float>(mask.area))
      hidden.push_back(*i);
    else
      smaller |= mask.mask;
  }
  return hidden;
}

/// All masks but hidden ones, largest first. What was a part of a hidden one is looked at again
/// without it.
std::vector<std::size_t> MaskPool::shown_masks() const {
  std::vector<std::size_t> order(masks_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
    return masks_[a].area > masks_[b].area;
  });
  while (true) {
    const std::vector<std::size_t> hidden = hidden_of(whole_of(order));
    if (hidden.empty()) return order;
    std::erase_if(order, [&](std::size_t i) {
      return std::find(hidden.begin(), hidden.end(), i) != hidden.end();
    });
  }
}

BitMask MaskPool::covered() const {
  BitMask covered(grid_.width, grid_.height);
  for (const std::size_t i : shown_masks()) covered |= masks_[i].mask;
  return covered;
}

Entities MaskPool::entities() const {
  const std::vector<std::size_t> order = whole_of(shown_masks());
  Entities entities{IdImage(grid_.image_width_px, grid_.image_height_px), {}};
  for (const std::size_t i : order) entities.scores.push_back(masks_[i].score);
  parallel_for(static_cast<std::size_t>(grid_.image_height_px), kPooledRowsPerTask,
               [&](std::size_t row) {
                 const int y = static_cast<int>(row);
                 for (std::size_t k = 0; k < order.size(); ++k) {  // small over large
                   const LogitRow logits(masks_[order[k]].logits, grid_, y);
                   for (int x = 0; x < grid_.image_width_px; ++x)
                     if (logits.at(x) > 0)
                       entities.ids.at(x, y) = static_cast<std::uint16_t>(k + 1);
                 }
               });
  return keep_visible(std::move(entities), config_.min_mask_px);
}

}  // namespace ovimap
