// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/frame_intake.h"

#include <array>
#include <cstdio>

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
  if (offer == Offer::kAgain && skipped_ > 0) --skipped_;  // it was counted, and came after all
  frame.index = next_index_++;
  if (frame.name.empty()) frame.name = name_of(frame.index);
  frames_.push_back(std::move(frame));
  ++taken_;
  changed_.notify_all();
  return Answer::kTaken;
}

void FrameIntake::finish() {
  const std::lock_guard lock(mutex_);
  finished_ = true;
  changed_.notify_all();
}

void FrameIntake::begin_at(std::int64_t index) {
  const std::lock_guard lock(mutex_);
  next_index_ = index;
}

std::optional<Frame> FrameIntake::next(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return finished_ || !frames_.empty(); });
  if (frames_.empty()) return std::nullopt;
  std::optional<Frame> frame(std::move(frames_.front()));
  frames_.pop_front();
  return frame;
}

bool FrameIntake::ended() const {
  const std::lock_guard lock(mutex_);
  return finished_ && frames_.empty();
}

FrameIntake::Counts FrameIntake::counts() const {
  const std::lock_guard lock(mutex_);
  return {taken_, skipped_, static_cast<std::int64_t>(frames_.size())};
}

}  // namespace ovimap
