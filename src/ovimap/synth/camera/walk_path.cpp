// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/camera/walk_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

namespace ovimap {
namespace {

constexpr float kCell_m = 0.05f;
constexpr float kBlocked = std::numeric_limits<float>::infinity();
constexpr float kLow_m = 0.1f;      // lower things are stepped over
constexpr int kCornersPerLap = 10;  // waypoints, by direction from the middle
constexpr int kRadiusSteps = 24;
constexpr float kInnerLap = 0.5f;  // later laps, as a share of the way from the middle to the walls
constexpr int kSmoothings = 80;
constexpr float kSpacing_m = 0.05f;  // of the path while it is smoothed

float distance_outside(const OrientedBox& box, const Eigen::Vector2f& point) {
  const Eigen::Vector2f offset = point - box.center_m;
  const Eigen::Vector2f local(offset.dot(box.x_axis()), offset.dot(box.y_axis()));
  return (local.cwiseAbs() - box.half_m).cwiseMax(0).norm();
}

/// Points at equal distances along a polyline.
std::vector<Eigen::Vector2f> resampled(const std::vector<Eigen::Vector2f>& line, int count) {
  std::vector<float> along = {0};
  for (std::size_t i = 1; i < line.size(); ++i)
    along.push_back(along.back() + (line[i] - line[i - 1]).norm());
  std::vector<Eigen::Vector2f> points;
  std::size_t segment = 1;
  for (int i = 0; i < count; ++i) {
    const float wanted =
        along.back() * static_cast<float>(i) / static_cast<float>(std::max(count, 1));
    while (segment + 1 < line.size() && along[segment] < wanted) ++segment;
    const float length = along[segment] - along[segment - 1];
    const float part = length > 0 ? (wanted - along[segment - 1]) / length : 0;
    points.push_back(line[segment - 1] + part * (line[segment] - line[segment - 1]));
  }
  return points;
}

/// Rounds corners: every point moves towards the middle of its neighbours unless that costs more.
void smooth_loop(const WalkMap& map, std::vector<Eigen::Vector2f>& loop) {
  const std::size_t count = loop.size();
  for (int pass = 0; pass < kSmoothings; ++pass)
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector2f middle = (loop[(i + count - 1) % count] + loop[(i + 1) % count]) / 2;
      if (map.cost(middle) <= map.cost(loop[i])) loop[i] = middle;
    }
}

/// The cheapest point in this direction from the middle; among equals the one nearest to `share` of
/// the way to the wall.
Eigen::Vector2f corner(const SynthRoom& room, const WalkMap& map, float angle, float share) {
  const Eigen::Vector2f half = room.size_m.head<2>() / 2;
  const Eigen::Vector2f direction(std::cos(angle), std::sin(angle));
  const float reach = (half.array() / direction.array().abs().max(1e-6f)).minCoeff();
  Eigen::Vector2f best = half;
  float best_cost = kBlocked, best_miss = kBlocked;
  for (int i = 0; i <= kRadiusSteps; ++i) {
    const float part = static_cast<float>(i) / kRadiusSteps, miss = std::abs(part - share);
    const Eigen::Vector2f point = half + part * reach * direction;
    const float cost = map.cost(point);
    if (cost < best_cost || (cost == best_cost && miss < best_miss && cost != kBlocked))
      best = point, best_cost = cost, best_miss = miss;
  }
  return best;
}

/// Through all corners and back to the first, which stands at both ends.
std::vector<Eigen::Vector2f> closed_way(const WalkMap& map,
                                        const std::vector<Eigen::Vector2f>& corners) {
  std::vector<Eigen::Vector2f> loop;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    auto part = map.way(corners[i], corners[(i + 1) % corners.size()]);
    loop.insert(loop.end(), part.begin(), part.end() - 1);
  }
  if (!loop.empty()) loop.push_back(loop.front());
  return loop;
}

