// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/prompt_planner.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace ovimap {

namespace {

// Chamfer weights: 3 a step along an axis, 4 along a diagonal approximate three times the distance.
constexpr int kAxisStep = 3, kDiagonalStep = 4;

struct Hole {
  Eigen::Vector2i centre_grid_px;
  float radius_grid_px = 0;
};

/// Distance of each grid pixel to the nearest blocked pixel or to the border, in chamfer steps.
class ChamferDistance {
 public:
  ChamferDistance(const BitMask& covered, const BitMask& tried)
      : distance_(covered.width() + 2, covered.height() + 2, 0) {
    const int width = covered.width(), height = covered.height();
    for (int y = 1; y <= height; ++y)
      for (int x = 1; x <= width; ++x)
        if (!covered.at(x - 1, y - 1) && !tried.at(x - 1, y - 1))
          distance_.at(x, y) = nearer(x, y, -1);
    for (int y = height; y >= 1; --y)
      for (int x = width; x >= 1; --x)
        distance_.at(x, y) = std::min(distance_.at(x, y), nearer(x, y, 1));
  }

  /// The largest disc that touches nothing blocked; the first in raster order among equals.
  Hole largest() const {
    const auto found = std::max_element(distance_.begin(), distance_.end());
    const int at = static_cast<int>(found - distance_.begin());
    return {{at % distance_.width() - 1, at / distance_.width() - 1},
            static_cast<float>(*found) / static_cast<float>(kAxisStep)};
  }

 private:
  int nearer(int x, int y, int side) const {
    return std::min({distance_.at(x + side, y) + kAxisStep, distance_.at(x, y + side) + kAxisStep,
                     distance_.at(x + side, y + side) + kDiagonalStep,
                     distance_.at(x - side, y + side) + kDiagonalStep});
  }
  Image<int> distance_;
};

PromptPoints point_prompt(Eigen::Vector2f in_image_px) {
  // SAM was trained with a padding point wherever there is no box.
  return {{in_image_px, PointLabel::kForeground}, {{0, 0}, PointLabel::kPadding}};
}

PromptPoints box_prompt(const MaskPrompt& region) {
  return {{region.interior_px, PointLabel::kForeground},
          {region.extent_px.min(), PointLabel::kBoxMin},
          {region.extent_px.max(), PointLabel::kBoxMax}};
}

void set_disc(BitMask& mask, Eigen::Vector2i centre, int radius) {
  const int y_end = std::min(centre.y() + radius, mask.height() - 1);
  const int x_end = std::min(centre.x() + radius, mask.width() - 1);
  for (int y = std::max(centre.y() - radius, 0); y <= y_end; ++y)
    for (int x = std::max(centre.x() - radius, 0); x <= x_end; ++x)
      if ((Eigen::Vector2i(x, y) - centre).squaredNorm() <= radius * radius) mask.set(x, y);
}

}  // namespace

std::vector<PromptPoints> grid_prompts(int width_px, int height_px, int side) {
  const auto middle = [side](int cell, int size_px) {
    return (static_cast<float>(cell) + 0.5f) * static_cast<float>(size_px) /
               static_cast<float>(side) -
           0.5f;  // pixel centres are integers
  };
  std::vector<PromptPoints> prompts;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      prompts.push_back(point_prompt({middle(x, width_px), middle(y, height_px)}));
  return prompts;
}

PromptPlanner::PromptPlanner(const SamConfig& config, const LogitGrid& grid,
                             std::span<const MaskPrompt> regions)
    : config_(config), grid_(grid), tried_(grid.width, grid.height) {
  const auto inside = [&grid](const Eigen::Vector2f& point) {
    return (point.array() >= 0).all() && point.x() < static_cast<float>(grid.image_width_px) &&
           point.y() < static_cast<float>(grid.image_height_px);
  };
  for (const MaskPrompt& region : regions)
    if (region.area_px >= (region.known ? config.min_mask_px : config.min_region_px) &&
        inside(region.interior_px))
      regions_.push_back(region);
  std::stable_sort(regions_.begin(), regions_.end(),
                   [](const MaskPrompt& a, const MaskPrompt& b) { return a.area_px > b.area_px; });
  states_.assign(regions_.size(), RegionState::kOpen);
}

std::vector<PlannedPrompt> PromptPlanner::next(const MaskPool& pool, int count) {
  std::vector<Candidate> candidates;
  append_known(candidates);
  if (candidates.empty()) {
    append_regions(pool, candidates);
    append_holes(pool, count, candidates);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.gain_px > b.gain_px; });
  std::vector<PlannedPrompt> batch;
  for (const Candidate& candidate : candidates) {
    if (static_cast<int>(batch.size()) == count) break;
    if (candidate.prompt.boxed != candidates.front().prompt.boxed) continue;
    const bool hole = candidate.prompt.region < 0;
    if (hole && tried_.at(candidate.centre_grid_px.x(), candidate.centre_grid_px.y())) continue;
    mark_asked(candidate);
    batch.push_back(candidate.prompt);
  }
  return batch;
}

