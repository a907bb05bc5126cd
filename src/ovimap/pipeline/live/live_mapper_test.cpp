// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/live_mapper.h"

#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/semantics/views/color_encoder_fixture.h"

namespace ovimap {
namespace {

using namespace std::chrono_literals;

constexpr int kRounds = 2;  // the camera goes round the desk twice

std::vector<Frame> desk_frames() {
  const DeskScene scene;
  std::vector<Frame> frames;
  for (std::int64_t i = 0; i < kRounds * scene.size(); ++i)
    frames.push_back(*scene.read(i % scene.size()).frame);
  return frames;
}

/// The desk from the same places, each time another frame.
std::vector<Frame> numbered_frames() {
  std::vector<Frame> frames = desk_frames();
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].index = static_cast<std::int64_t>(i);
  return frames;
}

MapperConfig mapper_config(int mask_interval) {
  MapperConfig config;
  config.mask_interval = mask_interval;
  config.view_interval = 3;
  config.semantics.queue.capacity = 100000;
  return config;
}

LiveConfig live_config(int mask_interval) {
  LiveConfig config;
  config.masks.rule = MaskRule::kInterval;
  config.masks.interval = mask_interval;
  config.view_interval = 3;
  config.mask_backlog = config.view_backlog = 1000;  // nothing is left out
  return config;
}

void expect_equal(Mapper& live, Mapper& synchronous) {
  EXPECT_EQ(live.map().content_hash(), synchronous.map().content_hash());
  EXPECT_EQ(live.registry().aliases(), synchronous.registry().aliases());
  EXPECT_EQ(live.frames(), synchronous.frames());
  EXPECT_EQ(live.mask_frames(), synchronous.mask_frames());
  const SuperPointLooks a = live.take_looks(), b = synchronous.take_looks();
  ASSERT_EQ(a.size(), b.size());
  EXPECT_GT(a.size(), 0u);
  for (const auto& [label, look] : a) {
    ASSERT_TRUE(b.contains(label));
    const std::vector<ObjectView>& others = b.at(label).views;
    ASSERT_EQ(look.views.size(), others.size());
    for (std::size_t i = 0; i < others.size(); ++i) {
      EXPECT_EQ(look.views[i].key(), others[i].key());
      EXPECT_EQ(look.views[i].embedding, others[i].embedding);
    }
  }
}

/// The same frames, live and one after another.
void compare_with_mapper(std::shared_ptr<MaskSource> masks, int mask_interval,
                         const std::function<void(const char*)>& before_stage = nullptr) {
  Mapper synchronous(mapper_config(mask_interval), masks, std::make_shared<ColorEncoder>());
  for (const Frame& frame : desk_frames()) synchronous.process(frame);
  LiveConfig live = live_config(mask_interval);
  live.wait_for_masks = true;
  LiveMapper mapper(mapper_config(mask_interval), live, masks, std::make_shared<ColorEncoder>());
  mapper.before_stage = before_stage;
  for (const Frame& frame : desk_frames()) mapper.push_and_wait(frame);
  mapper.drain();
  const LiveStatistics done = mapper.statistics();
  EXPECT_EQ(done.frames_fused, done.frames_pushed);
  EXPECT_EQ(done.frames_dropped + done.masks_skipped + done.views_skipped + done.masks_late, 0);
  Mapper result = mapper.take();
  synchronous.finish();
  expect_equal(result, synchronous);
}

TEST(LiveMapper, EqualsTheMapperWithDepthAlone) {
  compare_with_mapper(nullptr, 1);
}

TEST(LiveMapper, EqualsTheMapperWhenItWaitsForMasks) {
  compare_with_mapper(std::make_shared<DeskMasks>(), 1);
  compare_with_mapper(std::make_shared<DeskMasks>(), 5);
}

std::shared_ptr<DeskMasks> sparse_masks(std::int64_t masked_every) {
  auto masks = std::make_shared<DeskMasks>();
  masks->masked_every = masked_every;
  return masks;
}

TEST(LiveMapper, EqualsTheMapperWhenFramesHaveNoMasks) {
  compare_with_mapper(sparse_masks(3), 1);
  compare_with_mapper(sparse_masks(4), 3);
}

TEST(LiveMapper, FramesWithoutMasksAreCountedAndTheNextIsAsked) {
  LiveConfig live = live_config(1);
  live.masks.rule = MaskRule::kNeed;
  live.masks.min_gap = 1000;  // a frame that gets masks is the last that is asked
  live.wait_for_masks = true;
  auto masks = std::make_shared<DeskMasks>();
  LiveMapper mapper(mapper_config(1), live, masks);
  masks->masked_every = 5;
  std::vector<Frame> frames = desk_frames();
  frames.erase(frames.begin());  // the first five have none: 1 ... 4, then 5 has
  for (const Frame& frame : frames) mapper.push_and_wait(frame);
  mapper.drain();
  const LiveStatistics done = mapper.statistics();
  EXPECT_EQ(done.masks_absent, 4);
  EXPECT_EQ(done.mask_frames, 1);
  EXPECT_EQ(done.masks_failed, 0);
  EXPECT_EQ(done.frames_fused, done.frames_pushed);
  EXPECT_EQ(mapper.take().mask_frames(), 1);
  int labelled = 0;
  for (const FrameLogEntry& entry : mapper.frames()) labelled += entry.labelled;
  EXPECT_EQ(labelled, 1);
}

TEST(LiveMapper, LateAnswersThatThereAreNoMasksChangeNothing) {
  LiveMapper mapper(mapper_config(1), live_config(1), sparse_masks(1000000));
  std::vector<Frame> frames = desk_frames();
  for (Frame& frame : frames) ++frame.index;  // none of them is 0
  for (const Frame& frame : frames) mapper.push_and_wait(frame);
  mapper.drain();
  const LiveStatistics done = mapper.statistics();
  EXPECT_GE(done.masks_absent, 1);
  EXPECT_EQ(done.mask_frames + done.masks_late, 0);
  const Mapper result = mapper.take();
  EXPECT_EQ(result.mask_frames(), 0);
  EXPECT_TRUE(result.registry().super_points().empty());
}

/// Sleeps up to two milliseconds, differently each time.
class RandomDelay {
 public:
  explicit RandomDelay(unsigned seed = 3) : random_(seed) {}
  void operator()(const char*) {
    std::chrono::microseconds delay;
    {
      const std::lock_guard lock(mutex_);
      delay = std::chrono::microseconds(random_() % 2000);
    }
    std::this_thread::sleep_for(delay);
  }