float length_of(const std::vector<Eigen::Vector2f>& line) {
  float length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

}  // namespace

WalkMap::WalkMap(const SynthRoom& room, const TrajectoryConfig& config) {
  const Eigen::Vector2f size = room.size_m.head<2>();
  costs_ = Image<float>(std::max(1, static_cast<int>(size.x() / kCell_m)),
                        std::max(1, static_cast<int>(size.y() / kCell_m)), 1.f);
  const float body_m = config.body_radius_m;
  for (std::size_t i = 0; i < costs_.size(); ++i) {
    const Eigen::Vector2f point = center_of(static_cast<int>(i));
    if (std::min(point.minCoeff(), (size - point).minCoeff()) < body_m) costs_[i] = kBlocked;
  }
  for (const OrientedBox& box : room.walls)
    for_each_cell_near(box, body_m, [&](std::size_t cell, float) { costs_[cell] = kBlocked; });
  for (const RoomObject& object : room.objects) {
    if (!object.footprint || object.footprint->top_m < kLow_m) continue;
    const OrientedBox& box = *object.footprint;
    const bool at_eye =
        box.top_m > config.lowest_eye_m - body_m && box.bottom_m < config.highest_eye_m + body_m;
    for_each_cell_near(box, body_m, [&](std::size_t cell, float distance_m) {
      if (at_eye) costs_[cell] = kBlocked;
      if (box.bottom_m < config.lowest_eye_m && distance_m < body_m / 2)
        costs_[cell] = std::max(costs_[cell], config.low_furniture_cost);
    });
  }
  find_largest_area();
}

template <class Visit>
void WalkMap::for_each_cell_near(const OrientedBox& box, float reach_m, const Visit& visit) {
  const float half_m = box.half_m.norm() + reach_m + kCell_m;
  const Eigen::Vector2f low = (box.center_m.array() - half_m) / kCell_m,
                        high = (box.center_m.array() + half_m) / kCell_m;
  const int last_x = std::min(static_cast<int>(high.x()), costs_.width() - 1),
            last_y = std::min(static_cast<int>(high.y()), costs_.height() - 1);
  for (int y = std::max(0, static_cast<int>(low.y())); y <= last_y; ++y)
    for (int x = std::max(0, static_cast<int>(low.x())); x <= last_x; ++x) {
      const int cell = y * costs_.width() + x;
      const float distance_m = distance_outside(box, center_of(cell));
      if (distance_m < reach_m) visit(static_cast<std::size_t>(cell), distance_m);
    }
}

void WalkMap::find_largest_area() {
  std::vector<bool> seen(costs_.size(), false);
  for (std::size_t start = 0; start < costs_.size(); ++start) {
    if (seen[start] || costs_[start] == kBlocked) continue;
    std::vector<int> area = {static_cast<int>(start)};
    seen[start] = true;
    for (std::size_t k = 0; k < area.size(); ++k)
      for (const auto [dx, dy] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const int x = area[k] % costs_.width() + dx, y = area[k] / costs_.width() + dy;
        if (!costs_.contains(x, y) || costs_.at(x, y) == kBlocked) continue;
        const int next = y * costs_.width() + x;
        if (seen[static_cast<std::size_t>(next)]) continue;
        seen[static_cast<std::size_t>(next)] = true;
        area.push_back(next);
      }
    if (area.size() > area_.size()) area_ = std::move(area);
  }
}

std::optional<Eigen::Vector2f> WalkMap::nearest_free(const Eigen::Vector2f& point_m) const {
  std::optional<Eigen::Vector2f> best;
  for (const int cell : area_) {
    const Eigen::Vector2f center = center_of(cell);
    if (!best || (center - point_m).squaredNorm() < (*best - point_m).squaredNorm()) best = center;
  }
  return best;
}

