// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/rooms/room_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <queue>

#include <Eigen/Geometry>

#include "ovimap/base/config.h"
#include "ovimap/map/rays/distance_transform.h"
#include "ovimap/pipeline/grids/cell_parts.h"
#include "ovimap/pipeline/rooms/watershed.h"

namespace ovimap {

namespace {

constexpr float kUnderCeiling_m = 0.15f;  // what hangs there is no wall

using Cell = Eigen::Vector2i;
const std::array<Cell, 4> kNeighbors = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

/// Height above the floor of the layer above `from_m` that is occupied most: the ceiling, where
/// frames show it.
float ceiling_m(const OccupancyGrid& grid, float from_m) {
  const int first = std::clamp(layer_at(grid, from_m), 0, grid.size.z());
  const std::size_t layer =
      static_cast<std::size_t>(grid.size.x()) * static_cast<std::size_t>(grid.size.y());
  std::vector<std::size_t> counts;
  for (int z = first; z < grid.size.z(); ++z) {
    const auto begin =
        grid.cells.begin() + static_cast<std::ptrdiff_t>(layer * static_cast<std::size_t>(z));
    counts.push_back(static_cast<std::size_t>(
        std::count(begin, begin + static_cast<std::ptrdiff_t>(layer), CellState::kOccupied)));
  }
  const auto most = std::max_element(counts.begin(), counts.end());
  const int z = first + static_cast<int>(most - counts.begin());
  return grid.origin.z() + grid.cell_m * static_cast<float>(z) - grid.floor_m;
}

Image<std::uint8_t> free_between(const OccupancyGrid& grid, float low_m, float high_m,
                                 const RoomConfig& config) {
  OccupancyConfig occupancy;
  occupancy.free_share = config.free_share;
  Image<std::uint8_t> free = band_of(grid, low_m, high_m, occupancy).occupancy;
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = free[i] == kFreeLevel;
  return free;
}

/// Lamps, plants and what was not seen between free cells are no walls.
void fill_islands(Image<std::uint8_t>& free, float cell_m, const RoomConfig& config) {
  for (const std::vector<Cell>& part : connected_parts(free, 0, Corners::kApart))
    if (static_cast<float>(part.size()) * cell_m * cell_m < config.least_wall_m2)
      for (const Cell& cell : part) free.at(cell.x(), cell.y()) = 1;
}

/// Metres from each free cell to the nearest that is not.
Image<float> clearance(const Image<std::uint8_t>& free, float cell_m) {
  std::vector<std::uint8_t> obstacle(free.size());
  for (std::size_t i = 0; i < free.size(); ++i) obstacle[i] = !free[i];
  const auto squared = squared_distances(obstacle, {free.width(), free.height(), 1});
  Image<float> result(free.width(), free.height());
  for (std::size_t i = 0; i < free.size(); ++i)
    result[i] = squared[i] >= kNoObstacle ? 0.f : std::sqrt(squared[i]) * cell_m;
  return result;
}

/// The label of the nearest labelled cell, over cells that are `open` (breadth first).
Image<std::uint16_t> spread(Image<std::uint16_t> labels, const Image<std::uint8_t>& open) {
  std::queue<Cell> border;
  for (int y = 0; y < labels.height(); ++y)
    for (int x = 0; x < labels.width(); ++x)
      if (labels.at(x, y) != 0) border.push({x, y});
  for (; !border.empty(); border.pop())
    for (const Cell& step : kNeighbors) {
      const Cell next = border.front() + step;
      if (!labels.contains(next.x(), next.y()) || labels.at(next.x(), next.y()) != 0 ||
          !open.at(next.x(), next.y()))
        continue;
      labels.at(next.x(), next.y()) = labels.at(border.front().x(), border.front().y());
      border.push(next);
    }
  return labels;
}

/// The cells on both sides where two rooms meet, by the rooms.
std::map<std::pair<int, int>, std::vector<Cell>> meeting_cells(const Image<std::uint16_t>& rooms) {
  std::map<std::pair<int, int>, std::vector<Cell>> meetings;
  for (int y = 0; y < rooms.height(); ++y)
    for (int x = 0; x < rooms.width(); ++x)
      for (const Cell& step : {Cell(1, 0), Cell(0, 1)}) {
        const Cell next = Cell(x, y) + step;
        if (!rooms.contains(next.x(), next.y())) continue;
        const int a = rooms.at(x, y), b = rooms.at(next.x(), next.y());
        if (a == 0 || b == 0 || a == b) continue;
        auto& cells = meetings[std::minmax(a, b)];
        cells.insert(cells.end(), {Cell(x, y), next});
      }
  return meetings;
}

/// Cells that touch each other, of some that may be named twice.
std::vector<std::vector<Cell>> parts_of(const std::vector<Cell>& cells) {
  Eigen::AlignedBox2i box;
  for (const Cell& cell : cells) box.extend(cell);
  Image<std::uint8_t> mask(box.sizes().x() + 1, box.sizes().y() + 1);
  for (const Cell& cell : cells) mask.at(cell.x() - box.min().x(), cell.y() - box.min().y()) = 1;
  std::vector<std::vector<Cell>> parts = connected_parts(mask, 1, Corners::kApart);
  for (std::vector<Cell>& part : parts)
    for (Cell& cell : part) cell += box.min();
  return parts;
}

/// Where two rooms meet on cells that are open at eye height, a door for each place.
std::vector<RoomDoor> find_doors(const Image<std::uint16_t>& rooms, const Image<std::uint8_t>& eye,
                                 float cell_m, const RoomPlan& plan) {
  const Image<float> room_to_wall = clearance(eye, cell_m);
  std::vector<RoomDoor> doors;
  for (const auto& [pair, cells] : meeting_cells(spread(rooms, eye)))
    for (const std::vector<Cell>& part : parts_of(cells)) {
      const Cell widest =
          *std::max_element(part.begin(), part.end(), [&](const Cell& a, const Cell& b) {
            return room_to_wall.at(a.x(), a.y()) < room_to_wall.at(b.x(), b.y());
          });
      RoomDoor door{pair.first, pair.second, {}, 2 * room_to_wall.at(widest.x(), widest.y())};
      door.place_m = middle_of_cell(plan.origin, cell_m, rooms.height(), widest.x(), widest.y());
      doors.push_back(door);
    }
  return doors;
}

/// Regions by label, and how many sides of cells each shares with each other one.
struct RegionBorders {
  std::map<std::uint16_t, std::size_t> sizes;
  std::map<std::uint16_t, std::map<std::uint16_t, std::size_t>> lengths;

