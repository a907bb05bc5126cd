// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/sequence_run.h"

#include <algorithm>
#include <chrono>
#include <future>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"
#include "ovimap/pipeline/sequence/map_description.h"
#include "ovimap/pipeline/sequence/timings_text.h"

namespace ovimap {

namespace {

constexpr std::size_t kFramesUntilMotion = 30;  // tell early, not after an hour

/// A frame that was read and prepared while another was mapped.
struct FrameAhead {
  std::string fault;             ///< why it could not be read
  std::shared_ptr<Frame> frame;  ///< its pose may be found later, preparing does not ask for it
  std::future<PreparedFrame> prepared;  ///< is there, or throws what preparing threw
  StageTimers timers;
};

FrameAhead read_ahead(const FrameSource& source, std::int64_t position,
                      const MapperConfig& config) {
  FrameRead read = source.read(position);
  FrameAhead ahead;
  ahead.fault = std::move(read.fault);
  if (!read.frame) return ahead;
  ahead.frame = std::make_shared<Frame>(std::move(*read.frame));
  std::packaged_task<PreparedFrame()> prepare(
      [&] { return prepare_frame(ahead.frame, config, ahead.timers); });
  ahead.prepared = prepare.get_future();
  prepare();
  return ahead;
}

/// Returns what kept the frame out of the map, empty when nothing did. What is wrong with the very
/// first frame is wrong with all of them as a rule, and better told at once.
std::string fuse(std::future<PreparedFrame> prepared, Mapper& mapper, bool others_went_well,
                 FrameReport& report) {
  try {
    report = mapper.process(prepared.get());
    return {};
  } catch (const FrameError& fault) {
    if (!others_went_well) throw;
    return fault.what();
  }
}

}  // namespace

std::string commonest_fault(const std::vector<SkippedFrame>& skipped) {
  std::vector<std::string> faults;
  for (const SkippedFrame& frame : skipped) faults.push_back(frame.fault);
  return faults.empty() ? "the chosen range (--frames) holds none"
                        : count_faults(faults).front().example;
}

void require_motion(const std::vector<FrameLogEntry>& frames, const MapperConfig& config) {
  if (config.allow_still_camera || frames.size() < 2) return;
  const bool still = std::all_of(frames.begin(), frames.end(), [&](const FrameLogEntry& frame) {
    return frame.world_from_camera.matrix() == frames.front().world_from_camera.matrix();
  });
  if (still)
    throw Error(concat("all ", frames.size(),
                       " frames have the same pose; give the camera's real poses, or, if it stood "
                       "still, --set allow_still_camera=true"));
}

std::vector<Pose> poses_of(const std::vector<FrameLogEntry>& frames) {
  std::vector<Pose> poses;
  for (const FrameLogEntry& frame : frames) poses.push_back(frame.world_from_camera);
  return poses;
}

SequenceResult run_sequence(const FrameSource& source, const std::vector<std::int64_t>& positions,
                            Mapper& mapper, const SequenceProgress& progress, SequenceResult begun,
                            Checkpointer* checkpoints, PoseFinder* finder) {
  if (positions.empty() && begun.frames.empty())
    throw Error(concat("no frame is asked for: --frames must leave some of the recording's ",
                       source.size(), ", which are counted from 0"));
  const auto start = std::chrono::steady_clock::now();
  // On one thread a frame is read when its turn comes.
  const auto when = allowed_threads() > 1 ? std::launch::async : std::launch::deferred;
  const auto read = [&source, &config = mapper.config(), when](std::int64_t position) {
    return std::async(when, read_ahead, std::cref(source), position, std::cref(config));
  };
  SequenceResult result = std::move(begun);
  std::future<FrameAhead> next;
  if (!positions.empty()) next = read(positions[0]);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    FrameAhead current = [&] {
      auto t = mapper.timers().measure("wait_for_frame");
      return next.get();
    }();
    if (i + 1 < positions.size()) next = read(positions[i + 1]);
    mapper.timers().merge(current.timers);
    FrameReport report;
    if (current.frame && finder && !finder->locate(*current.frame, mapper).tracked)
      current.fault = concat(current.frame->name, ": the camera is lost");
    if (current.frame && current.fault.empty())
      current.fault = fuse(std::move(current.prepared), mapper, !result.frames.empty(), report);
    if (current.fault.empty()) {
      const Frame& frame = *current.frame;
      if (result.frames.empty() || is_other_camera(result.depth_camera, frame.depth_camera))
        result.depth_camera = frame.depth_camera;  // a visit may have one of its own
      result.frames.push_back({mapper.number_of(frame), frame.timestamp_s, frame.name,
                               frame.world_from_camera, report.labelled});
      if (finder) finder->close_loops(mapper, result.frames, result.depth_camera);
      if (checkpoints) checkpoints->after_frame(mapper, result.frames, result.depth_camera);
      if (checkpoints) checkpoints->require_room(mapper);
    } else {
      result.skipped.push_back({positions[i], current.fault});
    }
    if (result.frames.size() == kFramesUntilMotion) require_motion(result.frames, mapper.config());
    const bool fused = current.fault.empty();
    if (progress && !progress(i + 1, positions.size(), fused ? &report : nullptr)) break;
  }
  next = {};  // waits for a frame that is being read
  if (result.frames.empty())
    throw Error(concat("none of the ", result.skipped.size(), " frames is usable: ",
                       commonest_fault(result.skipped), "; `ovimap check` tells more"));
  require_motion(result.frames, mapper.config());
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

MapDocument make_document(Mapper&& mapper, const SequenceResult& sequence, MapHeader header) {
  SuperPointLooks looks = mapper.take_looks();
  MapDocument document{mapper.record(std::move(header), sequence.frames, sequence.depth_camera),
                       VoxelMap()};
  document.semantics.looks = std::move(looks);
  describe_map(mapper.map(), mapper.registry(), mapper.config().summary, document);
  document.timings = timings_text(mapper.timers().summary());
  document.content_hash = mapper.map().content_hash();
  document.map = std::move(mapper).take_map();
  return document;
}

}  // namespace ovimap
