// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "ovimap/segment/depth_segmentation.h"
#include "room_scene.h"

namespace ovimap::bench {
namespace {

void fit_surface(benchmark::State& state) {
  const RoomScene scene(0);
  for (auto _ : state) benchmark::DoNotOptimize(fit_depth_surface(scene.depth, scene.camera, {}));
}
BENCHMARK(fit_surface)->Unit(benchmark::kMillisecond)->UseRealTime();

void segment(benchmark::State& state) {
  const RoomScene scene(0);
  const DepthSurface surface = fit_depth_surface(scene.depth, scene.camera, {});
  for (auto _ : state) benchmark::DoNotOptimize(segment_depth(surface, scene.camera, {}));
}
BENCHMARK(segment)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace ovimap::bench
