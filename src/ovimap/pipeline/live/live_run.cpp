// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/live_run.h"

#include <algorithm>
#include <thread>

#include "ovimap/base/error.h"
#include "ovimap/pipeline/live/look_again.h"

namespace ovimap {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kReadAhead = 8;

struct NextFrame {
  std::int64_t position;
  FrameRead read;
};

/// Decodes frames on a thread of its own.
class ReadAhead {
 public:
  ReadAhead(const FrameSource& source, const std::vector<std::int64_t>& positions)
      : frames_(kReadAhead), reader_([this, &source, &positions] { read(source, positions); }) {}
  ~ReadAhead() {
    frames_.cancel();
    reader_.join();
  }

  /// Throws what reading threw.
  std::optional<NextFrame> next() {
    std::optional<NextFrame> frame = frames_.pop();
    if (!frame && failure_) std::rethrow_exception(failure_);
    return frame;
  }

 private:
  void read(const FrameSource& source, const std::vector<std::int64_t>& positions) {
    try {
      for (const std::int64_t position : positions)
        if (!frames_.push({position, source.read(position)})) return;
    } catch (...) {
      failure_ = std::current_exception();
    }
    frames_.close();
  }

  BoundedQueue<NextFrame> frames_;
  std::exception_ptr failure_;  ///< set before the queue is closed
  std::thread reader_;
};

/// Waits for the masks of frames that are all handed over; `progress` counts them with the frames.
void drain(LiveMapper& mapper, std::size_t frames, const LiveProgress& progress) {
  mapper.drain([&] {
    const auto waiting = static_cast<std::size_t>(mapper.statistics().masks_waiting);
    return !progress || progress(frames, frames + waiting);
  });
}

/// What a run must not pass over in silence.
void check_outcome(const LiveRunResult& result, const MapperConfig& config) {
  const std::vector<FrameLogEntry>& frames = result.sequence.frames;
  if (frames.empty())
    throw Error(concat("none of the frames is usable: ", commonest_fault(result.sequence.skipped),
                       "; `ovimap check` tells more"));
  require_motion(frames, config);
  if (result.statistics.masks_failed > 0 && result.statistics.mask_frames == 0)
    throw Error(result.statistics.mask_fault);
}

}  // namespace

LiveRunResult run_live(const FrameSource& source, const std::vector<std::int64_t>& positions,
                       LiveMapper& mapper, double fps, const LiveProgress& progress) {
  LiveRunResult result;
  ReadAhead reader(source, positions);
  std::optional<NextFrame> next = reader.next();  // the camera starts when a frame is there
  const auto start = Clock::now();
  const auto due = [&](std::size_t frame) {
    return start + std::chrono::duration_cast<Clock::duration>(
                       std::chrono::duration<double>(static_cast<double>(frame) / fps));
  };
  for (std::size_t i = 0; next; ++i) {
    std::this_thread::sleep_until(due(i));
    if (next->read.frame) {
      result.sequence.depth_camera = next->read.frame->depth_camera;
      mapper.push(std::move(*next->read.frame));
    } else {
      result.sequence.skipped.push_back({next->position, next->read.fault});
    }
    result.camera_seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (progress && !progress(i + 1, positions.size())) break;
    next = reader.next();
    result.frames_read_late += next && Clock::now() > due(i + 1);
  }
  drain(mapper, positions.size(), progress);
  result.sequence.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  result.sequence.frames = mapper.frames();
  result.statistics = mapper.statistics();
  check_outcome(result, mapper.config());
  return result;
}

void require_repeatable(const std::vector<LiveStep>& steps, bool tracked) {
  using Kind = LiveStep::Kind;
  const auto count = [&](Kind kind) {
    return std::count_if(steps.begin(), steps.end(),
                         [&](const LiveStep& step) { return step.kind == kind; });
  };
  const auto refuse = [](const char* why) {
    throw Error(concat("the map cannot be made again: ", why));
  };
  if (count(Kind::kFrame) == 0) refuse("it does not say how a live run made all of it");
  if (steps.front().kind == Kind::kResumed)
    refuse("the live run went on with a map of another run");
  if (count(Kind::kMoved) > 0) refuse("its poses were corrected from outside, which is not kept");
  if (tracked && count(Kind::kResumed) > 0)
    refuse("the live run was resumed, and the camera found its place anew");
}

LiveRunResult repeat_live(const FrameSource& source, const std::vector<LiveStep>& steps,
                          LiveMapper& mapper, const LiveProgress& progress) {
  LiveRunResult result;
  const auto start = Clock::now();
  mapper.repeat(steps);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (progress && !progress(i + 1, steps.size())) break;
    if (steps[i].kind != LiveStep::Kind::kFrame) continue;
    const std::int64_t position = steps[i].frame;
    if (position < 0 || position >= source.size())
      throw Error(concat("the live run took frame ", position, ", and the recording has ",
                         source.size(), "; name the recording that it was of"));
    FrameRead read = source.read(position);
    if (!read.frame) throw Error(concat("frame ", position, " of the live run: ", read.fault));
    result.sequence.depth_camera = read.frame->depth_camera;
    mapper.push_and_wait(std::move(*read.frame));
  }
  mapper.drain();
  result.sequence.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  result.sequence.frames = mapper.frames();
  result.statistics = mapper.statistics();
  check_outcome(result, mapper.config());
  return result;
}

LiveRunResult run_pushed(FrameIntake& intake, LiveMapper& mapper, const LiveProgress& progress,
                         const FrameFilter& filter) {
  LiveRunResult result;
  std::optional<Clock::time_point> start;  // the first frame's
  std::size_t handed_over = 0;
  for (std::size_t done = 0; !intake.ended();) {
    if (std::optional<PoseUpdate> update = intake.next_update())
      mapper.move_and_wait(std::move(*update));
    if (std::optional<Frame> frame = intake.next(kLook)) {
      if (!start) start = Clock::now();
      result.sequence.depth_camera = frame->depth_camera;
      const std::int64_t number = frame->index;
      FrameRead read = filter ? filter(std::move(*frame)) : FrameRead{std::move(frame), ""};
      if (read.frame)
        mapper.push_and_wait(std::move(*read.frame));
      else
        result.sequence.skipped.push_back({number, read.fault});
      result.camera_seconds = std::chrono::duration<double>(Clock::now() - *start).count();
      ++done;
    }
    if (progress && !progress(done, done)) intake.finish();
    handed_over = done;
  }
  drain(mapper, handed_over, progress);
  if (start) result.sequence.seconds = std::chrono::duration<double>(Clock::now() - *start).count();
  result.sequence.frames = mapper.frames();
  result.statistics = mapper.statistics();
  result.statistics.frames_dropped += intake.counts().skipped;
  if (result.sequence.frames.empty() && result.sequence.skipped.empty())
    throw Error("no frame came, so there is no map; docs/live.md says how to send frames");
  check_outcome(result, mapper.config());
  return result;
}

}  // namespace ovimap
