// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/approach/ground_ways.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>

#include "ovimap/pipeline/grids/cell_parts.h"

namespace ovimap {

namespace {

constexpr std::uint8_t kStart = 8;  // no step

const std::array<Eigen::Vector2i, 8>& steps() {
  static const std::array<Eigen::Vector2i, 8> all = {
      {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  return all;
}

/// Whether the straight line between the middles of two cells stays on passable ones.
bool straight(const PassableCells& cells, const Eigen::Vector2i& a, const Eigen::Vector2i& b) {
  const Eigen::Vector2f way = (b - a).cast<float>();
  const int pieces = 2 * (b - a).cwiseAbs().maxCoeff();  // half a cell each
  for (int i = 1; i < pieces; ++i) {
    const Eigen::Vector2f at =
        a.cast<float>() + way * (static_cast<float>(i) / static_cast<float>(pieces));
    if (!cells.at((at.array() + 0.5f).floor().cast<int>())) return false;
  }
  return true;
}

}  // namespace

PassableCells::PassableCells(const GridSlice& slice, float radius_m)
    : passable_(slice.occupancy.width(), slice.occupancy.height()),
      origin_(slice.origin),
      cell_m_(slice.cell_m) {
  for (std::size_t i = 0; i < passable_.size(); ++i)
    passable_[i] = slice.occupancy[i] == kFreeLevel && slice.distance_m[i] >= radius_m;
}

Eigen::Vector2f PassableCells::place_of(const Eigen::Vector2i& cell) const {
  return middle_of_cell(origin_, cell_m_, height(), cell.x(), cell.y());
}

std::optional<Eigen::Vector2i> PassableCells::nearest(const Eigen::Vector2f& place,
                                                      float reach_m) const {
  std::optional<Eigen::Vector2i> best;
  float least = reach_m;
  for (int y = 0; y < height(); ++y)
    for (int x = 0; x < width(); ++x) {
      if (!at({x, y})) continue;
      const float away = (place_of({x, y}) - place).norm();
      if (away <= least) least = away, best = Eigen::Vector2i(x, y);
    }
  return best;
}

std::optional<Eigen::Vector2i> PassableCells::in_largest_part() const {
  const auto parts = connected_parts(passable_, 1, Corners::kConnected);
  const auto largest = std::max_element(
      parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  if (largest == parts.end()) return std::nullopt;
  return largest->front();
}

GroundWays::GroundWays(const PassableCells& cells, const Eigen::Vector2i& from)
    : cells_(cells),
      length_m_(cells.width(), cells.height(), std::numeric_limits<float>::infinity()),
      came_by_(cells.width(), cells.height(), kStart) {
  using Entry = std::tuple<float, int, int>;  // ties go by place, so that ways are always the same
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  length_m_.at(from.x(), from.y()) = 0.f;
  open.emplace(0.f, from.x(), from.y());
  while (!open.empty()) {
    const auto [length, x, y] = open.top();
    open.pop();
    if (length > length_m_.at(x, y)) continue;
    for (std::uint8_t k = 0; k < kStart; ++k) {
      const Eigen::Vector2i step = steps()[k], next = Eigen::Vector2i(x, y) + step;
      if (!cells_.at(next)) continue;
      const float further =
          length + cells_.cell_m() * std::sqrt(static_cast<float>(step.squaredNorm()));
      if (further >= length_m_.at(next.x(), next.y())) continue;
      length_m_.at(next.x(), next.y()) = further;
      came_by_.at(next.x(), next.y()) = k;
      open.emplace(further, next.x(), next.y());
    }
  }
}

std::vector<Eigen::Vector2f> GroundWays::way_to(const Eigen::Vector2i& cell) const {
  std::vector<Eigen::Vector2i> steps_back = {cell};
  while (came_by_.at(steps_back.back().x(), steps_back.back().y()) != kStart) {
    const Eigen::Vector2i& at = steps_back.back();
    steps_back.push_back(at - steps()[came_by_.at(at.x(), at.y())]);
  }
  std::vector<Eigen::Vector2f> corners = {cells_.place_of(steps_back.back())};
  for (std::size_t at = steps_back.size() - 1; at > 0;) {  // as far ahead as can be gone straight
    std::size_t next = at - 1;
    while (next > 0 && straight(cells_, steps_back[at], steps_back[next - 1])) --next;
    corners.push_back(cells_.place_of(steps_back[next]));
    at = next;
  }
  return corners;
}

}  // namespace ovimap
