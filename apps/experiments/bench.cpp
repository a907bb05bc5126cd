// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <thread>

#include "bench.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/version.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/pipeline/search/map_search.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace ovimap::apps {

namespace {

struct BenchOptions {
  MappingOptions mapping;
  int project_every = 5;
  int corridor = 0;    ///< frames; 0: measure SOURCE
  bool again = false;  ///< walk it once more
  bool track = false;  ///< find the poses instead of taking the recording's
  bool json = false;
};

/// A recording with the poses that a run found; what it left out stays left out.
class LocatedFrames : public FrameSource {
 public:
  LocatedFrames(const FrameSource& source, const std::vector<FrameLogEntry>& frames)
      : source_(source) {
    for (const FrameLogEntry& frame : frames) poses_[frame.index] = frame.world_from_camera;
  }
  std::string kind() const override { return source_.kind(); }
  std::int64_t size() const override { return source_.size(); }
  FrameRead read(std::int64_t position) const override {
    const auto pose = poses_.find(position);
    if (pose == poses_.end()) return {std::nullopt, "was left out"};
    FrameRead read = source_.read(position);
    if (read.frame) read.frame->world_from_camera = pose->second;
    return read;
  }

 private:
  const FrameSource& source_;
  std::map<std::int64_t, Pose> poses_;
};

/// Keeps a mesh up to date beside a mapper of its own, for the first frames.
void measure_mesh(const FrameSource& source, const std::vector<std::int64_t>& range,
                  const MapperConfig& config, StageTimers& timers) {
  constexpr std::size_t kFrames = 100;
  Mapper mapper(config);
  IncrementalMesh mesh;
  for (std::size_t i = 0; i < std::min(range.size(), kFrames); ++i) {
    const FrameRead read = source.read(range[i]);
    if (!read.frame) continue;
    mapper.process(*read.frame);
    auto t = timers.measure("mesh_update");
    mesh.update(mapper.map(), mapper.touched_blocks());
  }
}

std::filesystem::path temporary_map() {
  return temporary_path(".ovimap");
}

/// Saves the map beside other temporary files, opens it for questions, goes on with it as a resumed
/// run would, and returns its size, removing it again.
std::uintmax_t saved_bytes(const MapDocument& document, const MapperConfig& config,
                           StageTimers& timers) {
  const auto path = temporary_map();
  const RemoveLater removal{path};
  {
    auto t = timers.measure("save");
    save_map(path, document);
  }
  {
    auto t = timers.measure("open_for_queries");
    (void)open_map_search(path);
  }
  {
    auto t = timers.measure("resume");
    Mapper(config).restore(load_map(path));
  }
  const std::uintmax_t bytes = std::filesystem::file_size(path);
  return bytes;
}

}  // namespace

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

