// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live_run.h"

#include <thread>

#include "ovimap/base/error.h"

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
      : frames_(kReadAhead), reader_([this, &source, &positions] {
          for (const std::int64_t position : positions)
            if (!frames_.push({position, source.read(position)})) return;
          frames_.close();
        }) {}
  ~ReadAhead() {
    frames_.cancel();
    reader_.join();
  }
  std::optional<NextFrame> next() { return frames_.pop(); }
  bool ready() const { return frames_.size() > 0; }

 private:
  BoundedQueue<NextFrame> frames_;
  std::thread reader_;
};

}  // namespace

LiveRunResult run_live(const FrameSource& source, const std::vector<std::int64_t>& positions,
                       LiveMapper& mapper, double fps, const LiveProgress& progress) {
  LiveRunResult result;
  ReadAhead reader(source, positions);
  const std::chrono::duration<double> interval(1. / fps);
  std::optional<NextFrame> next = reader.next();  // the camera starts when a frame is there
  const auto start = Clock::now();
  for (std::size_t i = 0; next; ++i) {
    std::this_thread::sleep_until(
        start + std::chrono::duration_cast<Clock::duration>(interval * static_cast<double>(i)));
    if (next->read.frame) {
      result.sequence.depth_camera = next->read.frame->depth_camera;
      mapper.push(std::move(*next->read.frame));
    } else {
      result.sequence.skipped.push_back({next->position, next->read.fault});
    }
    if (progress && !progress(i + 1, positions.size())) break;
    result.frames_read_late += i + 1 < positions.size() && !reader.ready();
    next = reader.next();
  }
  mapper.drain();
  result.sequence.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  result.sequence.frames = mapper.frames();
  result.statistics = mapper.statistics();
  if (result.sequence.frames.empty())
    throw Error("none of the frames is usable; `ovimap check` tells more");
  return result;
}

}  // namespace ovimap
