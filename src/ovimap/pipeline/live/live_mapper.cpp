// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/live_mapper.h"

#include <algorithm>
#include <utility>

#include "ovimap/base/config.h"
#include "ovimap/pipeline/live/look_again.h"

namespace ovimap {

namespace {

/// A camera does not wait, and what it saw does not come again: an encoder that fails must not end
/// the run.
std::unique_ptr<Mapper> forgiving_mapper(const MapperConfig& config,
                                         std::shared_ptr<MaskSource> masks,
                                         std::shared_ptr<ImageTextEncoder> encoder) {
  auto mapper = std::make_unique<Mapper>(config, std::move(masks), std::move(encoder));
  mapper->forgive_encoder();
  return mapper;
}

}  // namespace

void list_fields(LiveConfig& config, ConfigFields& fields) {
  fields.group("masks", [&](ConfigFields& f) { list_fields(config.masks, f); });
  fields.add("view_interval", config.view_interval, 1, 1000000,
             "objects are looked at in every n-th frame");
  fields.add("queue", config.queue, 1, 1000000,
             "frames that wait at most; then new ones are dropped");
  fields.add("mask_backlog", config.mask_backlog, 0, 1000000,
             "no new masks while more frames than this wait");
  fields.add(
      "mask_wishes", config.mask_wishes, 1, 100000,
      "frames that wait for the mask network at most; what waits at the end gets masks then");
  fields.add("view_backlog", config.view_backlog, 0, 1000000,
             "no looks at objects while more frames than this wait");
  fields.add("wait_for_masks", config.wait_for_masks, "hold each frame until its masks are there");
}

LiveMapper::LiveMapper(const MapperConfig& config, const LiveConfig& live,
                       std::shared_ptr<MaskSource> masks, std::shared_ptr<ImageTextEncoder> encoder)
    : config_(config),
      live_(live),
      mask_source_(masks),
      mapper_(forgiving_mapper(config, std::move(masks), std::move(encoder))),
      schedule_(live.masks),
      incoming_(static_cast<std::size_t>(live.queue)),
      prepared_(1),
      wanted_masks_(1),
      found_masks_(1) {}

LiveMapper::~LiveMapper() {
  cancel();
}

// ----------------------------------------------------------------------------------- from outside

void LiveMapper::start() {
  if (std::exchange(started_, true)) return;
  preparing_ = std::thread([this] { run_stage([this] { prepare_frames(); }); });
  masking_ = std::thread([this] { run_stage([this] { find_masks(); }); });
  fusing_ = std::thread([this] {
    run_stage([this] { fuse_frames(); });
    const std::lock_guard lock(mutex_);
    fused_ = true;
    fusing_ends_.notify_all();
  });
}

bool LiveMapper::push(Frame frame) {
  start();
  rethrow_failure();
  const bool taken =
      incoming_.try_push({std::make_shared<const Frame>(std::move(frame)), Clock::now()});
  const std::lock_guard lock(mutex_);
  ++statistics_.frames_pushed;
  if (!taken) ++statistics_.frames_dropped;
  return taken;
}

void LiveMapper::push_and_wait(Frame frame) {
  start();
  const bool taken =
      incoming_.push({std::make_shared<const Frame>(std::move(frame)), Clock::now()});
  rethrow_failure();
  const std::lock_guard lock(mutex_);
  ++statistics_.frames_pushed;
  if (!taken) ++statistics_.frames_dropped;  // drained or cancelled
}

void LiveMapper::move_and_wait(PoseUpdate update) {
  start();
  incoming_.push({nullptr, Clock::now(), std::make_shared<const PoseUpdate>(std::move(update))});
  rethrow_failure();
}

void LiveMapper::drain(const std::function<bool()>& go_on) {
  start();
  incoming_.close();
  const auto ended = [&] {
    std::unique_lock lock(mutex_);
    return fusing_ends_.wait_for(lock, kLook, [&] { return fused_; });
  };
  while (go_on && !masks_suffice_ && !ended())
    if (!go_on()) masks_suffice_ = true;
  join();
  rethrow_failure();
}

void LiveMapper::cancel() {
  stop();
  join();
}

void LiveMapper::stop() {
  cancelled_ = true;
  incoming_.cancel();
  prepared_.cancel();
  wanted_masks_.cancel();
  found_masks_.cancel();
}

Mapper LiveMapper::take() {
  join();
  mapper_->timers().merge(prepare_timers_);
  mapper_->timers().merge(mask_timers_);
  return std::move(*mapper_);
}

LiveStatistics LiveMapper::statistics() const {
  const std::lock_guard lock(mutex_);
  LiveStatistics result = statistics_;
  const auto lags = lags_.summary();
  if (const auto found = lags.find("geometry"); found != lags.end())
    result.geometry_lag = found->second;
  if (const auto found = lags.find("masks"); found != lags.end()) result.mask_lag = found->second;
  return result;
}

// --------------------------------------------------------------------------------------- preparing

void LiveMapper::prepare_frames() {
  while (auto next = incoming_.pop()) {
    if (next->update) {
      prepared_.push({nullptr, nullptr, next->pushed, std::move(next->update)});
      continue;
    }
    begin("prepare");
    Prepared prepared{nullptr, nullptr, next->pushed};
    prepared.frame = std::make_shared<PreparedFrame>(
        prepare_frame(std::move(next->frame), config_, prepare_timers_));
    if (!mask_source_)
      prepared.cut = std::make_shared<const FrameSegments>(
          *cut_segments(*prepared.frame, nullptr, config_, prepare_timers_));
    prepared_.push(std::move(prepared));
  }
  prepared_.close();
}

void LiveMapper::restore(MapDocument&& document) {
  frames_ = document.frames;
  depth_camera_ = document.depth_camera;
  const bool begun = !frames_.empty();
  mapper_->restore(std::move(document));
  if (begun) mapper_->note({LiveStep::Kind::kResumed});
}

// ------------------------------------------------------------------------------------------ fusing

/// While none comes there is time for masks, and for whoever watches.
std::optional<LiveMapper::Prepared> LiveMapper::next_prepared() {
  while (!prepared_.wait_for(kLook)) {
    if (!repeating_) apply_late_masks();
    tell_waiting();
  }
  return prepared_.pop();
}

void LiveMapper::tell_waiting() {
  if (while_waiting && !frames_.empty()) while_waiting(*mapper_, frames_, depth_camera_);
}

void LiveMapper::fuse_frames() {
  while (auto next = next_prepared()) {
    const LiveStep* told = repeat_until_frame();
    if (!told) apply_late_masks();
    if (next->update) {
      move(*next->update);
      continue;
    }
    if (!finder_ || locate(*next->frame)) {
      fuse(std::move(*next), told);
    } else {
      mapper_->note({LiveStep::Kind::kFrame, mapper_->number_of(*next->frame->frame)});
      tell_waiting();
    }
  }
  if (repeating_)
    (void)repeat_until_frame();
  else
    catch_up();
  wanted_masks_.close();
  if (cancelled_) return;
  mapper_->finish();
  count_encoder_failures();
}

void LiveMapper::repeat(std::vector<LiveStep> steps) {
  repeating_ = true;
  told_ = std::move(steps);
  for (const LiveStep& step : told_)
    if (step.kind == LiveStep::Kind::kMasks) told_masks_.insert(step.frame);
}

/// What the next frame is to be done with; null when nothing is told.
const LiveStep* LiveMapper::repeat_until_frame() {
  for (; next_told_ < told_.size() && !cancelled_; ++next_told_) {
    const LiveStep& step = told_[next_told_];
    if (step.kind == LiveStep::Kind::kFrame) return &told_[next_told_++];
    if (step.kind == LiveStep::Kind::kResumed) mapper_->note(step);
    if (step.kind != LiveStep::Kind::kMasks) continue;
    const auto wish = std::find_if(wishes_.begin(), wishes_.end(), [&](const Wish& w) {
      return mapper_->number_of(*w.frame) == step.frame;
    });
    if (wish == wishes_.end()) continue;
    Prepared late = answer(*wish);
    wishes_.erase(wish);
    apply_masks(std::move(late), &step);
  }
  return nullptr;
}

void LiveMapper::count_encoder_failures() {
  EncoderFailures failures = mapper_->encoder_failures();
  const std::lock_guard lock(mutex_);
  statistics_.views_failed = failures.views;
  statistics_.encoder_fault = std::move(failures.first);
}

/// Gives the frame its pose; false when the camera is lost.
bool LiveMapper::locate(PreparedFrame& prepared) {
  begin("track");
  auto frame = std::make_shared<Frame>(*prepared.frame);
  const TrackedFrame& tracked = finder_->locate(*frame, *mapper_);
  prepared.frame = std::move(frame);
  if (after_tracking) after_tracking(tracked);
  if (tracked.tracked) return true;
  const std::lock_guard lock(mutex_);
  ++statistics_.frames_lost;
  return false;
}

void LiveMapper::move(const PoseUpdate& update) {
  begin("move");
  if (mapper_->kept_frames().empty() || mapper_->map().has_store()) return;
  const std::vector<MovedPose> moves = moves_of(update, frames_);
  if (moves.empty()) return;
  mapper_->note({LiveStep::Kind::kMoved});
  move_frames(moves, update.by_time, *mapper_, frames_, depth_camera_);
  if (after_frame) after_frame(*mapper_, frames_, depth_camera_);
  const std::lock_guard lock(mutex_);
  ++statistics_.pose_updates;
}

void LiveMapper::fuse(Prepared prepared, const LiveStep* told) {
  begin("fuse");
  const Frame& frame = *prepared.frame->frame;
  LiveStep step{LiveStep::Kind::kFrame, mapper_->number_of(frame)};
  step.asked = told ? told->asked : wants_masks(frame);
  if (step.asked) ask_for_masks(prepared);
  depth_camera_ = frame.depth_camera;
  if (!take_in(prepared)) {  // which says what comes after it as well
    mapper_->note(step);
    return;
  }
  const double lag_ms = milliseconds_since(prepared.pushed);
  frames_.push_back({step.frame, frame.timestamp_s, frame.name, frame.world_from_camera,
                     prepared.cut != nullptr});
  step.looked = told ? told->looked : time_for_views();
  mapper_->note(step);
  if (step.looked) {
    begin("views");
    mapper_->look_at_objects(frame, Mapper::Encoder::kRunOn);
  }
  if (finder_) finder_->close_loops(*mapper_, frames_, frame.depth_camera);
  if (after_frame) after_frame(*mapper_, frames_, frame.depth_camera);
  count_encoder_failures();
  const std::lock_guard lock(mutex_);
  ++statistics_.frames_fused;
  statistics_.mask_frames += prepared.cut && prepared.cut->masked;
  lags_.add("geometry", lag_ms);
}

/// False where the frame itself is at fault.
bool LiveMapper::take_in(const Prepared& prepared) {
  try {
    mapper_->fuse(*prepared.frame, prepared.cut.get());
    return true;
  } catch (const FrameError& fault) {
    const std::lock_guard lock(mutex_);
    if (statistics_.frames_failed++ == 0) statistics_.frame_fault = fault.what();
    return false;
  }
}

/// Whether it is the turn of a look at the objects, and there is time for one.
bool LiveMapper::time_for_views() {
  if (mapper_->frames() % live_.view_interval != 0) return false;
  if (keeps_up()) return true;
  const std::lock_guard lock(mutex_);
  ++statistics_.views_skipped;
  return false;
}

// ----------------------------------------------------------------------------------------- threads

template <class Work>
void LiveMapper::run_stage(const Work& work) {
  try {
    work();
  } catch (...) {
    fail(std::current_exception());
  }
}

void LiveMapper::fail(std::exception_ptr failure) {
  {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
  }
  stop();
}

void LiveMapper::rethrow_failure() {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

void LiveMapper::join() {
  for (std::thread* thread : {&preparing_, &fusing_, &masking_})
    if (thread->joinable()) thread->join();
}

}  // namespace ovimap