  explicit RegionBorders(const Image<std::uint16_t>& regions) {
    for (int y = 0; y < regions.height(); ++y)
      for (int x = 0; x < regions.width(); ++x) {
        const std::uint16_t region = regions.at(x, y);
        if (region == 0) continue;
        ++sizes[region];
        for (const Cell& step : kNeighbors)
          if (regions.contains(x + step.x(), y + step.y()))
            if (const std::uint16_t other = regions.at(x + step.x(), y + step.y());
                other != 0 && other != region)
              ++lengths[region][other];
      }
  }

  /// The one that shares the longest border with it; 0: none.
  std::uint16_t neighbor_of(std::uint16_t region) const {
    const auto borders = lengths.find(region);
    if (borders == lengths.end() || borders->second.empty()) return 0;
    return std::max_element(borders->second.begin(), borders->second.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }

  /// Makes `region` part of `heir`, or of none.
  void join(std::uint16_t region, std::uint16_t heir) {
    if (heir != 0) sizes[heir] += sizes[region];
    for (const auto& [other, length] : lengths[region]) {
      lengths[other].erase(region);
      if (heir == 0 || other == heir) continue;
      lengths[other][heir] += length;
      lengths[heir][other] += length;
    }
    sizes.erase(region);
    lengths.erase(region);
  }
};

/// Gives regions that are too small to the one that they share the longest border with, or to none.
void join_small(Image<std::uint16_t>& rooms, float cell_m, const RoomConfig& config) {
  const auto least = static_cast<std::size_t>(config.least_room_m2 / (cell_m * cell_m));
  RegionBorders borders(rooms);
  std::vector<std::uint16_t> heirs(std::numeric_limits<std::uint16_t>::max() + std::size_t{1});
  std::iota(heirs.begin(), heirs.end(), std::uint16_t{0});
  std::vector<std::uint16_t> joined;
  for (;;) {
    const auto small =
        std::min_element(borders.sizes.begin(), borders.sizes.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (small == borders.sizes.end() || small->second >= least) break;
    const std::uint16_t region = small->first;
    joined.push_back(region);
    heirs[region] = borders.neighbor_of(region);
    borders.join(region, heirs[region]);
  }
  // An heir may have been joined later: the last ones know where they ended.
  for (auto region = joined.rbegin(); region != joined.rend(); ++region)
    heirs[*region] = heirs[heirs[*region]];
  for (std::size_t i = 0; i < rooms.size(); ++i) rooms[i] = heirs[rooms[i]];
}

/// Numbers rooms by falling size and measures them.
void number_rooms(RoomPlan& plan, const Image<float>& room_to_wall) {
  std::map<std::uint16_t, std::pair<std::size_t, std::size_t>> found;  // size, widest cell
  for (std::size_t i = 0; i < plan.floor.size(); ++i) {
    if (plan.floor[i] == 0) continue;
    auto& [size, widest] = found.try_emplace(plan.floor[i], 0, i).first->second;
    ++size;
    if (room_to_wall[i] > room_to_wall[widest]) widest = i;
  }
  std::vector<std::pair<std::uint16_t, std::pair<std::size_t, std::size_t>>> ordered(found.begin(),
                                                                                     found.end());
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const auto& a, const auto& b) { return a.second.first > b.second.first; });
  std::map<std::uint16_t, std::uint16_t> numbers = {{0, 0}};
  const auto width = static_cast<std::size_t>(plan.floor.width());
  for (const auto& [label, facts] : ordered) {
    Room room;
    room.id = static_cast<int>(plan.rooms.size()) + 1;
    room.area_m2 = static_cast<float>(facts.first) * plan.cell_m * plan.cell_m;
    room.center_m = middle_of_cell(plan.origin, plan.cell_m, plan.floor.height(),
                                   static_cast<int>(facts.second % width),
                                   static_cast<int>(facts.second / width));
    numbers[label] = static_cast<std::uint16_t>(room.id);
    plan.rooms.push_back(room);
  }
  for (std::size_t i = 0; i < plan.floor.size(); ++i) plan.floor[i] = numbers[plan.floor[i]];
}

}  // namespace

void list_fields(RoomConfig& config, ConfigFields& fields) {
  fields.add("low_m", config.low_m, 0.1f, 10.f, "above the floor: lower furniture is no wall");
  fields.add("eye_m", config.eye_m, 0.2f, 10.f, "a doorway is open up to here at least");
  fields.add("door_m", config.door_m, 0.3f, 5.f,
             "widest doorway that parts rooms where no lintel was seen");
  fields.add("narrowing", config.narrowing, 0.1f, 1.f,
             "a doorway is less than this share of the width on both sides");
  fields.add("least_room_m2", config.least_room_m2, 0.f, 100.f, "smaller ones are no rooms");
  fields.add("least_wall_m2", config.least_wall_m2, 0.f, 100.f,
             "obstacles with less floor that touch no wall are no walls");
  fields.add("free_share", config.free_share, 0.f, 1.f,
             "of a column's cells that must be seen to be free");
}

int RoomPlan::room_at(const Eigen::Vector2f& place) const {
  const Eigen::Vector2f cell = (place - origin) / cell_m;
  const auto x = static_cast<int>(std::floor(cell.x())), y = static_cast<int>(std::floor(cell.y()));
  const int row = nearest.height() - 1 - y;
  return nearest.contains(x, row) ? nearest.at(x, row) : 0;
}

RoomPlan find_rooms(const OccupancyGrid& grid, const RoomConfig& config) {
  RoomPlan plan;
  plan.origin = grid.origin.head<2>();
  plan.cell_m = grid.cell_m;
  const float top = std::max(config.eye_m, ceiling_m(grid, config.eye_m) - kUnderCeiling_m);
  Image<std::uint8_t> inside = free_between(grid, config.low_m, top, config),
                      eye = free_between(grid, config.low_m, config.eye_m, config);
  fill_islands(inside, grid.cell_m, config);
  fill_islands(eye, grid.cell_m, config);
  const Image<float> room_to_wall = clearance(inside, grid.cell_m);
  plan.floor = watershed(room_to_wall, {0.5f * (config.door_m + grid.cell_m), config.narrowing});
  join_small(plan.floor, grid.cell_m, config);
  number_rooms(plan, room_to_wall);
  plan.doors = find_doors(plan.floor, eye, grid.cell_m, plan);
  plan.nearest =
      spread(plan.floor, Image<std::uint8_t>(plan.floor.width(), plan.floor.height(), 1));
  return plan;
}

}  // namespace ovimap
