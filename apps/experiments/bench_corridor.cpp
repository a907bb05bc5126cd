// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>

#include "bench.h"
#include "ovimap/synth/recordings/corridor.h"

namespace ovimap::apps {

namespace {

constexpr std::int64_t kPart = 500;  // frames of a row
constexpr float kVoxel_m = 0.04f;    // a corridor of 300 m at 1 cm would take 15 GB

/// Cost of the frames up to `frames`, and what the map is by then.
struct CorridorRow {
  std::int64_t frames;
  StageSummary frame, project, mesh;
  double map_mb;   ///< in memory
  double wall_m2;  ///< 0 with a bound on memory, for which all of the map would have to come back
  std::size_t blocks, objects;
};

struct CorridorWalk {
  std::vector<CorridorRow> rows;
  StageTimers tiles;  ///< what leaving memory and coming back took
};

/// Square metres of observed surface, by its voxels.
double surface_m2(const VoxelMap& map) {
  std::size_t voxels = 0;
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot)
    for (std::size_t v = 0; v < kBlockVoxels; ++v) {
      const VoxelBlock& block = map.block(slot);
      const float distance_m = std::abs(map.distance_m(block, static_cast<int>(v)));
      voxels += block.weight[v] > 0.f && 2 * distance_m < map.config().voxel_size_m;
    }
  const double side = map.config().voxel_size_m;
  return static_cast<double>(voxels) * side * side;
}

/// With a bound on memory no mesh is kept, which has none.
CorridorWalk walk(const CorridorSource& corridor, ProgramConfig config) {
  config.mapper.map.voxel_size_m = kVoxel_m;
  Mapper mapper(config.mapper);
  const auto checkpoints = bound_memory(config.memory);
  IncrementalMesh mesh;
  CorridorWalk walked;
  Progress progress("walking");
  StageTimers part;
  for (std::int64_t i = 0; i < corridor.size() && !interrupted(); ++i) {
    const Frame frame = *corridor.read(i).frame;
    {
      auto t = part.measure("frame");
      mapper.process(frame);
      if (checkpoints) checkpoints->after_frame(mapper, {}, frame.depth_camera);
    }
    if (!checkpoints) {
      auto t = part.measure("mesh");
      mesh.update(mapper.map(), mapper.touched_blocks());
    }
    {
      auto t = part.measure("project");
      (void)mapper.project(frame);
    }
    progress.show(static_cast<std::size_t>(i + 1), static_cast<std::size_t>(corridor.size()));
    if ((i + 1) % kPart != 0) continue;
    auto summary = part.summary();
    walked.rows.push_back({i + 1, summary["frame"], summary["project"], summary["mesh"],
                           static_cast<double>(mapper.map().bytes()) / 1e6,
                           checkpoints ? 0. : surface_m2(mapper.map()), mapper.map().block_count(),
                           mapper.registry().instances().size()});
    part = {};
  }
  if (checkpoints) checkpoints->report(walked.tiles);
  return walked;
}

}  // namespace

int bench_corridor(int frames, const ProgramConfig& config, bool json) {
  watch_for_interrupt();
  const CorridorSource corridor({.frames = frames});
  const auto [rows, tiles] = walk(corridor, config);
  const double growth = rows.empty() ? 0 : rows.back().frame.p50_ms / rows.front().frame.p50_ms;
  if (json) {
    nlohmann::json parts = nlohmann::json::array();
    for (const CorridorRow& row : rows)
      parts.push_back({{"frames", row.frames},
                       {"frame_p50_ms", row.frame.p50_ms},
                       {"frame_p95_ms", row.frame.p95_ms},
                       {"project_p50_ms", row.project.p50_ms},
                       {"mesh_p50_ms", row.mesh.p50_ms},
                       {"map_mb", row.map_mb},
                       {"blocks", row.blocks},
                       {"surface_m2", row.wall_m2},
                       {"objects", row.objects}});
    print_json({{"parts", parts},
                {"stages", stages_json(tiles)},
                {"growth", growth},
                {"interrupted", interrupted()},
                {"peak_rss_mb", peak_rss_mb()}});
    return kDone;
  }
  std::printf("%8s %9s %9s %11s %9s %9s %9s %10s %8s\n", "frames", "p50 ms", "p95 ms", "project ms",
              "mesh ms", "map MB", "blocks", "surface m2", "objects");
  for (const CorridorRow& row : rows)
    std::printf("%8lld %9.2f %9.2f %11.2f %9.2f %9.1f %9zu %10.0f %8zu\n",
                static_cast<long long>(row.frames), row.frame.p50_ms, row.frame.p95_ms,
                row.project.p50_ms, row.mesh.p50_ms, row.map_mb, row.blocks, row.wall_m2,
                row.objects);
  for (const auto& [stage, s] : tiles.summary())
    std::printf("%s: %.2f ms, p95 %.2f ms, %zu times\n", stage.c_str(), s.p50_ms, s.p95_ms,
                s.count);
  std::printf("the last %lld frames cost %.2f times the first; peak memory %.0f MB\n",
              static_cast<long long>(kPart), growth, peak_rss_mb());
  return kDone;
}

}  // namespace ovimap::apps
