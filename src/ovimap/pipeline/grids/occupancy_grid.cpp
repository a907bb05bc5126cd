// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/grids/occupancy_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/map/rays/distance_transform.h"
#include "ovimap/map/surface/mesh_extraction.h"

namespace ovimap {

namespace {

constexpr int kMargin = 1;  // cells around the surface

/// Height of the lowest large surface that faces up; the lowest point where none does.
float floor_height(const Mesh& mesh, const Eigen::Matrix3f& grid_from_world,
                   const OccupancyConfig& config) {
  constexpr float kFacesUp = 0.9f;
  const float bin_m = 0.5f * config.cell_m;
  const Eigen::Vector3f up = grid_from_world.row(2);
  std::map<int, std::pair<std::size_t, double>> bins;  // count and sum of heights
  std::size_t largest = 0;
  float lowest = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const float height = up.dot(mesh.vertices[i]);
    lowest = std::min(lowest, height);
    if (up.dot(mesh.normals[i]) < kFacesUp) continue;
    auto& [count, sum] = bins[static_cast<int>(std::floor(height / bin_m))];
    largest = std::max(largest, ++count);
    sum += double{height};
  }
  for (const auto& [bin, content] : bins)
    if (static_cast<float>(content.first) >= config.floor_share * static_cast<float>(largest))
      return static_cast<float>(content.second / static_cast<double>(content.first));
  return lowest;
}

/// An empty grid around the mesh.
OccupancyGrid grid_around(const Mesh& mesh, const Eigen::Vector3f& up,
                          const OccupancyConfig& config) {
  constexpr double kMostCells = 1 << 28;
  OccupancyGrid grid;
  grid.grid_from_world = shortest_turn(up, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  grid.cell_m = config.cell_m;
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(grid.grid_from_world * vertex);
  const Eigen::Array3d low = (box.min().array().cast<double>() / double{config.cell_m}).floor(),
                       high = (box.max().array().cast<double>() / double{config.cell_m}).floor();
  const Eigen::Array3d size = high - low + (1 + 2 * kMargin);
  if (size.prod() > kMostCells)
    throw Error(concat("a grid of the whole map would have ", size.prod(),
                       " cells; choose larger ones, e.g. --cell ", 4 * config.cell_m));
  grid.size = size.cast<int>();
  grid.origin = ((low - kMargin) * double{config.cell_m}).cast<float>();
  grid.cells.assign(static_cast<std::size_t>(size.prod()), CellState::kUnknown);
  return grid;
}

void mark_surface(const Mesh& mesh, int min_points, OccupancyGrid& grid) {
  std::vector<std::uint8_t> points(grid.cells.size(), 0);
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3i cell = ((grid.grid_from_world * vertex - grid.origin) / grid.cell_m)
                                     .array()
                                     .floor()
                                     .cast<int>()
                                     .max(0)
                                     .min(grid.size.array() - 1)
                                     .matrix();
    std::uint8_t& count = points[grid.index(cell.x(), cell.y(), cell.z())];
    count = static_cast<std::uint8_t>(std::min(count + 1, 255));
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i] >= min_points) grid.cells[i] = CellState::kOccupied;
}

/// Cells in cubes of this side are seen by much the same views.
constexpr int kCubeSide = 8;

/// Marks what was seen to be free among the unknown cells from `low` on, at most a cube of them.
void mark_free_in_cube(const ObservedSpace& space, const Eigen::Vector3i& low,
                       OccupancyGrid& grid) {
  const Eigen::Vector3i end = (low.array() + kCubeSide).min(grid.size.array());
  const Eigen::Matrix3f world_from_grid = grid.grid_from_world.transpose();
  const Eigen::Vector3f middle = 0.5f * (low + end).cast<float>();
  const float radius_m = 0.5f * (end - low).cast<float>().norm() * grid.cell_m;
  std::optional<std::vector<std::uint32_t>> views;  // once a cell asks
  for (int z = low.z(); z < end.z(); ++z)
    for (int y = low.y(); y < end.y(); ++y)
      for (int x = low.x(); x < end.x(); ++x) {
        CellState& cell = grid.at(x, y, z);
        if (cell != CellState::kUnknown) continue;
        if (!views)
          views =
              space.views_into(world_from_grid * (grid.origin + middle * grid.cell_m), radius_m);
        if (views->empty()) return;
        const Eigen::Vector3f center =
            grid.origin +
            (Eigen::Vector3i(x, y, z).cast<float>().array() + 0.5f).matrix() * grid.cell_m;
        if (space.seen_through(world_from_grid * center, *views) > 0) cell = CellState::kFree;
      }
}

