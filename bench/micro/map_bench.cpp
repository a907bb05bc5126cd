// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "ovimap/base/parallel.h"
#include "ovimap/instance/association.h"
#include "ovimap/instance/plain_association.h"
#include "ovimap/map/fusion/free_space.h"
#include "ovimap/map/fusion/integrate.h"
#include "ovimap/map/fusion/plain_free_space.h"
#include "ovimap/map/fusion/plain_fusion.h"
#include "ovimap/map/rays/plain_ray_cast.h"
#include "ovimap/map/rays/ray_cast.h"
#include "ovimap/map/rays/surface_lookup.h"
#include "ovimap/map/surface/incremental_mesh.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/map/surface/plain_mesh.h"
#include "room_scene.h"

namespace ovimap::bench {
namespace {

/// A mapped room and one more view of it.
struct MappedRoom {
  VoxelMap map;
  RoomScene scene{3};
  DepthSurface surface = fit_depth_surface(scene.depth, scene.camera, {});
  Segments segments = segments_of_regions(segment_depth(surface, scene.camera, {}));
  std::vector<Label> labels;

  MappedRoom() {
    for (std::size_t i = 0; i < segments.segments.size(); ++i)
      labels.push_back(map.labels().create());
    for (int view = 0; view < 6; ++view) add(RoomScene(view));
  }
  Observation observation(const RoomScene& view) const {
    return {.depth = view.depth,
            .camera = view.camera,
            .world_from_camera = view.pose,
            .plane_slope = &surface.plane_slope,
            .segment_ids = &segments.ids,
            .segment_labels = labels};
  }
  std::vector<std::uint32_t> add(const RoomScene& view) {
    return integrate(map, observation(view));
  }
};

/// What this machine's memory can do: a frame's blocks, read and written once.
void copy_memory(benchmark::State& state) {
  std::vector<std::uint64_t> from(std::size_t{8} << 20, 1), to(from.size());
  for (auto _ : state) {
    parallel_for_ranges(from.size(), std::size_t{1} << 18, [&](std::size_t begin, std::size_t end) {
      std::copy(from.begin() + static_cast<std::ptrdiff_t>(begin),
                from.begin() + static_cast<std::ptrdiff_t>(end),
                to.begin() + static_cast<std::ptrdiff_t>(begin));
    });
    benchmark::DoNotOptimize(to.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(2 * 8 * from.size()));
}
BENCHMARK(copy_memory)->Unit(benchmark::kMillisecond)->UseRealTime();

void integrate_frame(benchmark::State& state) {
  MappedRoom room;
  std::size_t blocks = 0;
  for (auto _ : state) blocks = room.add(room.scene).size();
  state.counters["blocks"] = static_cast<double>(blocks);
}
BENCHMARK(integrate_frame)->Unit(benchmark::kMillisecond)->UseRealTime();

void integrate_frame_plain(benchmark::State& state) {
  MappedRoom room;
  for (auto _ : state) plain::integrate(room.map, room.observation(room.scene));
}
BENCHMARK(integrate_frame_plain)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Nothing is gone: what every frame pays.
void clear_free_space(benchmark::State& state) {
  MappedRoom room;
  const Image<float> sigma(room.scene.camera.width, room.scene.camera.height, 0.002f);
  Observation seen = room.observation(room.scene);
  seen.sigma_m = &sigma;
  for (auto _ : state) benchmark::DoNotOptimize(ovimap::clear_free_space(room.map, seen, {}));
}
BENCHMARK(clear_free_space)->Unit(benchmark::kMillisecond)->UseRealTime();

void clear_free_space_plain(benchmark::State& state) {
  MappedRoom room;
  const Image<float> sigma(room.scene.camera.width, room.scene.camera.height, 0.002f);
  Observation seen = room.observation(room.scene);
  seen.sigma_m = &sigma;
  for (auto _ : state) plain::clear_free_space(room.map, seen, {});
}
BENCHMARK(clear_free_space_plain)->Unit(benchmark::kMillisecond)->UseRealTime();

void look_up_surface(benchmark::State& state) {
  const MappedRoom room;
  for (auto _ : state)
    benchmark::DoNotOptimize(
        surface_voxels(room.map, room.scene.depth, room.scene.camera, room.scene.pose));
}
BENCHMARK(look_up_surface)->Unit(benchmark::kMillisecond)->UseRealTime();

void count_votes(benchmark::State& state) {
  MappedRoom room;
  const auto surface =
      surface_voxels(room.map, room.scene.depth, room.scene.camera, room.scene.pose);
  for (auto _ : state) benchmark::DoNotOptimize(associate(room.segments, surface, room.map, {}));
}
BENCHMARK(count_votes)->Unit(benchmark::kMillisecond)->UseRealTime();

void count_votes_plain(benchmark::State& state) {
  const MappedRoom room;
  const auto surface =
      surface_voxels(room.map, room.scene.depth, room.scene.camera, room.scene.pose);
  for (auto _ : state)
    benchmark::DoNotOptimize(plain::argmax_labels(room.segments, surface, room.map, 20));
}
BENCHMARK(count_votes_plain)->Unit(benchmark::kMillisecond)->UseRealTime();

void cast_all_rays(benchmark::State& state) {
  const MappedRoom room;
  for (auto _ : state)
    benchmark::DoNotOptimize(cast_rays(room.map, room.scene.camera, room.scene.pose, 10.f));
}
BENCHMARK(cast_all_rays)->Unit(benchmark::kMillisecond)->UseRealTime();

void cast_all_rays_plain(benchmark::State& state) {
  const MappedRoom room;
  for (auto _ : state)
    benchmark::DoNotOptimize(plain::cast_rays(room.map, room.scene.camera, room.scene.pose, 10.f));
}
BENCHMARK(cast_all_rays_plain)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

void extract_whole_mesh(benchmark::State& state) {
  const MappedRoom room;
  for (auto _ : state) benchmark::DoNotOptimize(extract_mesh(room.map));
}
BENCHMARK(extract_whole_mesh)->Unit(benchmark::kMillisecond)->UseRealTime();

void extract_whole_mesh_plain(benchmark::State& state) {
  const MappedRoom room;
  for (auto _ : state) benchmark::DoNotOptimize(plain::mesh_triangles(room.map));
}
BENCHMARK(extract_whole_mesh_plain)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

void update_mesh(benchmark::State& state) {
  MappedRoom room;
  const std::vector<std::uint32_t> visited = room.add(room.scene);
  IncrementalMesh mesh;
  for (auto _ : state) benchmark::DoNotOptimize(mesh.update(room.map, visited));
}
BENCHMARK(update_mesh)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace ovimap::bench
