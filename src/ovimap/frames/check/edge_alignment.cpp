// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/check/edge_alignment.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "ovimap/base/config.h"
#include "ovimap/frames/frame/registration.h"
#include "ovimap/image/brightness.h"

namespace ovimap {

namespace {

using ByteImage = Image<std::uint8_t>;

/// How much brightness changes at each pixel, at most `limit` (and 255); 0 at the border.
ByteImage color_steps(const RgbImage& color, int limit) {
  ByteImage steps(color.width(), color.height());
  for (int y = 1; y + 1 < color.height(); ++y)
    for (int x = 1; x + 1 < color.width(); ++x) {
      const int along = brightness(color.at(x + 1, y)) - brightness(color.at(x - 1, y));
      const int down = brightness(color.at(x, y + 1)) - brightness(color.at(x, y - 1));
      steps.at(x, y) =
          static_cast<std::uint8_t>(std::min({std::abs(along) + std::abs(down), limit, 255}));
    }
  return steps;
}

/// The largest of each pixel and those around it: edges of depth are right to about a pixel.
ByteImage widened(const ByteImage& steps) {
  ByteImage wide(steps.width(), steps.height());
  for (int y = 1; y + 1 < steps.height(); ++y)
    for (int x = 1; x + 1 < steps.width(); ++x) {
      std::uint8_t largest = 0;
      for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u) largest = std::max(largest, steps.at(u, v));
      wide.at(x, y) = largest;
    }
  return wide;
}

bool ends_at(const DepthImage& depth, int x, int y, const EdgeAlignmentConfig& config) {
  const float here = depth.at(x, y);
  if (!(here > 0)) return false;
  const float behind = here + config.edge_step_m + config.edge_step_share * here;
  const int reach = config.edge_reach_px;
  return depth.at(x - reach, y) > behind || depth.at(x + reach, y) > behind ||
         depth.at(x, y - reach) > behind || depth.at(x, y + reach) > behind;
}

}  // namespace

void list_fields(EdgeAlignmentConfig& config, ConfigFields& fields) {
  fields.add("max_shift_px", config.max_shift_px, 1, 1000,
             "shifts of colour that are tried, pixels");
  fields.add("shift_step_px", config.shift_step_px, 1, 100, "between them, pixels");
  fields.add("edge_reach_px", config.edge_reach_px, 1, 20, "distance over which depth is compared");
  fields.add("edge_step_m", config.edge_step_m, 0.f, 10.f, "step in depth that is an edge, metres");
  fields.add("edge_step_share", config.edge_step_share, 0.f, 1.f, "with this share of the depth");
  fields.add("max_gradient", config.max_gradient, 1, 255, "colour steps count up to this");
  fields.add("min_edges", config.min_edges, 1, 1000000, "fewer edge pixels in a cell tell nothing");
  fields.add("min_misplaced_px", config.min_misplaced_px, 1, 1000,
             "colour that is farther off is not registered, pixels");
  fields.add("min_gain", config.min_gain, 1.f, 100.f,
             "how much stronger colour steps must be there");
  fields.add("misplaced_cells", config.misplaced_cells, 0.f, 1.f,
             "share of the image's cells that must be off");
}

EdgeAlignment::EdgeAlignment(const EdgeAlignmentConfig& config) : config_(config) {
  steps_.resize(static_cast<std::size_t>(kCells * kCells * shifts() * shifts()));
}

void EdgeAlignment::add(const Frame& frame) {
  const ByteImage steps = widened(color_steps(frame.color, config_.max_gradient));
  const Registration registration(frame);
  const int width = steps.width(), height = steps.height(), margin = config_.max_shift_px;
  const int reach = config_.edge_reach_px;
  for (int v = reach; v + reach < frame.depth.height(); v += 2)
    for (int u = reach; u + reach < frame.depth.width(); ++u) {
      if (!ends_at(frame.depth, u, v, config_)) continue;
      const std::int32_t index = registration.color_index().at(u, v);
      if (index == Registration::kNoColor) continue;
      const int x = index % width, y = index / width;
      if (x < margin || y < margin || x + margin >= width || y + margin >= height) continue;
      const int cell = y * kCells / height * kCells + x * kCells / width;
      ++edges_[static_cast<std::size_t>(cell)];
      std::int64_t* sum = &steps_[static_cast<std::size_t>(cell * shifts() * shifts())];
      for (int i = 0; i < shifts(); ++i)
        for (int j = 0; j < shifts(); ++j) *sum++ += steps.at(x + shift_of(j), y + shift_of(i));
    }
}

std::vector<EdgeAlignment::Cell> EdgeAlignment::cells() const {
  std::vector<Cell> result;
  const auto count = static_cast<std::ptrdiff_t>(shifts()) * shifts();
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const auto first = steps_.begin() + static_cast<std::ptrdiff_t>(i) * count;
    const auto best = std::max_element(first, first + count);
    const auto as_is = static_cast<double>(first[count / 2]);
    const auto at = static_cast<int>(best - first);
    Cell cell{edges_[i], {shift_of(at % shifts()), shift_of(at / shifts())}, 1};
    if (as_is > 0) cell.gain = static_cast<double>(*best) / as_is;
    result.push_back(cell);
  }
  return result;
}

EdgeAlignment::Verdict EdgeAlignment::verdict() const {
  Verdict verdict;
  std::vector<double> lengths;
  for (const Cell& cell : cells()) {
    if (cell.edges < config_.min_edges) continue;
    ++verdict.judged;
    const double length = cell.shift_px.cast<double>().norm();
    if (length >= config_.min_misplaced_px && cell.gain >= config_.min_gain)
      lengths.push_back(length);
  }
  verdict.misplaced = static_cast<int>(lengths.size());
  if (lengths.empty()) return verdict;
  std::sort(lengths.begin(), lengths.end());
  verdict.shift_px = lengths[lengths.size() / 2];
  verdict.registered = verdict.misplaced < config_.misplaced_cells * verdict.judged;
  return verdict;
}

}  // namespace ovimap
