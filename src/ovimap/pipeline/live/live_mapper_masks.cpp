// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// What LiveMapper does about masks: which frames wait for them, who finds them, and what becomes of
// those that come late.
#include <algorithm>

#include "ovimap/base/thread_priority.h"
#include "ovimap/pipeline/live/live_mapper.h"

namespace ovimap {

namespace {

/// Gives a frame the pose that it has by now.
void move_to(const Pose& world_from_camera, PreparedFrame& prepared) {
  if (prepared.frame->world_from_camera.matrix() == world_from_camera.matrix()) return;
  auto moved = std::make_shared<Frame>(*prepared.frame);
  moved->world_from_camera = world_from_camera;
  prepared.frame = std::move(moved);
}

}  // namespace

bool LiveMapper::wants_masks(const Frame& frame) {
  if (!mask_source_ || !schedule_.wants(frame, mapper_->map())) return false;
  schedule_.chosen();
  return true;
}

/// Has them, or puts the frame among those that wait. Where too many do, of the two that came
/// soonest after each other the older goes: what is left is spread over the way.
void LiveMapper::ask_for_masks(Prepared& prepared) {
  if (live_.wait_for_masks) {
    prepared.cut = masks_for(prepared);
    if (!prepared.cut) schedule_.went_without();
    return;
  }
  if (repeating_ && !told_masks_.contains(mapper_->number_of(*prepared.frame->frame))) return;
  wishes_.push_back({prepared.frame->frame, prepared.pushed});
  if (repeating_ || wishes_.size() <= static_cast<std::size_t>(live_.mask_wishes)) return;
  std::size_t soonest = 1;
  const auto gap = [&](std::size_t i) { return wishes_[i].pushed - wishes_[i - 1].pushed; };
  for (std::size_t i = 2; i < wishes_.size(); ++i)
    if (gap(i) < gap(soonest)) soonest = i;
  wishes_.erase(wishes_.begin() + static_cast<std::ptrdiff_t>(soonest) - 1);
  const std::lock_guard lock(mutex_);
  ++statistics_.masks_skipped;
}

/// Takes in masks that are there, and gives the network the newest of the frames that wait: it
/// shows where the camera is.
void LiveMapper::apply_late_masks() {
  if (network_busy_)
    if (auto late = found_masks_.try_pop()) take_answer(std::move(late));
  if (!network_busy_ && !wishes_.empty() && waiting() <= live_.mask_backlog) {
    network_busy_ = wanted_masks_.try_push(std::move(wishes_.back()));
    wishes_.pop_back();
  }
  count_waiting();
}

void LiveMapper::take_answer(std::optional<Prepared> late) {
  network_busy_ = false;
  if (late) apply_masks(std::move(*late), nullptr);  // none: cancelled
}

/// Objects that late masks found have no views yet: they are looked at in the masks' own frame.
void LiveMapper::apply_masks(Prepared late, const LiveStep* told) {
  LiveStep step{LiveStep::Kind::kMasks, mapper_->number_of(*late.frame->frame)};
  step.looked = told ? told->looked : late.cut && (catching_up_ || keeps_up());
  const auto entry = std::find_if(frames_.rbegin(), frames_.rend(),
                                  [&](const FrameLogEntry& e) { return e.index == step.frame; });
  if (entry == frames_.rend()) return schedule_.went_without();  // the frame itself was at fault
  mapper_->note(step);
  if (!late.cut) return schedule_.went_without();
  begin("apply_masks");
  entry->labelled = true;
  move_to(entry->world_from_camera, *late.frame);
  mapper_->label(*late.frame, *late.cut);
  if (step.looked) mapper_->look_at_objects(*late.frame->frame, Mapper::Encoder::kRunOn);
  if (after_frame) after_frame(*mapper_, frames_, late.frame->frame->depth_camera);
  const std::lock_guard lock(mutex_);
  ++statistics_.mask_frames;
  ++statistics_.masks_late;
  lags_.add("masks", milliseconds_since(late.pushed));
}

/// No frame comes any more: those that wait for masks get them, the oldest first. Here and not on
/// the network's thread, which lets all others go first: somebody waits for the map.
void LiveMapper::catch_up() {
  catching_up_ = true;
  if (network_busy_) take_answer(found_masks_.pop());
  while (!wishes_.empty() && !masks_suffice_ && !cancelled_) {
    count_waiting();
    apply_masks(answer(wishes_.front()), nullptr);
    wishes_.pop_front();
  }
  const std::lock_guard lock(mutex_);
  statistics_.masks_skipped += static_cast<std::int64_t>(wishes_.size());
  statistics_.masks_waiting = 0;
}

void LiveMapper::count_waiting() {
  const std::lock_guard lock(mutex_);
  statistics_.masks_waiting = static_cast<std::int64_t>(wishes_.size()) + network_busy_;
}

void LiveMapper::find_masks() {
  lower_thread_priority();
  while (auto wish = wanted_masks_.pop()) found_masks_.push(answer(*wish));
  found_masks_.close();
}

LiveMapper::Prepared LiveMapper::answer(const Wish& wish) {
  Prepared late{nullptr, nullptr, wish.pushed};
  late.frame = std::make_shared<PreparedFrame>(prepare_frame(wish.frame, config_, mask_timers_));
  late.cut = masks_for(late);
  return late;
}

/// Null when the frame's masks are bad or there are none of it; other frames may do better.
std::shared_ptr<const FrameSegments> LiveMapper::masks_for(const Prepared& prepared) {
  begin("masks");
  try {
    if (auto cut = cut_segments(*prepared.frame, mask_source_.get(), config_, mask_timers_))
      return std::make_shared<const FrameSegments>(std::move(*cut));
    const std::lock_guard lock(mutex_);
    ++statistics_.masks_absent;
  } catch (const FrameError& fault) {
    const std::lock_guard lock(mutex_);
    if (statistics_.masks_failed++ == 0) statistics_.mask_fault = fault.what();
  }
  return nullptr;
}

}  // namespace ovimap
