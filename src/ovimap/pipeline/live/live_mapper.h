// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

#include "ovimap/base/bounded_queue.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/live/mask_schedule.h"
#include "ovimap/pipeline/mapping/mapper.h"
#include "ovimap/pipeline/sequence/moved_frames.h"
#include "ovimap/pipeline/sequence/pose_finder.h"

namespace ovimap {

struct LiveConfig {
  MaskScheduleConfig masks;
  int view_interval = 10;  ///< objects are looked at in every n-th frame
  int queue = 8;           ///< frames that wait at most; then new ones are dropped
  int mask_backlog = 2;    ///< no new masks while more frames than this wait
  int mask_wishes = 24;    ///< frames that wait for the network at most, also after the last one
  int view_backlog = 4;    ///< no views while more frames than this wait
  bool wait_for_masks = false;  ///< hold the frame until its masks are there, as Mapper does
};
void list_fields(LiveConfig& config, ConfigFields& fields);

/// What a live run did and left out. Lags are from `push` until the result was in the map.
struct LiveStatistics {
  std::int64_t frames_pushed = 0, frames_fused = 0, frames_dropped = 0;
  std::int64_t frames_lost = 0;    ///< fused nowhere, for the camera was lost
  std::int64_t frames_failed = 0;  ///< fused nowhere, for they were at fault themselves
  std::int64_t pose_updates = 0;   ///< that moved the map
  std::int64_t mask_frames = 0;    ///< frames whose masks are in the map
  std::int64_t masks_late = 0;     ///< ... after their frame was fused
  std::int64_t masks_waiting = 0;  ///< frames that are to get masks yet
  std::int64_t masks_skipped = 0;  ///< frames that wanted masks, of which there were too many
  std::int64_t masks_failed = 0;   ///< frames whose masks were bad
  std::int64_t masks_absent = 0;   ///< frames that the source had no masks of
  std::int64_t views_skipped = 0;  ///< looks at objects left out
  std::int64_t views_failed = 0;   ///< views without embedding, because the encoder threw
  StageSummary geometry_lag, mask_lag;
  std::string frame_fault;    ///< of the first that failed
  std::string mask_fault;     ///< likewise
  std::string encoder_fault;  ///< likewise
};

/// Mapper for a camera that does not wait. Frames go through threads of their own: one prepares
/// (registration, surface, and regions where there are no masks), one fuses, one runs the mask
/// network, one the encoder. Masks that come late are applied with the depth and pose of their own
/// frame, those of frames that waited too long after the last frame. When it falls behind it puts
/// off masks first, leaves out views second, frames last, and counts them. Frames that are at fault
/// themselves (FrameError), bad masks and an encoder that throws cost what they were asked for, and
/// are counted too; whatever else throws ends the run. All calls but `statistics` come from one
/// thread.
class LiveMapper {
 public:
  LiveMapper(const MapperConfig& config, const LiveConfig& live,
             std::shared_ptr<MaskSource> masks = nullptr,
             std::shared_ptr<ImageTextEncoder> encoder = nullptr);
  /// Cancels.
  ~LiveMapper();

  /// Shows views also to what recognizes things. Before the first push only.
  void recognize_with(std::shared_ptr<const ThingRecognizer> recognizer) {
    mapper_->recognize_with(std::move(recognizer));
  }
  /// Finds the poses of the frames instead of taking theirs. Before the first push only.
  void track_with(std::shared_ptr<PoseFinder> finder) { finder_ = std::move(finder); }

  /// Starts the threads, so that `while_waiting` is called before a frame comes. The first push
  /// does it otherwise; all that has to be set before is set by then.
  void start();

  /// Takes a frame without waiting; false when it had to be dropped. Throws what a stage threw.
  bool push(Frame frame);
  /// Waits for room instead. Throws what a stage threw.
  void push_and_wait(Frame frame);

  /// Moves the frames that were pushed so far, as far as they are in the map when their turn comes,
  /// and the map with them (move_frames); waits for room. Does nothing where no frames are kept.
  /// Frames are not fused meanwhile. Throws what a stage threw.
  void move_and_wait(PoseUpdate update);

  /// Does what another live run did (MapRecord::live_steps), instead of what there is time for:
  /// takes in masks, asks for them and looks at objects when that run did, and so makes the same
  /// map. Push the frames that it took, in that order, and wait. Before the first push only.
  void repeat(std::vector<LiveStep> steps);

  /// Goes on where a stored map stopped, made with the same config. Before the first push only.
  void restore(MapDocument&& document);
  /// As Mapper::number_from; before the first frame.
  void number_from(std::int64_t first) { mapper_->number_from(first); }

  /// Waits until everything pushed is in the map, with its masks and embeddings; then no more
  /// frames are taken. `go_on`, which may be null, is asked now and then; once it says no, frames
  /// that still wait for masks stay without. Throws what a stage threw.
  void drain(const std::function<bool()>& go_on = nullptr);
  /// Stops as soon as each stage has finished what it is at. What was fused stays.
  void cancel();
  /// The same without waiting for the stages, from any thread: calls that wait for them return.
  void stop();

