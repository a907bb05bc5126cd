// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <map>
#include <utility>

#include "bench.h"
#include "ovimap/pipeline/revise/visit_history.h"
#include "ovimap/pipeline/sequence/sequence_run.h"
#include "ovimap/synth/recordings/corridor.h"

namespace ovimap::apps {

namespace {

constexpr std::int64_t kParts = 10;
constexpr float kVoxel_m = 0.04f;  // a corridor of 300 m at 1 cm would take 15 GB

/// Cost of a tenth of the frames, and what the map is at their end.
struct CorridorRow {
  std::int64_t frames;                         ///< up to here
  std::map<std::string, StageSummary> stages;  ///< "frame": all that mapping does
  double cpu_ms;                               ///< of processor time a frame
  double blocks_touched;                       ///< a frame
  double map_mb;                               ///< in memory
  double wall_m2;  ///< 0 with a bound on memory, for which all of the map would have to come back
  std::size_t blocks, objects;
  std::int64_t lost;  ///< frames whose pose was not found, which look for their place in the map
};

using CorridorRows = std::vector<CorridorRow>;

/// The same frames in turn, so that the speed of a busy machine, which drifts, is that of both.
struct BesideNewcomer {
  CorridorRow old;    ///< of the map of the whole walk
  CorridorRow young;  ///< of a map that begins with these frames
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

/// Walks down the corridor and measures its tenths.
class CorridorWalker {
 public:
  /// `track`: poses are found.
  CorridorWalker(const CorridorSource& corridor, const ProgramConfig& config,
                 std::shared_ptr<MaskSource> masks, bool track)
      : corridor_(corridor),
        config_(config),
        masks_(std::move(masks)),
        mapper_(config.mapper, masks_),
        checkpoints_(bound_memory(config.memory)) {
    if (track) finder_.emplace(Tracker(config.track), config.loops);
  }

  CorridorRows walk() {
    Progress progress("walking");
    const std::int64_t part = part_frames();
    CorridorRows rows;
    for (std::int64_t i = 0; i < part * kParts && !interrupted(); ++i) {
      step(*corridor_.read(i).frame);
      progress.show(static_cast<std::size_t>(i + 1), static_cast<std::size_t>(part * kParts));
      if ((i + 1) % part == 0) rows.push_back(end_part(i + 1, part));
    }
    return rows;
  }

  /// After the walk: the frames that follow it, as many as a tenth.
  BesideNewcomer walk_beside(CorridorWalker& newcomer) {
    const std::int64_t begin = part_frames() * kParts;
    std::int64_t i = begin;
    for (; i < begin + part_frames() && !interrupted(); ++i) {
      const Frame frame = *corridor_.read(i).frame;
      // Who comes second finds more in the caches.
      CorridorWalker& first = i % 2 == 0 ? *this : newcomer;
      first.step(frame);
      (&first == this ? newcomer : *this).step(frame);
    }
    return {end_part(i, i - begin), newcomer.end_part(i, i - begin)};
  }

  /// The next walk goes on with the map as another visit, as `run --continue` does.
  void begin_visit() {
    MapHeader header{"corridor", ""};
    MapDocument document =
        make_document(std::move(mapper_), {frames_, {}, corridor_.camera()}, header);
    ovimap::begin_visit(document, config_.visit.past, header);
    mapper_ = Mapper(config_.mapper, masks_);
    mapper_.restore(std::move(document));
    mapper_.number_from(header.history.visits.back().first_index);
  }

  /// What leaving memory and coming back took.
  StageTimers tiles() const {
    StageTimers tiles;
    if (checkpoints_) checkpoints_->report(tiles);
    return tiles;
  }

 private:
  void map(Frame& frame) {
    if (finder_ && !finder_->locate(frame, mapper_).tracked) {
      ++lost_;
      return;
    }
    const FrameReport report = mapper_.process(frame);
    frames_.push_back({mapper_.number_of(frame), frame.timestamp_s, frame.name,
                       frame.world_from_camera, report.labelled});
    if (finder_) finder_->close_loops(mapper_, frames_, frame.depth_camera);
    if (checkpoints_) checkpoints_->after_frame(mapper_, frames_, frame.depth_camera);
  }

  /// With a bound on memory no mesh is kept, which has none.
  void step(Frame frame) {
    StageTimers& timers = mapper_.timers();
    const double cpu_before = cpu_seconds();
    {
      auto t = timers.measure("frame");
      map(frame);
    }
    cpu_ms_ += 1e3 * (cpu_seconds() - cpu_before);
    touched_ += static_cast<double>(mapper_.touched_blocks().size());
    if (!checkpoints_) {
      auto t = timers.measure("mesh_update");
      mesh_.update(mapper_.map(), mapper_.touched_blocks());
    }
    auto t = timers.measure("projection");
    (void)mapper_.project(frame);
  }

  std::int64_t part_frames() const { return corridor_.size() / (kParts + 1); }

  CorridorRow end_part(std::int64_t frames, std::int64_t part) {
    const auto count = static_cast<double>(part);
    const VoxelMap& map = mapper_.map();
    return {frames,
            std::exchange(mapper_.timers(), {}).summary(),
            std::exchange(cpu_ms_, 0) / count,
            std::exchange(touched_, 0) / count,
            static_cast<double>(map.bytes()) / 1e6,
            checkpoints_ ? 0. : surface_m2(map),
            map.block_count(),
            mapper_.registry().instances().size(),
            std::exchange(lost_, 0)};
  }