void PromptPlanner::failed(const PlannedPrompt& prompt) {
  if (prompt.region < 0) {
    // Its neighbours would fail as well; farther off there may be something else.
    set_disc(tried_, to_grid(prompt.points.front().in_image_px), prompt.radius_grid_px / 2);
  } else if (!prompt.boxed) {
    states_[static_cast<std::size_t>(prompt.region)] = RegionState::kRetry;
  }
}

const MaskPrompt* PromptPlanner::region_of(const PlannedPrompt& prompt) const {
  return prompt.region < 0 ? nullptr : &regions_[static_cast<std::size_t>(prompt.region)];
}

Eigen::Vector2i PromptPlanner::to_grid(Eigen::Vector2f in_image_px) const {
  const Eigen::Vector2f in_grid = grid_.from_image(in_image_px);
  return {std::clamp(static_cast<int>(std::lround(in_grid.x())), 0, grid_.width - 1),
          std::clamp(static_cast<int>(std::lround(in_grid.y())), 0, grid_.height - 1)};
}

void PromptPlanner::append_known(std::vector<Candidate>& candidates) const {
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    if (!regions_[i].known || states_[i] == RegionState::kDone) continue;
    PlannedPrompt prompt{box_prompt(regions_[i]), static_cast<int>(i), true, 0};
    candidates.push_back({std::move(prompt), static_cast<float>(regions_[i].area_px),
                          to_grid(regions_[i].interior_px)});
  }
}

void PromptPlanner::append_regions(const MaskPool& pool, std::vector<Candidate>& candidates) const {
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    if (states_[i] == RegionState::kDone || regions_[i].known) continue;
    const auto area_px = static_cast<float>(regions_[i].area_px);
    const Eigen::Vector2i centre = to_grid(regions_[i].interior_px);
    const float around_px = smallest_mask_at(pool, centre);
    const float disc_px = area_px / std::numbers::pi_v<float> / grid_.image_px_per_grid_px();
    const int radius = static_cast<int>(std::sqrt(disc_px));
    const int region = static_cast<int>(i);
    if (around_px == 0 && states_[i] == RegionState::kOpen)
      candidates.push_back(
          {{point_prompt(regions_[i].interior_px), region, false, radius}, area_px, centre});
    else if (around_px < config_.explained_share * area_px ||
             around_px > config_.explained_ratio * area_px)
      candidates.push_back(
          {{box_prompt(regions_[i]), region, true, radius}, config_.box_weight * area_px, centre});
  }
}

void PromptPlanner::append_holes(const MaskPool& pool, int count,
                                 std::vector<Candidate>& candidates) const {
  const float min_radius = min_hole_radius_grid_px();
  // A disc around a region that is yet to be asked would ask the same.
  const BitMask covered = pool.covered();
  BitMask blocked = tried_;
  for (const Candidate& region : candidates)
    if (!region.prompt.boxed)
      set_disc(blocked, region.centre_grid_px, region.prompt.radius_grid_px);
  for (int i = 0; i < count; ++i) {
    const Hole hole = ChamferDistance(covered, blocked).largest();
    if (hole.radius_grid_px < min_radius) return;
    const int radius = static_cast<int>(hole.radius_grid_px);
    set_disc(blocked, hole.centre_grid_px, radius);
    const Eigen::Vector2f in_image_px = grid_.to_image(hole.centre_grid_px.cast<float>());
    const float area_px = std::numbers::pi_v<float> * hole.radius_grid_px * hole.radius_grid_px *
                          grid_.image_px_per_grid_px();
    candidates.push_back({{point_prompt(in_image_px), -1, false, radius},
                          config_.hole_weight * area_px,
                          hole.centre_grid_px});
  }
}

float PromptPlanner::min_hole_radius_grid_px() const {
  return static_cast<float>(config_.min_hole_radius_px) * grid_.scale.minCoeff();
}

void PromptPlanner::mark_asked(const Candidate& candidate) {
  if (candidate.prompt.region >= 0)
    states_[static_cast<std::size_t>(candidate.prompt.region)] = RegionState::kDone;
  if (candidate.prompt.boxed) return;
  // An answer tells little about more than the point's surroundings.
  set_disc(tried_, candidate.centre_grid_px, static_cast<int>(min_hole_radius_grid_px()));
}

float PromptPlanner::smallest_mask_at(const MaskPool& pool, Eigen::Vector2i grid_px) const {
  int smallest = 0;
  for (const AcceptedMask& mask : pool.masks())
    if (mask.mask.at(grid_px.x(), grid_px.y()) && (smallest == 0 || mask.area < smallest))
      smallest = mask.area;
  return static_cast<float>(smallest) * grid_.image_px_per_grid_px();
}

}  // namespace ovimap