void mark_free(const ObservedSpace& space, OccupancyGrid& grid) {
  const Eigen::Vector3i cubes = (grid.size.array() + kCubeSide - 1) / kCubeSide;
  parallel_for(static_cast<std::size_t>(cubes.prod()), 4, [&](std::size_t i) {
    const auto cube = static_cast<int>(i);
    const Eigen::Vector3i at(cube % cubes.x(), cube / cubes.x() % cubes.y(),
                             cube / cubes.x() / cubes.y());
    mark_free_in_cube(space, at * kCubeSide, grid);
  });
}

std::uint8_t level_of(CellState state) {
  if (state == CellState::kUnknown) return kUnknownLevel;
  return state == CellState::kFree ? kFreeLevel : kOccupiedLevel;
}

float metres(float squared_cells, float cell_m) {
  return squared_cells >= kNoObstacle ? std::numeric_limits<float>::infinity()
                                      : std::sqrt(squared_cells) * cell_m;
}

GridSlice empty_slice(const OccupancyGrid& grid, float low_m, float high_m) {
  GridSlice slice;
  slice.occupancy = Image<std::uint8_t>(grid.size.x(), grid.size.y());
  slice.distance_m = Image<float>(grid.size.x(), grid.size.y());
  slice.origin = grid.origin.head<2>();
  slice.cell_m = grid.cell_m;
  slice.low_m = low_m;
  slice.high_m = high_m;
  return slice;
}

/// What columns of cells say together, for a row of them.
std::vector<CellState> row_states(const OccupancyGrid& grid, int y, int first, int last,
                                  float free_share) {
  const auto width = static_cast<std::size_t>(grid.size.x());
  std::vector<int> free_cells(width, 0), occupied(width, 0);
  for (int z = first; z <= last; ++z)  // layer by layer, as they lie in memory
    for (std::size_t x = 0; x < width; ++x) {
      const CellState state = grid.at(static_cast<int>(x), y, z);
      free_cells[x] += state == CellState::kFree;
      occupied[x] += state == CellState::kOccupied;
    }
  std::vector<CellState> states(width, CellState::kUnknown);
  for (std::size_t x = 0; x < width; ++x) {
    const bool enough = free_cells[x] > 0 && static_cast<float>(free_cells[x]) >=
                                                 free_share * static_cast<float>(last - first + 1);
    if (occupied[x] > 0)
      states[x] = CellState::kOccupied;
    else if (enough)
      states[x] = CellState::kFree;
  }
  return states;
}

}  // namespace

void list_fields(OccupancyConfig& config, ConfigFields& fields) {
  fields.add("cell_m", config.cell_m, 0.001f, 100.f, "edge of a cell, metres");
  fields.add("min_points", config.min_points, 1, 255, "surface points that make an obstacle");
  fields.add("free_share", config.free_share, 0.f, 1.f,
             "of a column's cells that must be seen to be free");
  fields.add("floor_share", config.floor_share, 0.f, 1.f,
             "of the largest level surface: the lowest such is the floor");
  fields.group("space", [&](ConfigFields& space) { list_fields(config.space, space); });
}

OccupancyGrid make_occupancy_grid(const MapDocument& document, const OccupancyConfig& config) {
  return make_occupancy_grid(document, extract_mesh(document.map), config);
}

