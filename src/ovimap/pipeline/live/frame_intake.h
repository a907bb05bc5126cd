// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "ovimap/frames/frame/frame.h"
#include "ovimap/pipeline/sequence/moved_frames.h"

namespace ovimap {

/// Where frames of one depth camera wait that others push: at most so many, and what does not fit
/// is counted. Frames are numbered as they are handed out. Corrections of their poses wait among
/// them, and their turn comes when the frames sent before are handed out. Thread-safe.
class FrameIntake {
 public:
  explicit FrameIntake(std::size_t capacity) : capacity_(capacity) {}

  enum class Answer {
    kTaken,
    kFull,         ///< as many wait as may; the frame was left out
    kEnded,        ///< finish() was called
    kOtherCamera,  ///< than the depth camera of the frames so far
  };
  enum class Offer {
    kFirst,
    kAgain,  ///< the frame was left out before: counted already
  };
  /// Does not wait. A frame without a name is named by its index.
  Answer offer(Frame frame, Offer offer = Offer::kFirst);
  /// What `offer` would answer now; kFull counts as it does there, so ask for one frame once.
  Answer room(Offer offer);
  /// Corrects poses of frames that were taken before. Only the latest correction waits: a graph
  /// says all that those before it said. False once finish() was called.
  bool correct(PoseUpdate update);
  /// No more frames come. Those that wait are still handed out.
  void finish();

  /// Before the first frame is handed out: a resumed run goes on counting, with its camera. What
  /// waits of another is left out, and counted. nullopt: any camera may come.
  void resume_at(std::int64_t index, const std::optional<PinholeCamera>& depth_camera);
  /// Copies of the oldest `count` that wait, or of as many as can, once they do; of those that are
  /// there when no more come. nullopt when it came to neither for so long.
  std::optional<std::vector<Frame>> peek(std::size_t count, std::chrono::milliseconds patience);
  /// Of the frames so far; nullopt before the first.
  std::optional<PinholeCamera> depth_camera() const;
  /// The oldest frame that waits, once there is one; nullopt when none came for so long, none comes
  /// any more, or it is the turn of a correction.
  std::optional<Frame> next(std::chrono::milliseconds patience);
  /// The correction whose turn it is.
  std::optional<PoseUpdate> next_update();
  /// finish() was called and everything is handed out.
  bool ended() const;

  struct Counts {
    std::int64_t taken = 0, skipped = 0, waiting = 0;
  };
  Counts counts() const;

 private:
  Answer room_now(Offer offer);
  bool update_is_due() const { return update_ && frames_before_update_ == 0; }

  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Frame> frames_;
  std::optional<PoseUpdate> update_;
  std::size_t frames_before_update_ = 0;  ///< of those that wait
  std::optional<PinholeCamera> depth_camera_;
  std::int64_t next_index_ = 0, taken_ = 0, skipped_ = 0;
  bool finished_ = false;
};

}  // namespace ovimap
