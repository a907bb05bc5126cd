// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "ovimap/segment/plain_segmentation.h"
#include "room_scene.h"

namespace ovimap::bench {
namespace {

void fit_surface(benchmark::State& state) {
  const RoomScene scene(0);
  for (auto _ : state) benchmark::DoNotOptimize(fit_depth_surface(scene.depth, scene.camera, {}));
}
BENCHMARK(fit_surface)->Unit(benchmark::kMillisecond)->UseRealTime();

void fit_surface_plain(benchmark::State& state) {
  const RoomScene scene(0);
  const DepthSurface surface = fit_depth_surface(scene.depth, scene.camera, {});
  for (auto _ : state)
    for (int y = 0; y < scene.depth.height(); ++y)
      for (int x = 0; x < scene.depth.width(); ++x)
        benchmark::DoNotOptimize(plain::fit_plane(scene.depth, surface, scene.camera, x, y));
}
BENCHMARK(fit_surface_plain)->Unit(benchmark::kMillisecond)->UseRealTime();

void segment(benchmark::State& state) {
  const RoomScene scene(0);
  const DepthSurface surface = fit_depth_surface(scene.depth, scene.camera, {});
  for (auto _ : state) benchmark::DoNotOptimize(segment_depth(surface, scene.camera, {}));
}
BENCHMARK(segment)->Unit(benchmark::kMillisecond)->UseRealTime();

void segment_plain(benchmark::State& state) {
  const RoomScene scene(0);
  const DepthSurface surface = fit_depth_surface(scene.depth, scene.camera, {});
  for (auto _ : state) benchmark::DoNotOptimize(plain::segment(surface, scene.camera, {}));
}
BENCHMARK(segment_plain)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace ovimap::bench