OccupancyGrid make_occupancy_grid(const MapDocument& document, const Mesh& mesh,
                                  const OccupancyConfig& config) {
  if (config.cell_m < document.map.config().voxel_size_m)
    throw Error(concat("cells of ", config.cell_m, " m are smaller than the map's voxels of ",
                       document.map.config().voxel_size_m, " m; choose larger ones with --cell"));
  if (mesh.vertices.empty())
    throw Error("the map has no surface to make a grid of; it holds objects alone, or nothing");
  OccupancyGrid grid = grid_around(mesh, document.up, config);
  grid.floor_m = floor_height(mesh, grid.grid_from_world, config);
  mark_surface(mesh, config.min_points, grid);
  std::vector<Pose> poses;
  for (const FrameLogEntry& frame : document.frames) poses.push_back(frame.world_from_camera);
  ObservedSpaceConfig space = config.space;
  space.margin_m = std::max(space.margin_m, config.cell_m);
  mark_free(ObservedSpace(document.map, document.depth_camera, poses, space), grid);
  return grid;
}

int layer_at(const OccupancyGrid& grid, float height_m) {
  return static_cast<int>(std::floor((grid.floor_m + height_m - grid.origin.z()) / grid.cell_m));
}

Eigen::Vector2f middle_of_cell(const Eigen::Vector2f& origin, float cell_m, int height, int x,
                               int row) {
  return origin + cell_m * Eigen::Vector2f(static_cast<float>(x) + 0.5f,
                                           static_cast<float>(height - row) - 0.5f);
}

GridSlice band_of(const OccupancyGrid& grid, float low_m, float high_m,
                  const OccupancyConfig& config) {
  if (!(low_m <= high_m))
    throw Error(
        concat("a band from ", low_m, " to ", high_m, " m is empty; name the lower height first"));
  GridSlice slice = empty_slice(grid, low_m, high_m);
  const int first = std::clamp(layer_at(grid, low_m), 0, grid.size.z() - 1),
            last = std::clamp(layer_at(grid, high_m), first, grid.size.z() - 1);
  std::vector<std::uint8_t> obstacle(slice.occupancy.size());
  parallel_for(static_cast<std::size_t>(grid.size.y()), 16, [&](std::size_t row) {
    const auto y = static_cast<int>(row);
    const std::vector<CellState> states = row_states(grid, y, first, last, config.free_share);
    for (int x = 0; x < grid.size.x(); ++x) {
      const CellState state = states[static_cast<std::size_t>(x)];
      obstacle[static_cast<std::size_t>(x + grid.size.x() * y)] = state == CellState::kOccupied;
      slice.occupancy.at(x, grid.size.y() - 1 - y) = level_of(state);
    }
  });
  const auto squared = squared_distances(obstacle, {grid.size.x(), grid.size.y(), 1});
  for (int y = 0; y < grid.size.y(); ++y)
    for (int x = 0; x < grid.size.x(); ++x)
      slice.distance_m.at(x, grid.size.y() - 1 - y) =
          metres(squared[static_cast<std::size_t>(x + grid.size.x() * y)], grid.cell_m);
  return slice;
}

std::vector<GridSlice> layers_of(const OccupancyGrid& grid, const std::vector<float>& heights_m) {
  std::vector<std::uint8_t> obstacle(grid.cells.size());
  std::transform(grid.cells.begin(), grid.cells.end(), obstacle.begin(),
                 [](CellState state) { return state == CellState::kOccupied; });
  const std::vector<float> squared = squared_distances(obstacle, grid.size);
  const std::size_t layer_cells = grid.cells.size() / static_cast<std::size_t>(grid.size.z());
  std::vector<GridSlice> slices;
  for (const float height : heights_m) {
    const int z = layer_at(grid, height);
    if (z < 0 || z >= grid.size.z())
      throw Error(concat(
          "the map has nothing ", height, " m above its floor; it reaches from ",
          grid.origin.z() - grid.floor_m, " to ",
          grid.origin.z() - grid.floor_m + grid.cell_m * static_cast<float>(grid.size.z()), " m"));
    GridSlice slice = empty_slice(grid, height, height);
    for (int y = 0; y < grid.size.y(); ++y)
      for (int x = 0; x < grid.size.x(); ++x) {
        const std::size_t cell = static_cast<std::size_t>(z) * layer_cells +
                                 static_cast<std::size_t>(x + grid.size.x() * y);
        slice.occupancy.at(x, grid.size.y() - 1 - y) = level_of(grid.cells[cell]);
        slice.distance_m.at(x, grid.size.y() - 1 - y) = metres(squared[cell], grid.cell_m);
      }
    slices.push_back(std::move(slice));
  }
  return slices;
}

}  // namespace ovimap
