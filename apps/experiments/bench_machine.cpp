// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "apps/rendering/synth_room.h"
#include "bench.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/version.h"
#include "ovimap/inference/models/model_folder.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace ovimap::apps {

namespace {

constexpr int kFrames = 90;
constexpr double kCamera_fps = 30;
constexpr std::size_t kMaskedFrames = 4, kPictures = 8;
constexpr double kAllBusy = 0.8;  // of all cores' time: threads wait a little at every step's end

/// How fast one way of mapping goes.
struct Pace {
  std::string what;
  float voxel_size_m;
  bool poses_found;
  double fps, cpu_ms, busy_cores;
};

/// What a network takes for one frame or picture.
struct NetworkTime {
  std::string model;
  double seconds;
};

struct MachineReport {
  std::size_t frames = 0;
  std::vector<Pace> paces;
  std::optional<NetworkTime> masks, words;
};

/// A walk through the one room whose furniture packages bring.
RoomOptions walk_of(std::int64_t frames) {
  RoomOptions room;
  room.width = 640, room.height = 480;
  room.frames_as.noise = true;
  room.video.emplace();
  room.video->walk.fps = static_cast<float>(kCamera_fps);
  room.video->walk.seconds = static_cast<float>(static_cast<double>(frames) / kCamera_fps);
  return room;
}

/// Thrown, so that what was rendered is removed.
void stop_if_asked() {
  if (interrupted()) throw Error("interrupted; nothing was measured");
}

void render(const std::filesystem::path& folder, std::int64_t frames) {
  Progress progress("rendering a room");
  write_room(folder, walk_of(frames), "room", [&](std::int64_t done, std::int64_t total) {
    stop_if_asked();
    progress.show(static_cast<std::size_t>(done), static_cast<std::size_t>(total));
  });
}

SequenceResult walk(const FrameSource& source, const std::vector<std::int64_t>& frames,
                    Mapper& mapper, const std::string& what, PoseFinder* finder = nullptr) {
  Progress progress(what);
  return run_sequence(
      source, frames, mapper,
      [&](std::size_t done, std::size_t total, const FrameReport*) {
        stop_if_asked();
        progress.show(done, total);
        return true;
      },
      {}, nullptr, finder);
}

Pace measure(const std::string& what, const FrameSource& source,
             const std::vector<std::int64_t>& frames, const MapperConfig& config,
             PoseFinder* finder = nullptr) {
  Mapper mapper(config);
  const double cpu_before = cpu_seconds();
  const SequenceResult result = walk(source, frames, mapper, what, finder);
  const double cpu_s = cpu_seconds() - cpu_before;
  const auto count = static_cast<double>(result.frames.size());
  return {what,
          config.map.voxel_size_m,
          finder != nullptr,
          count / result.seconds,
          1e3 * cpu_s / count,
          cpu_s / result.seconds};
}

std::vector<Pace> measure_paces(const std::string& recording, const FrameSource& given,
                                const std::vector<std::int64_t>& frames, ProgramConfig config) {
  std::vector<Pace> paces;
  for (const float voxel_m : {0.01f, 0.02f}) {
    config.mapper.map.voxel_size_m = voxel_m;
    paces.push_back(measure(concat("depth alone, ", std::lround(100 * voxel_m), " cm"), given,
                            frames, config.mapper));
  }
  config.source.poses = PoseNeed::kNone;
  config.mapper.map.voxel_size_m = paces.front().voxel_size_m;
  PoseFinder finder(Tracker(config.track), config.loops);
  paces.push_back(measure("the same at 1 cm, poses found",
                          *open_frame_source(recording, config.source), frames, config.mapper,
                          &finder));
  return paces;
}

/// The default masks where none are named; empty where those are not installed.
std::string masks_of(const MappingOptions& options) {
  if (options.masks != "none") return options.masks;
  const std::vector<ModelListing> models = list_models(model_search_path(options.model_dirs));
  const bool installed = std::any_of(models.begin(), models.end(), [](const ModelListing& model) {
    return model.name == kDefaultSamModel;
  });
  return installed ? kDefaultSamModel : "";
}

NetworkTime measure_masks(const FrameSource& source, const std::vector<std::int64_t>& frames,
                          ProgramConfig config, const MappingOptions& options) {
  config.masks.runtime.threads = network_threads(config, options);
  config.mapper.mask_interval = 1;
  Mapper mapper(config.mapper,
                make_mask_source(options.masks, config.masks, {&source, options.model_dirs}));
  std::vector<std::int64_t> some;
  const std::size_t count = std::min(kMaskedFrames, frames.size());
  for (std::size_t i = 0; i < count; ++i) some.push_back(frames[i * frames.size() / count]);
  walk(source, some, mapper, "masks of " + options.masks);
  return {options.masks, mapper.timers().summary().at("masks").p50_ms / 1e3};
}

std::optional<NetworkTime> measure_words(const FrameSource& source,
                                         const std::vector<std::int64_t>& frames,
                                         const ProgramConfig& config,
                                         const MappingOptions& options) {
  const auto encoder = make_encoder(options, config);
  const FrameRead read = source.read(frames.front());
  if (!encoder || !read.frame) return std::nullopt;
  const std::vector<RgbImage> pictures(kPictures, read.frame->color);
  (void)encoder->encode_images(pictures);  // the first time it takes its memory
  const auto before = std::chrono::steady_clock::now();
  (void)encoder->encode_images(pictures);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - before;
  return NetworkTime{encoder->identity().name, taken.count() / static_cast<double>(kPictures)};
}

bool all_busy(const Pace& pace) {
  return pace.busy_cores >= kAllBusy * static_cast<double>(allowed_threads());
}

std::string limit_of(const Pace& pace) {
  const std::size_t cores = allowed_threads();
  const long share = std::lround(100 * pace.busy_cores / static_cast<double>(cores));
  if (all_busy(pace))
    return concat("the cores: ", cores, " of them, ", share,
                  " % busy; more of them, or faster ones, make it faster");
  return concat("one core's speed: ", cores, " of them are ", share,
                " % busy, since what a frame needs is done step by step; faster ones make it "
                "faster, more of them do not");
}

std::string camera_of(const Pace& pace) {
  const int frames = static_cast<int>(std::ceil(kCamera_fps / pace.fps));
  return frames <= 1 ? std::string("all") : concat("1 of ", frames);
}

void print(const MachineReport& report) {
  std::printf("%s, %zu threads; ovimap %s (%s)\n", processor_name().c_str(), allowed_threads(),
              version(), commit());
  std::printf("A walk through a rendered room, %zu frames of 640x480, decoding included:\n\n",
              report.frames);
  std::printf("%-32s %9s %16s %11s   %s\n", "", "frames/s", "processor ms", "cores busy",
              "of 30 frames/s");
  for (const Pace& pace : report.paces)
    std::printf("%-32s %9.1f %16.1f %11.1f   %s\n", pace.what.c_str(), pace.fps, pace.cpu_ms,
                pace.busy_cores, camera_of(pace).c_str());
  std::printf("\n");
  if (report.masks)
    std::printf("masks     %s takes %.2f s for a frame, beside the camera\n",
                report.masks->model.c_str(), report.masks->seconds);
  else
    std::printf(
        "masks     no network is installed: run tools/setup.sh, or name one with --masks\n");
  if (report.words)
    std::printf("words     %s takes %.0f ms for a picture of an object\n",
                report.words->model.c_str(), 1e3 * report.words->seconds);
  std::printf("limit     %s\n", limit_of(report.paces.front()).c_str());
  std::printf("next      ovimap bench YOUR_RECORDING, stage by stage\n");
}

nlohmann::ordered_json json_of(const MachineReport& report) {
  nlohmann::ordered_json json = {{"machine", processor_name()},
                                 {"threads", allowed_threads()},
                                 {"commit", commit()},
                                 {"frames", report.frames},
                                 {"paces", nlohmann::ordered_json::array()},
                                 {"masks", nullptr},
                                 {"words", nullptr}};
  for (const Pace& pace : report.paces)
    json["paces"].push_back({{"what", pace.what},
                             {"voxel_size_m", pace.voxel_size_m},
                             {"poses", pace.poses_found ? "track" : "given"},
                             {"fps", pace.fps},
                             {"cpu_ms_per_frame", pace.cpu_ms},
                             {"cores_busy", pace.busy_cores}});
  if (report.masks)
    json["masks"] = {{"model", report.masks->model}, {"seconds", report.masks->seconds}};
  if (report.words)
    json["words"] = {{"model", report.words->model}, {"seconds", report.words->seconds}};
  json["limit"] = all_busy(report.paces.front()) ? "cores" : "core speed";
  return json;
}

}  // namespace

int bench_machine(const ProgramConfig& config, MappingOptions options, bool json) {
  watch_for_interrupt();
  const auto folder = temporary_path("");
  const RemoveLater removal{folder};
  const std::vector<std::int64_t> frames = positions(parse_frame_range(options.frames), kFrames);
  if (frames.empty())
    throw Error(concat("--frames ", options.frames, " takes none of the ", kFrames,
                       " frames that bench renders; leave it out"));
  render(folder, frames.back() + 1);
  MachineReport report;
  report.frames = frames.size();
  const std::string recording = (folder / "room").string();
  const auto source = open_frame_source(recording, config.source);
  report.paces = measure_paces(recording, *source, frames, config);
  options.masks = masks_of(options);
  if (!options.masks.empty()) {
    report.masks = measure_masks(*source, frames, config, options);
    report.words = measure_words(*source, frames, config, options);
  }
  if (json)
    print_json(json_of(report));
  else
    print(report);
  return kDone;
}

}  // namespace ovimap::apps