int WalkMap::cell_of(const Eigen::Vector2f& point_m) const {
  const int x = static_cast<int>(std::floor(point_m.x() / kCell_m));
  const int y = static_cast<int>(std::floor(point_m.y() / kCell_m));
  return costs_.contains(x, y) ? y * costs_.width() + x : -1;
}

Eigen::Vector2f WalkMap::center_of(int cell) const {
  return kCell_m * Eigen::Vector2f(static_cast<float>(cell % costs_.width()) + 0.5f,
                                   static_cast<float>(cell / costs_.width()) + 0.5f);
}

float WalkMap::cost(const Eigen::Vector2f& point_m) const {
  const int cell = cell_of(point_m);
  return cell < 0 ? kBlocked : costs_[static_cast<std::size_t>(cell)];
}

bool WalkMap::blocked(const Eigen::Vector2f& point_m) const {
  return cost(point_m) == kBlocked;
}

std::vector<Eigen::Vector2f> WalkMap::way(const Eigen::Vector2f& from_m,
                                          const Eigen::Vector2f& to_m) const {
  const int start = cell_of(from_m), goal = cell_of(to_m);
  if (start < 0 || goal < 0) return {from_m, to_m};
  using Entry = std::pair<float, int>;
  std::vector<float> reached(costs_.size(), kBlocked);
  std::vector<int> before(costs_.size(), -1);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  reached[static_cast<std::size_t>(start)] = 0;
  queue.push({0, start});
  while (!queue.empty() && queue.top().second != goal) {
    const auto [price, cell] = queue.top();
    queue.pop();
    if (price > reached[static_cast<std::size_t>(cell)]) continue;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = cell % costs_.width() + dx, y = cell / costs_.width() + dy;
        if (!costs_.contains(x, y)) continue;
        const int next = y * costs_.width() + x;
        const float step = std::sqrt(static_cast<float>(dx * dx + dy * dy));
        const float total = price + step * costs_.at(x, y);
        if (total >= reached[static_cast<std::size_t>(next)]) continue;
        reached[static_cast<std::size_t>(next)] = total;
        before[static_cast<std::size_t>(next)] = cell;
        queue.push({total, next});
      }
  }
  std::vector<Eigen::Vector2f> points = {to_m};
  for (int cell = before[static_cast<std::size_t>(goal)]; cell >= 0 && cell != start;
       cell = before[static_cast<std::size_t>(cell)])
    points.push_back(center_of(cell));
  points.push_back(from_m);
  std::reverse(points.begin(), points.end());
  return points;
}

std::vector<Eigen::Vector2f> even_loop(const WalkMap& map,
                                       const std::vector<Eigen::Vector2f>& corners,
                                       float spacing_m) {
  std::vector<Eigen::Vector2f> loop = closed_way(map, corners);
  for (const float spacing : {kSpacing_m, spacing_m}) {
    const float length = length_of(loop);
    if (length <= 0) return {};
    loop = resampled(loop, static_cast<int>(std::ceil(length / spacing)));
    if (spacing == kSpacing_m) smooth_loop(map, loop);
    loop.push_back(loop.front());
  }
  loop.pop_back();
  return loop;
}

std::vector<Eigen::Vector2f> walk_round(const SynthRoom& room, int laps, int count,
                                        const TrajectoryConfig& config) {
  const WalkMap map(room, config);
  std::vector<Eigen::Vector2f> corners;
  for (int lap = 0; lap < laps; ++lap)
    for (int i = 0; i < kCornersPerLap; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kCornersPerLap;
      corners.push_back(corner(room, map, angle, lap == 0 ? 1.f : kInnerLap));
    }
  const std::vector<Eigen::Vector2f> loop = closed_way(map, corners);
  std::vector<Eigen::Vector2f> even =
      resampled(loop, std::max(count, static_cast<int>(length_of(loop) / kSpacing_m)));
  smooth_loop(map, even);
  even.push_back(even.front());
  return resampled(even, count);
}

}  // namespace ovimap