  const CorridorSource& corridor_;
  const ProgramConfig& config_;
  std::shared_ptr<MaskSource> masks_;
  Mapper mapper_;
  std::unique_ptr<Checkpointer> checkpoints_;
  std::optional<PoseFinder> finder_;
  std::vector<FrameLogEntry> frames_;
  IncrementalMesh mesh_;
  double cpu_ms_ = 0, touched_ = 0;
  std::int64_t lost_ = 0;
};

nlohmann::json row_json(const CorridorRow& row) {
  nlohmann::json stages;
  for (const auto& [stage, s] : row.stages)
    stages[stage] = {{"p50_ms", s.p50_ms}, {"p95_ms", s.p95_ms}, {"total_ms", s.total_ms}};
  return {{"frames", row.frames},      {"stages", stages},
          {"cpu_ms", row.cpu_ms},      {"blocks_touched", row.blocks_touched},
          {"map_mb", row.map_mb},      {"blocks", row.blocks},
          {"surface_m2", row.wall_m2}, {"objects", row.objects},
          {"frames_lost", row.lost}};
}

nlohmann::json rows_json(const CorridorRows& rows) {
  nlohmann::json parts = nlohmann::json::array();
  for (const CorridorRow& row : rows) parts.push_back(row_json(row));
  return {{"parts", parts}};
}

double growth_of(const BesideNewcomer& beside) {
  return beside.old.cpu_ms / beside.young.cpu_ms;
}

void print_rows(const CorridorRows& rows) {
  if (rows.empty()) return;
  std::printf("%8s %9s %9s %9s %11s %9s %9s %9s %10s %8s %6s\n", "frames", "p50 ms", "p95 ms",
              "cpu ms", "project ms", "touched", "map MB", "blocks", "surface m2", "objects",
              "lost");
  for (const CorridorRow& row : rows)
    std::printf("%8lld %9.2f %9.2f %9.2f %11.2f %9.0f %9.1f %9zu %10.0f %8zu %6lld\n",
                static_cast<long long>(row.frames), row.stages.at("frame").p50_ms,
                row.stages.at("frame").p95_ms, row.cpu_ms, row.stages.at("projection").p50_ms,
                row.blocks_touched, row.map_mb, row.blocks, row.wall_m2, row.objects,
                static_cast<long long>(row.lost));
}

void print_beside(const BesideNewcomer& beside) {
  std::printf("\n%-16s %16s %15s %6s\n", "the frames after", "begun there, ms", "whole map, ms",
              "ratio");
  for (const auto& [stage, young] : beside.young.stages) {
    const auto old = beside.old.stages.find(stage);
    if (old != beside.old.stages.end())
      std::printf("%-16s %16.0f %15.0f %6.2f\n", stage.c_str(), young.total_ms,
                  old->second.total_ms, old->second.total_ms / young.total_ms);
  }
  std::printf("a frame takes %.2f times the processor time of one in a map begun there\n",
              growth_of(beside));
}

}  // namespace

int bench_corridor(const CorridorBench& wanted, ProgramConfig config,
                   const MappingOptions& options) {
  watch_for_interrupt();
  config.mapper.map.voxel_size_m = kVoxel_m;
  const int part = wanted.frames / static_cast<int>(kParts);
  const CorridorSource corridor({.frames = part * static_cast<int>(kParts + 1), .hung = true});
  const std::shared_ptr<MaskSource> masks =
      make_mask_source(options.masks, config.masks, {&corridor, options.model_dirs});
  CorridorWalker walker(corridor, config, masks, wanted.track);
  const CorridorRows rows = walker.walk();
  CorridorRows again;
  if (wanted.again && !interrupted()) {
    walker.begin_visit();
    again = walker.walk();
  }
  const StageTimers tiles = walker.tiles();
  const double peak_mb = peak_rss_mb();  // before another map stands beside
  std::optional<BesideNewcomer> beside;
  if (!wanted.again && !interrupted()) {
    CorridorWalker newcomer(corridor, config, masks, wanted.track);
    beside = walker.walk_beside(newcomer);
  }
  if (wanted.json) {
    nlohmann::json walk = rows_json(rows);
    walk.update(
        {{"stages", stages_json(tiles)}, {"interrupted", interrupted()}, {"peak_rss_mb", peak_mb}});
    if (wanted.again) walk["again"] = rows_json(again);
    if (beside)
      walk.update({{"old", row_json(beside->old)},
                   {"young", row_json(beside->young)},
                   {"growth", growth_of(*beside)}});
    print_json(walk);
    return kDone;
  }
  print_rows(rows);
  if (beside) print_beside(*beside);
  if (!again.empty()) std::printf("\nagain, as another visit:\n");
  print_rows(again);
  for (const auto& [stage, s] : tiles.summary())
    std::printf("%s: %.2f ms, p95 %.2f ms, %zu times\n", stage.c_str(), s.p50_ms, s.p95_ms,
                s.count);
  std::printf("peak memory %.0f MB\n", peak_mb);
  return kDone;
}

}  // namespace ovimap::apps
