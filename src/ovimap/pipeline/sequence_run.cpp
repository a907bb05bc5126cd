// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence_run.h"

#include <chrono>
#include <future>

#include "ovimap/base/error.h"
#include "ovimap/base/version.h"

namespace ovimap {

namespace {

std::string commonest_fault(const std::vector<SkippedFrame>& skipped) {
  std::vector<std::string> faults;
  for (const SkippedFrame& frame : skipped) faults.push_back(frame.fault);
  return faults.empty() ? "no frame was chosen" : count_faults(faults).front().example;
}

}  // namespace

SequenceResult run_sequence(const FrameSource& source, const std::vector<std::int64_t>& positions,
                            Mapper& mapper, const SequenceProgress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const auto read = [&source](std::int64_t position) {
    return std::async(std::launch::async, [&source, position] { return source.read(position); });
  };
  SequenceResult result;
  std::future<FrameRead> next;
  if (!positions.empty()) next = read(positions[0]);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    FrameRead current = [&] {
      auto t = mapper.timers().measure("wait_for_frame");
      return next.get();
    }();
    if (i + 1 < positions.size()) next = read(positions[i + 1]);
    FrameReport report;
    if (current.frame) {
      report = mapper.process(*current.frame);
      const Frame& frame = *current.frame;
      if (result.frames.empty()) result.depth_camera = frame.depth_camera;
      result.frames.push_back(
          {frame.index, frame.timestamp_s, frame.name, frame.world_from_camera, report.labelled});
    } else {
      result.skipped.push_back({positions[i], current.fault});
    }
    if (progress && !progress(i + 1, positions.size(), current.frame ? &report : nullptr)) break;
  }
  if (next.valid()) next.wait();
  if (result.frames.empty())
    throw Error(concat("none of the ", result.skipped.size(), " frames is usable: ",
                       commonest_fault(result.skipped), "; `ovimap check` tells more"));
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

MapDocument make_document(Mapper&& mapper, const SequenceResult& sequence, std::string source,
                          std::string config_text) {
  MapDocument document;
  document.instances =
      summarize_instances(mapper.map(), mapper.registry(), mapper.config().summary);
  document.instance_config = mapper.config().instance;
  document.registry = mapper.registry().state();
  document.frames = sequence.frames;
  document.depth_camera = sequence.depth_camera;
  document.mask_frames = mapper.mask_frames();
  document.source = std::move(source);
  document.config_text = std::move(config_text);
  document.version = concat(version(), " (", commit(), ")");
  document.content_hash = mapper.map().content_hash();
  document.map = std::move(mapper).take_map();
  return document;
}

}  // namespace ovimap