  /// The map and everything about it, once drained or cancelled. Call once.
  Mapper take();
  /// The frames that were fused, in order, once drained or cancelled.
  const std::vector<FrameLogEntry>& frames() const { return frames_; }

  LiveStatistics statistics() const;
  const MapperConfig& config() const { return config_; }

  /// Called by every stage before it works, on its thread. For tests; set before the first push.
  std::function<void(const char* stage)> before_stage;
  /// Called on the fusing thread with all frames so far; what it throws ends the run.
  using Watcher =
      std::function<void(Mapper&, const std::vector<FrameLogEntry>&, const PinholeCamera&)>;
  /// Called after every frame and every change of labels. Set before the first push.
  Watcher after_frame;
  /// Called now and then while frames are in the map and no further one is fused: a camera that
  /// pauses or is lost leaves time to show and to store what it saw. Set before the first push.
  Watcher while_waiting;
  /// Called with what the tracker made of each frame, on the fusing thread; set before the first
  /// push.
  std::function<void(const TrackedFrame&)> after_tracking;

 private:
  using Clock = std::chrono::steady_clock;
  struct Incoming {
    std::shared_ptr<const Frame> frame;
    Clock::time_point pushed;
    std::shared_ptr<const PoseUpdate> update = nullptr;  ///< instead of a frame
  };
  struct Prepared {
    std::shared_ptr<PreparedFrame> frame;
    std::shared_ptr<const FrameSegments> cut;  ///< null: not masked, or masks are to come
    Clock::time_point pushed;
    std::shared_ptr<const PoseUpdate> update = nullptr;  ///< instead of a frame
  };
  /// A frame that is to get masks. Preparing it again takes less than keeping what was prepared.
  struct Wish {
    std::shared_ptr<const Frame> frame;
    Clock::time_point pushed;
  };

  void prepare_frames();
  std::optional<Prepared> next_prepared();
  void fuse_frames();
  void tell_waiting();
  void find_masks();
  const LiveStep* repeat_until_frame();
  bool locate(PreparedFrame& prepared);
  void move(const PoseUpdate& update);
  void fuse(Prepared prepared, const LiveStep* told);
  bool take_in(const Prepared& prepared);
  bool wants_masks(const Frame& frame);
  void ask_for_masks(Prepared& prepared);
  bool time_for_views();
  void take_answer(std::optional<Prepared> late);
  void catch_up();
  void count_waiting();
  int waiting() const { return static_cast<int>(incoming_.size() + prepared_.size()); }
  static double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  }
  bool keeps_up() const { return waiting() <= live_.view_backlog && mapper_->encoder_keeps_up(); }
  void count_encoder_failures();
  void apply_masks(Prepared late, const LiveStep* told);
  void apply_late_masks();
  Prepared answer(const Wish& wish);
  std::shared_ptr<const FrameSegments> masks_for(const Prepared& prepared);

  void begin(const char* stage) const {
    if (before_stage) before_stage(stage);
  }
  template <class Work>
  void run_stage(const Work& work);
  void fail(std::exception_ptr failure);
  void rethrow_failure();
  void join();

  MapperConfig config_;
  LiveConfig live_;
  std::shared_ptr<MaskSource> mask_source_;
  std::shared_ptr<PoseFinder> finder_;  ///< null: frames have poses; the fusing thread's
  std::unique_ptr<Mapper> mapper_;      ///< the fusing thread's, until that ends
  MaskSchedule schedule_;
  StageTimers prepare_timers_, mask_timers_;

  BoundedQueue<Incoming> incoming_;
  BoundedQueue<Prepared> prepared_;
  BoundedQueue<Wish> wanted_masks_;
  BoundedQueue<Prepared> found_masks_;
  std::deque<Wish> wishes_;  ///< the fusing thread's, as the next; by age
  bool network_busy_ = false, catching_up_ = false;
  std::vector<LiveStep> told_;  ///< what to repeat
  std::size_t next_told_ = 0;
  std::set<std::int64_t> told_masks_;  ///< frames whose masks it takes in late
  std::vector<FrameLogEntry> frames_;
  PinholeCamera depth_camera_;  ///< of the last frame that was fused

  std::atomic<bool> cancelled_ = false, repeating_ = false;
  std::atomic<bool> masks_suffice_ = false;  ///< frames that wait for them stay without
  mutable std::mutex mutex_;                 ///< guards what follows
  LiveStatistics statistics_;
  StageTimers lags_;
  std::exception_ptr failure_;
  bool fused_ = false;  ///< the fusing thread has ended
  std::condition_variable fusing_ends_;

  bool started_ = false;
  std::thread preparing_, fusing_, masking_;
};

}  // namespace ovimap