 private:
  std::mutex mutex_;
  std::mt19937 random_;
};

TEST(LiveMapper, DelaysInAnyStageChangeNothing) {
  RandomDelay delay;
  compare_with_mapper(nullptr, 1, std::ref(delay));
  compare_with_mapper(std::make_shared<DeskMasks>(), 3, std::ref(delay));
}

/// Masks that take a while, as a network's do.
class SlowMasks : public DeskMasks {
 public:
  std::optional<Entities> entities(const Frame& frame,
                                   std::span<const MaskPrompt> prompts) override {
    std::this_thread::sleep_for(20ms);
    if (frame.index == bad_frame) throw FrameError("mask of frame0 is 1x1, expected 160x120");
    return DeskMasks::entities(frame, prompts);
  }
  std::int64_t bad_frame = -1;
};

TEST(LiveMapper, LateMasksStillTellTheObjectsApart) {
  RandomDelay delay;
  LiveMapper mapper(mapper_config(1), live_config(1), std::make_shared<SlowMasks>(),
                    std::make_shared<ColorEncoder>());
  mapper.before_stage = std::ref(delay);
  for (const Frame& frame : desk_frames()) {
    mapper.push_and_wait(frame);
    std::this_thread::sleep_for(5ms);
  }
  mapper.drain();
  const LiveStatistics done = mapper.statistics();
  EXPECT_EQ(done.frames_fused, kRounds * DeskScene::kFrames);
  EXPECT_EQ(done.masks_late, kRounds * DeskScene::kFrames) << "most of them after the last frame";
  EXPECT_EQ(done.mask_frames, done.masks_late);
  EXPECT_EQ(done.masks_skipped + done.masks_waiting, 0);
  EXPECT_GT(done.mask_lag.p50_ms, 15);
  const Mapper result = mapper.take();
  EXPECT_EQ(result.mask_frames(), done.mask_frames);
  EXPECT_EQ(summarize_instances(result.map(), result.registry(), {}).size(), 3u);
}

TEST(LiveMapper, TooManyFramesThatWaitForMasksAreThinned) {
  LiveConfig live = live_config(1);
  live.mask_wishes = 3;
  LiveMapper mapper(mapper_config(1), live, std::make_shared<SlowMasks>());
  const std::vector<Frame> frames = numbered_frames();
  for (const Frame& frame : frames) mapper.push_and_wait(frame);
  mapper.drain();
  const LiveStatistics done = mapper.statistics();
  EXPECT_GT(done.masks_skipped, 0);
  EXPECT_EQ(done.masks_skipped + done.mask_frames, kRounds * DeskScene::kFrames);
  EXPECT_GE(done.mask_frames, live.mask_wishes);
  int late = 0;
  for (const FrameLogEntry& entry : mapper.frames())
    late += entry.labelled && entry.index < DeskScene::kFrames;
  EXPECT_GT(late, 0) << "what waits is spread over the way";
}

TEST(LiveMapper, WhoDoesNotWaitForMasksGetsTheMapWithoutThem) {
  LiveMapper mapper(mapper_config(1), live_config(1), std::make_shared<SlowMasks>());
  for (const Frame& frame : desk_frames()) mapper.push_and_wait(frame);
  mapper.drain([] { return false; });
  const LiveStatistics done = mapper.statistics();
  EXPECT_EQ(done.frames_fused, kRounds * DeskScene::kFrames);
  EXPECT_GT(done.masks_skipped, 0);
  EXPECT_EQ(done.masks_waiting, 0);
}

TEST(LiveMapper, MasksComeWhileTheCameraRests) {
  LiveMapper mapper(mapper_config(1), live_config(1), std::make_shared<DeskMasks>());
  mapper.push_and_wait(desk_frames()[0]);
  for (int look = 0; look < 200 && mapper.statistics().mask_frames == 0; ++look)
    std::this_thread::sleep_for(20ms);
  EXPECT_EQ(mapper.statistics().mask_frames, 1);
  mapper.cancel();
}

TEST(LiveMapper, DropsFramesRatherThanQueueThemAndCountsThem) {
  LiveConfig live = live_config(1);
  live.queue = 2;
  LiveMapper mapper(mapper_config(1), live);
  mapper.before_stage = [](const char* stage) {
    if (std::string_view(stage) == "fuse") std::this_thread::sleep_for(20ms);
  };
  for (const Frame& frame : desk_frames()) mapper.push(frame);
  mapper.drain();
  const LiveStatistics done = mapper.statistics();
  EXPECT_EQ(done.frames_pushed, kRounds * DeskScene::kFrames);
  EXPECT_GT(done.frames_dropped, 0);
  EXPECT_EQ(done.frames_fused + done.frames_dropped, done.frames_pushed);
  EXPECT_EQ(mapper.take().frames(), done.frames_fused);
}

TEST(LiveMapper, LeavesOutMasksAndViewsBeforeFrames) {
  LiveConfig live = live_config(1);
  live.queue = 100;
  live.mask_backlog = live.view_backlog = 0;
  live.mask_wishes = 2;
  LiveMapper mapper(mapper_config(1), live, std::make_shared<DeskMasks>(),
                    std::make_shared<ColorEncoder>());
  mapper.before_stage = [](const char* stage) {
    if (std::string_view(stage) == "fuse") std::this_thread::sleep_for(2ms);
  };
  for (const Frame& frame : desk_frames()) mapper.push(frame);
  mapper.drain();
  const LiveStatistics done = mapper.statistics();
  EXPECT_EQ(done.frames_dropped, 0);
  EXPECT_GT(done.masks_skipped, 0);
  EXPECT_GT(done.views_skipped, 0);
}

std::vector<LiveStep> steps_of(const Mapper& mapper) {
  return mapper.record({}, {}, {}).live_steps;
}

TEST(LiveMapper, RepeatsWhatAnotherRunHadTimeFor) {
  LiveConfig hurried = live_config(1);
  hurried.queue = 2;
  const std::vector<Frame> frames = numbered_frames();
  for (int seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    RandomDelay delay(static_cast<unsigned>(seed));
    LiveMapper live(mapper_config(1), hurried, std::make_shared<SlowMasks>(),
                    std::make_shared<ColorEncoder>());
    live.before_stage = [&](const char* stage) { delay(stage); };
    for (const Frame& frame : frames) {
      live.push(frame);
      std::this_thread::sleep_for(4ms);
    }
    live.drain();
    EXPECT_GT(live.statistics().masks_late, 0);
    Mapper first = live.take();
    const std::vector<LiveStep> steps = steps_of(first);

    LiveMapper repeating(mapper_config(1), hurried, std::make_shared<DeskMasks>(),
                         std::make_shared<ColorEncoder>());
    repeating.repeat(steps);
    for (const LiveStep& step : steps)
      if (step.kind == LiveStep::Kind::kFrame)
        repeating.push_and_wait(frames[static_cast<std::size_t>(step.frame)]);
    repeating.drain();
    Mapper again = repeating.take();
    EXPECT_EQ(steps_of(again), steps);
    expect_equal(again, first);
  }
}

TEST(LiveMapper, ForgetsItsStepsWhenFramesComeByAnotherWay) {
  LiveMapper live(mapper_config(1), live_config(1));
  live.push_and_wait(desk_frames()[0]);
  live.drain();
  Mapper mapper = live.take();
  EXPECT_EQ(steps_of(mapper), (std::vector<LiveStep>{{LiveStep::Kind::kFrame, 0}}));
  mapper.process(desk_frames()[1]);
  EXPECT_TRUE(steps_of(mapper).empty());
}

TEST(LiveMapper, BadMasksOfOneFrameAreCountedAndTheFrameStays) {
  auto masks = std::make_shared<SlowMasks>();
  masks->bad_frame = 0;
  LiveMapper mapper(mapper_config(1), live_config(1), masks);
  for (const Frame& frame : desk_frames()) mapper.push_and_wait(frame);
  mapper.drain();
  const LiveStatistics done = mapper.statistics();
  EXPECT_GE(done.masks_failed, 1);
  EXPECT_EQ(done.mask_fault, "mask of frame0 is 1x1, expected 160x120");
  EXPECT_EQ(done.frames_fused, done.frames_pushed);
}

TEST(LiveMapper, ABrokenMaskSourceEndsTheRunWithItsMessage) {
  auto masks = std::make_shared<DeskMasks>();
  masks->failing_frame = 0;
  LiveMapper mapper(mapper_config(1), live_config(1), masks);
  const std::string fault = error_of([&] {
    for (const Frame& frame : desk_frames()) mapper.push_and_wait(frame);
    mapper.drain();
  });
  EXPECT_EQ(fault, "mask source is broken");
}

/// Fails on its first batches, as one does that runs out of memory.
class FailingColors : public ColorEncoder {
 public:
  explicit FailingColors(int failures) : failures_(failures) {}
  Embeddings encode_images(std::span<const RgbImage> images) override {
    if (failures_-- > 0) throw std::runtime_error("out of memory");
    return ColorEncoder::encode_images(images);
  }

