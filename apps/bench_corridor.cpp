// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>

#include "bench.h"
#include "ovimap/synth/corridor.h"

namespace ovimap::apps {

namespace {

constexpr std::int64_t kPart = 500;  // frames of a row
constexpr float kVoxel_m = 0.04f;    // a corridor of 300 m at 1 cm would take 15 GB

/// Cost of the frames up to `frames`, and what the map is by then.
struct CorridorRow {
  std::int64_t frames;
  StageSummary frame, project, mesh;
  double map_mb, wall_m2;
  std::size_t objects;
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

std::vector<CorridorRow> walk(const CorridorSource& corridor, MapperConfig config) {
  config.map.voxel_size_m = kVoxel_m;
  Mapper mapper(config);
  IncrementalMesh mesh;
  std::vector<CorridorRow> rows;
  Progress progress("walking");
  StageTimers part;
  for (std::int64_t i = 0; i < corridor.size() && !interrupted(); ++i) {
    const Frame frame = *corridor.read(i).frame;
    {
      auto t = part.measure("frame");
      mapper.process(frame);
    }
    {
      auto t = part.measure("mesh");
      mesh.update(mapper.map(), mapper.touched_blocks());
    }
    {
      auto t = part.measure("project");
      (void)mapper.project(frame);
    }
    progress.show(static_cast<std::size_t>(i + 1), static_cast<std::size_t>(corridor.size()));
    if ((i + 1) % kPart != 0) continue;
    const auto summary = part.summary();
    rows.push_back({i + 1, summary.at("frame"), summary.at("project"), summary.at("mesh"),
                    static_cast<double>(mapper.map().bytes()) / 1e6, surface_m2(mapper.map()),
                    mapper.registry().records().size()});
    part = {};
  }
  return rows;
}

}  // namespace

int bench_corridor(int frames, const MapperConfig& config, bool json) {
  watch_for_interrupt();
  const CorridorSource corridor({.frames = frames});
  const std::vector<CorridorRow> rows = walk(corridor, config);
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
                       {"surface_m2", row.wall_m2},
                       {"objects", row.objects}});
    print_json({{"parts", parts},
                {"growth", growth},
                {"interrupted", interrupted()},
                {"peak_rss_mb", peak_rss_mb()}});
    return kDone;
  }
  std::printf("%8s %9s %9s %11s %9s %9s %10s %8s\n", "frames", "p50 ms", "p95 ms", "project ms",
              "mesh ms", "map MB", "surface m2", "objects");
  for (const CorridorRow& row : rows)
    std::printf("%8lld %9.2f %9.2f %11.2f %9.2f %9.1f %10.0f %8zu\n",
                static_cast<long long>(row.frames), row.frame.p50_ms, row.frame.p95_ms,
                row.project.p50_ms, row.mesh.p50_ms, row.map_mb, row.wall_m2, row.objects);
  std::printf("the last %lld frames cost %.2f times the first; peak memory %.0f MB\n",
              static_cast<long long>(kPart), growth, peak_rss_mb());
  return kDone;
}

}  // namespace ovimap::apps