RemoveLater::~RemoveLater() {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

std::filesystem::path temporary_path(const std::string& ending) {
  static std::atomic<int> made = 0;
  return std::filesystem::temp_directory_path() /
         ("ovimap-bench-" + std::to_string(getpid()) + "-" + std::to_string(++made) + ending);
}

std::unique_ptr<Checkpointer> bound_memory(const MemoryConfig& memory) {
  if (memory.max_mb == 0) return nullptr;
  auto tiles = std::make_shared<TileKeeper>(checkpoint_path(temporary_map()),
                                            TileKeeper::Start::kAnew, memory);
  tiles->remove();
  return std::make_unique<Checkpointer>(std::move(tiles), CheckpointConfig{0.f, 0}, MapHeader{}, 0);
}

namespace {

int bench(const BenchOptions& options) {
  const ThreadLimit limit(options.mapping.threads);
  ProgramConfig config = read_program_config(options.mapping);
#ifdef OVIMAP_SYNTH
  if (options.corridor > 0) {
    if (!options.mapping.source.empty())
      throw Error("name a SOURCE to measure or --corridor N, not both");
    return bench_corridor({options.corridor, options.again, options.track, options.json}, config,
                          options.mapping);
  }
  if (options.mapping.source.empty()) return bench_machine(config, options.mapping, options.json);
#endif
  if (options.mapping.source.empty())
    throw Error("name a SOURCE to measure: this program was built without rooms to render");
  config.masks.runtime.threads = network_threads(config, options.mapping);
  if (options.track) config.source.poses = PoseNeed::kNone;
  const auto source = open_frame_source(options.mapping.source, config.source);
  const auto range = positions(parse_frame_range(options.mapping.frames), source->size());
  auto masks = make_mask_source(options.mapping.masks, config.masks,
                                {source.get(), options.mapping.model_dirs});
  Mapper mapper(config.mapper, std::move(masks), make_encoder(options.mapping, config));
  const auto checkpoints = bound_memory(config.memory);
  PoseFinder finder(Tracker(config.track), config.loops);
  Progress progress("measuring");
  const double cpu_before = cpu_seconds();
  const SequenceResult result = run_sequence(
      *source, range, mapper,
      [&](std::size_t done, std::size_t total, const FrameReport*) {
        progress.show(done, total);
        return true;
      },
      {}, checkpoints.get(), options.track ? &finder : nullptr);
  const double cpu_ms =
      1e3 * (cpu_seconds() - cpu_before) / static_cast<double>(result.frames.size());
  const LocatedFrames located(*source, result.frames);
  for (std::size_t i = 0; i < range.size(); i += static_cast<std::size_t>(options.project_every)) {
    const FrameRead read = located.read(range[i]);
    if (read.frame) (void)mapper.project(*read.frame);
    mapper.map().trim();
  }
  mapper.finish();
  if (checkpoints) checkpoints->report(mapper.timers());
  const double peak_mb = peak_rss_mb();
  if (!checkpoints) {  // it holds all blocks at once
    auto t = mapper.timers().measure("mesh");
    (void)extract_mesh(mapper.map());
  }
  const auto voxels = static_cast<double>(mapper.map().blocks_in_memory()) * kBlockVoxels;
  const double map_bytes = static_cast<double>(mapper.map().bytes());
  StageTimers timers = mapper.timers();
  measure_mesh(located, range, config.mapper, timers);
  const MapDocument document = make_document(std::move(mapper), result, {options.mapping.source});
  const std::uintmax_t file_bytes = saved_bytes(document, config.mapper, timers);
  const double fps = static_cast<double>(result.frames.size()) / result.seconds;
  if (options.json) {
    print_json({{"machine", processor_name() + ", " +
                                std::to_string(std::thread::hardware_concurrency()) + " threads"},
                {"commit", commit()},
                {"source", options.mapping.source},
                {"masks", options.mapping.masks},
                {"frames", result.frames.size()},
                {"stages", stages_json(timers)},
                {"fps", fps},
                {"cpu_ms_per_frame", cpu_ms},
                {"peak_rss_mb", peak_mb},
                {"bytes_per_voxel", map_bytes / voxels},
                {"map_bytes", file_bytes},
                {"instances", document.instances.size()}});
    return kDone;
  }
  std::printf("%-16s %9s %9s %9s %7s\n", "stage", "p50 ms", "p95 ms", "p99 ms", "count");
  for (const auto& [stage, s] : timers.summary())
    std::printf("%-16s %9.2f %9.2f %9.2f %7zu\n", stage.c_str(), s.p50_ms, s.p95_ms, s.p99_ms,
                s.count);
  std::printf(
      "%.1f frames/s, %.1f ms of processor a frame, peak memory %.0f MB, %.1f bytes a voxel, "
      "map file %.1f MB\n",
      fps, cpu_ms, peak_mb, map_bytes / voxels, static_cast<double>(file_bytes) / 1e6);
  return kDone;
}

}  // namespace

Action add_bench(CLI::App& command) {
  auto options = std::make_shared<BenchOptions>();
  add_mapping_options(command, options->mapping);
  command
      .add_option("--project-every", options->project_every,
                  "measure the projection of every n-th frame")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command.get_option("SOURCE")->required(false);
  command.add_flag("--track", options->track, "find the poses as well, as run --poses track does");
  add_max_memory(command, options->mapping);
#ifdef OVIMAP_SYNTH
  auto* corridor = command
                       .add_option("--corridor", options->corridor,
                                   "walk N frames down a generated corridor instead, with 4 cm "
                                   "voxels: does mapping slow down?")
                       ->check(CLI::Range(10, 1000000));
  command
      .add_flag("--again", options->again, "... and once more, as another visit of the same map")
      ->needs(corridor)
      ->excludes("--track")
      ->excludes("--max-memory");
#endif
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return bench(*options); };
}

}  // namespace ovimap::apps
