// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/frame_intake.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace ovimap {

namespace {

std::string name_of(std::int64_t index) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "frame%06lld", static_cast<long long>(index));
  return text.data();
}

}  // namespace

FrameIntake::Answer FrameIntake::room(Offer offer) {
  const std::lock_guard lock(mutex_);
  return room_now(offer);
}

FrameIntake::Answer FrameIntake::room_now(Offer offer) {
  if (finished_) return Answer::kEnded;
  if (frames_.size() < capacity_) return Answer::kTaken;
  if (offer == Offer::kFirst) ++skipped_;
  return Answer::kFull;
}

FrameIntake::Answer FrameIntake::offer(Frame frame, Offer offer) {
  const std::lock_guard lock(mutex_);
  const Answer answer = room_now(offer);
  if (answer != Answer::kTaken) return answer;
  if (depth_camera_ && *depth_camera_ != frame.depth_camera) return Answer::kOtherCamera;
  depth_camera_ = frame.depth_camera;
  if (offer == Offer::kAgain && skipped_ > 0) --skipped_;  // it was counted, and came after all
  frames_.push_back(std::move(frame));
  ++taken_;
  changed_.notify_all();
  return Answer::kTaken;
}

bool FrameIntake::correct(PoseUpdate update) {
  const std::lock_guard lock(mutex_);
  if (finished_) return false;
  update_ = std::move(update);
  frames_before_update_ = frames_.size();
  changed_.notify_all();
  return true;
}

std::optional<PoseUpdate> FrameIntake::next_update() {
  const std::lock_guard lock(mutex_);
  return update_is_due() ? std::exchange(update_, std::nullopt) : std::nullopt;
}

void FrameIntake::finish() {
  const std::lock_guard lock(mutex_);
  finished_ = true;
  changed_.notify_all();
}

void FrameIntake::resume_at(std::int64_t index, const std::optional<PinholeCamera>& depth_camera) {
  const std::lock_guard lock(mutex_);
  next_index_ = index;
  if (!depth_camera) return;
  depth_camera_ = depth_camera;
  const auto others = static_cast<std::int64_t>(std::erase_if(
      frames_, [&](const Frame& frame) { return frame.depth_camera != *depth_camera; }));
  frames_before_update_ = std::min(frames_before_update_, frames_.size());
  taken_ -= others;
  skipped_ += others;
}

std::optional<std::vector<Frame>> FrameIntake::peek(std::size_t count,
                                                    std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  const std::size_t wanted = std::min(count, capacity_);
  if (!changed_.wait_for(lock, patience, [&] { return finished_ || frames_.size() >= wanted; }))
    return std::nullopt;
  const auto first = static_cast<std::ptrdiff_t>(std::min(wanted, frames_.size()));
  return std::vector<Frame>(frames_.begin(), frames_.begin() + first);
}

std::optional<PinholeCamera> FrameIntake::depth_camera() const {
  const std::lock_guard lock(mutex_);
  return depth_camera_;
}

std::optional<Frame> FrameIntake::next(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience,
                    [&] { return finished_ || !frames_.empty() || update_is_due(); });
  if (frames_.empty() || update_is_due()) return std::nullopt;
  std::optional<Frame> frame(std::move(frames_.front()));
  frames_.pop_front();
  if (update_) --frames_before_update_;
  frame->index = next_index_++;
  if (frame->name.empty()) frame->name = name_of(frame->index);
  return frame;
}

bool FrameIntake::ended() const {
  const std::lock_guard lock(mutex_);
  return finished_ && frames_.empty() && !update_;
}

FrameIntake::Counts FrameIntake::counts() const {
  const std::lock_guard lock(mutex_);
  return {taken_, skipped_, static_cast<std::int64_t>(frames_.size())};
}

}  // namespace ovimap