 private:
  int failures_;  // the encoder is asked by one thread
};

std::int64_t embedded_views(const SuperPointLooks& looks) {
  std::int64_t count = 0;
  for (const auto& [label, look] : looks)
    for (const ObjectView& view : look.views) count += view.embedding.size() > 0;
  return count;
}

TEST(LiveMapper, AnEncoderThatFailsIsCountedAndCostsItsViewsAlone) {
  constexpr int kAlways = 1000000;
  LiveConfig live = live_config(1);
  live.wait_for_masks = true;  // however slow the machine, there are objects to look at
  for (const int failures : {1, kAlways}) {
    LiveMapper mapper(mapper_config(1), live, std::make_shared<DeskMasks>(),
                      std::make_shared<FailingColors>(failures));
    for (const Frame& frame : desk_frames()) mapper.push_and_wait(frame);
    mapper.drain();
    const LiveStatistics done = mapper.statistics();
    EXPECT_EQ(done.frames_fused, done.frames_pushed);
    EXPECT_GT(done.views_failed, 0);
    EXPECT_EQ(done.encoder_fault, "out of memory");
    const SuperPointLooks found = mapper.take().take_looks();
    EXPECT_GT(found.size(), 0u);
    EXPECT_EQ(embedded_views(found) == 0, failures == kAlways);
  }
}

TEST(LiveMapper, CancelKeepsWhatWasFused) {
  LiveMapper mapper(mapper_config(1), live_config(1));
  for (const Frame& frame : desk_frames()) mapper.push(frame);
  mapper.cancel();
  const LiveStatistics done = mapper.statistics();
  EXPECT_LE(done.frames_fused, done.frames_pushed);
  EXPECT_FALSE(mapper.push(desk_frames().front())) << "nothing is taken any more";
  EXPECT_EQ(mapper.take().frames(), done.frames_fused);
}

TEST(LiveMapper, EndsWithoutADrain) {
  LiveMapper mapper(mapper_config(1), live_config(1), std::make_shared<SlowMasks>());
  for (const Frame& frame : desk_frames()) mapper.push(frame);
}

}  // namespace
}  // namespace ovimap
