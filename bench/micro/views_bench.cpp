// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <benchmark/benchmark.h>

#include "ovimap/semantics/views/view_selection.h"
#include "room_scene.h"

namespace ovimap::bench {
namespace {

/// The room's image cut into a grid of that many objects, all known to the registry.
Image<InstanceId> grid_of_objects(int width, int height, int objects) {
  const int columns = static_cast<int>(std::ceil(std::sqrt(objects * 4. / 3)));
  const int rows = (objects + columns - 1) / columns;
  Image<InstanceId> ids(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int id = y * rows / height * columns + x * columns / width + 1;
      ids.at(x, y) = id <= objects ? static_cast<InstanceId>(id) : 0;
    }
  return ids;
}

InstanceRegistry registry_of(int objects) {
  InstanceRegistry::State state;
  for (InstanceId id = 1; id <= static_cast<InstanceId>(objects); ++id)
    state.super_points[id] = {100, {{id, 100}}, FrameRuns({{0, 100}})};  // labels are ids here
  state.last_id = static_cast<InstanceId>(objects);
  InstanceRegistry registry;
  registry.restore(std::move(state));
  return registry;
}

/// Directions to the points of one surface, 10,000 of them.
struct SurfaceDirections {
  std::vector<float> x, y, z;

  SurfaceDirections() {
    const RoomScene scene(3);
    for (std::size_t i = 0; i < scene.depth.size() && x.size() < 10000; i += 30) {
      const Eigen::Vector3f point = scene.camera.unproject(
          static_cast<float>(static_cast<int>(i) % scene.depth.width()),
          static_cast<float>(static_cast<int>(i) / scene.depth.width()), scene.depth[i]);
      x.push_back(point.x()), y.push_back(point.y()), z.push_back(point.z() - 2.f);
    }
  }
};

void mark_view_directions(benchmark::State& state) {
  const SurfaceDirections directions;
  const SphereGrid grid;
  BinSet bins(grid.bins());
  for (auto _ : state) {
    mark_directions(grid, {directions.x, directions.y, directions.z}, bins);
    benchmark::DoNotOptimize(bins);
  }
}
BENCHMARK(mark_view_directions)->Unit(benchmark::kMicrosecond);

void mark_view_directions_plain(benchmark::State& state) {
  const SurfaceDirections directions;
  const SphereGrid grid;
  BinSet bins(grid.bins());
  for (auto _ : state) {
    for (std::size_t i = 0; i < directions.x.size(); ++i)
      bins.set(bin_of(grid, {directions.x[i], directions.y[i], directions.z[i]}));
    benchmark::DoNotOptimize(bins);
  }
}
BENCHMARK(mark_view_directions_plain)->Unit(benchmark::kMicrosecond);

/// One 640x480 frame in which every pixel shows one of state.range(0) objects.
void select_views(benchmark::State& state) {
  const RoomScene scene(3);
  const int objects = static_cast<int>(state.range(0));
  const Image<InstanceId> ids = grid_of_objects(scene.depth.width(), scene.depth.height(), objects);
  const InstanceRegistry registry = registry_of(objects);
  ViewSelector selector(view_preset(state.range(1) != 0 ? "paper" : "default"));
  const Image<std::int32_t> color(ids.width(), ids.height());  // all of it is seen
  SuperPointLooks looks;
  std::int64_t frame = 0;
  for (auto _ : state) {
    std::vector<ChosenView> chosen = selector.select(
        {scene.depth, ids, ids, scene.depth, color, scene.camera, scene.pose, frame++}, registry,
        looks);
    for (ChosenView& view : chosen) ViewSelector::commit(std::move(view), {}, looks);
  }
}
BENCHMARK(select_views)
    ->ArgNames({"objects", "paper"})
    ->Args({10, 0})
    ->Args({100, 0})
    ->Args({100, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace ovimap::bench
