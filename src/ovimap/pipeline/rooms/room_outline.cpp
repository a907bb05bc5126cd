// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/rooms/room_outline.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ovimap {

namespace {

using Corner = Eigen::Vector2i;  ///< of cells: x to the right, y up

struct CornerOrder {
  bool operator()(const Corner& a, const Corner& b) const {
    return a.y() != b.y() ? a.y() < b.y() : a.x() < b.x();
  }
};
/// Sides by where they begin; two where cells meet at a corner alone.
using Sides = std::map<Corner, std::vector<Corner>, CornerOrder>;

/// The sides of the room's cells that others do not share, with the room to their left.
Sides sides_of(const RoomPlan& plan, int room) {
  const int width = plan.floor.width(), height = plan.floor.height();
  const auto is_room = [&](int x, int y) {  // y up
    return x >= 0 && y >= 0 && x < width && y < height && plan.floor.at(x, height - 1 - y) == room;
  };
  Sides sides;
  const auto add = [&](int x0, int y0, int x1, int y1) {
    sides[Corner(x0, y0)].push_back(Corner(x1, y1));
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!is_room(x, y)) continue;
      if (!is_room(x, y - 1)) add(x, y, x + 1, y);
      if (!is_room(x + 1, y)) add(x + 1, y, x + 1, y + 1);
      if (!is_room(x, y + 1)) add(x + 1, y + 1, x, y + 1);
      if (!is_room(x - 1, y)) add(x, y + 1, x, y);
    }
  return sides;
}

/// Takes the side that turns left most, so that cells which meet at a corner stay apart.
Corner take_next(Sides& sides, const Corner& from, const Corner& direction) {
  std::vector<Corner>& ends = sides.at(from);
  const auto turn = [&](const Corner& to) {
    const Corner step = to - from;
    return direction.x() * step.y() - direction.y() * step.x();
  };
  const auto next =
      std::max_element(ends.begin(), ends.end(),
                       [&](const Corner& a, const Corner& b) { return turn(a) < turn(b); });
  const Corner to = *next;
  ends.erase(next);
  if (ends.empty()) sides.erase(from);
  return to;
}

/// Keeps corners between two of a line that lie further off it than that.
void keep_corners(const std::vector<Eigen::Vector2f>& line, std::size_t begin, std::size_t end,
                  float tolerance, std::vector<bool>& kept) {
  const Eigen::Vector2f &a = line[begin], &b = line[end];
  const float length = std::max((b - a).norm(), 1e-6f);
  std::size_t farthest = begin;
  float most = tolerance;
  for (std::size_t i = begin + 1; i < end; ++i) {
    const Eigen::Vector2f arm = line[i] - a, way = b - a;
    const float off =
        a == b ? arm.norm() : std::abs(way.x() * arm.y() - way.y() * arm.x()) / length;
    if (off > most) most = off, farthest = i;
  }
  if (farthest == begin) return;
  kept[farthest] = true;
  keep_corners(line, begin, farthest, tolerance, kept);
  keep_corners(line, farthest, end, tolerance, kept);
}

Polygon simplified(std::vector<Eigen::Vector2f> loop) {
  constexpr float kCell = 1.f;
  loop.push_back(loop.front());
  std::vector<bool> kept(loop.size(), false);
  kept.front() = true;
  keep_corners(loop, 0, loop.size() - 1, kCell, kept);
  Polygon polygon;
  for (std::size_t i = 0; i + 1 < loop.size(); ++i)
    if (kept[i]) polygon.push_back(loop[i]);
  return polygon;
}

/// Positive where it runs counter-clockwise.
float signed_area(const Polygon& polygon) {
  float twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2f &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

}  // namespace

std::vector<Polygon> room_outline(const RoomPlan& plan, int room) {
  Sides sides = sides_of(plan, room);
  std::vector<Polygon> outline;
  while (!sides.empty()) {
    const Corner start = sides.begin()->first;
    std::vector<Eigen::Vector2f> loop;
    Corner at = start, direction(1, 0);
    do {
      loop.push_back(at.cast<float>());
      const Corner next = take_next(sides, at, direction);
      direction = next - at;
      at = next;
    } while (at != start);
    Polygon polygon = simplified(std::move(loop));
    if (polygon.size() < 3) continue;  // thinner than a cell
    for (Eigen::Vector2f& corner : polygon) corner = plan.origin + corner * plan.cell_m;
    outline.push_back(std::move(polygon));
  }
  std::stable_sort(outline.begin(), outline.end(), [](const Polygon& a, const Polygon& b) {
    return signed_area(a) > signed_area(b);
  });
  return outline;
}

}  // namespace ovimap
