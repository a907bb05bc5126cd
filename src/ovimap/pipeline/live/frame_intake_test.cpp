// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/frame_intake.h"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/recording/sequence_fixture.h"
#include "ovimap/pipeline/live/live_run.h"

namespace ovimap {
namespace {

using Answer = FrameIntake::Answer;
using std::chrono::milliseconds;

Frame frame_of(const fixture::Sequence& sequence, int index) {
  Frame frame;
  frame.color_camera = frame.depth_camera = sequence.depth_camera;
  frame.color = sequence.color(index);
  frame.depth = sequence.depth(index);
  frame.world_from_camera = fixture::room_pose(index);
  return frame;
}

TEST(FrameIntake, CountsWhatDoesNotFit) {
  FrameIntake intake(2);
  intake.resume_at(7, {});
  Frame named;
  named.name = "mine";
  EXPECT_EQ(intake.offer({}), Answer::kTaken);
  EXPECT_EQ(intake.offer(named), Answer::kTaken);
  EXPECT_EQ(intake.offer({}), Answer::kFull);
  EXPECT_EQ(intake.counts().taken, 2);
  EXPECT_EQ(intake.counts().skipped, 1);
  EXPECT_EQ(intake.counts().waiting, 2);
  EXPECT_EQ(intake.next(milliseconds(0))->name, "frame000007");
  EXPECT_EQ(intake.offer({}), Answer::kTaken);
  EXPECT_EQ(intake.next(milliseconds(0))->name, "mine");
  EXPECT_EQ(intake.next(milliseconds(0))->index, 9);
  EXPECT_FALSE(intake.next(milliseconds(0)));
}

TEST(FrameIntake, AResumedRunGoesOnWithItsCamera) {
  Frame mine, other;
  mine.depth_camera = {640, 480, 500.f, 500.f, 320.f, 240.f};
  other.depth_camera = {320, 240, 250.f, 250.f, 160.f, 120.f};
  FrameIntake intake(4);
  EXPECT_EQ(intake.offer(mine), Answer::kTaken);
  EXPECT_EQ(intake.offer(other), Answer::kOtherCamera);
  FrameIntake early(4);  // frames come while the run is still read
  EXPECT_EQ(early.offer(other), Answer::kTaken);
  early.resume_at(20, mine.depth_camera);
  EXPECT_EQ(early.counts().taken, 0);
  EXPECT_EQ(early.counts().skipped, 1);
  EXPECT_EQ(early.offer(other), Answer::kOtherCamera);
  EXPECT_EQ(early.offer(mine), Answer::kTaken);
  EXPECT_EQ(early.next(milliseconds(0))->index, 20);
}

TEST(FrameIntake, CountsAFrameThatIsOfferedAgainOnce) {
  FrameIntake intake(1);
  using Offer = FrameIntake::Offer;
  EXPECT_EQ(intake.room(Offer::kFirst), Answer::kTaken);
  EXPECT_EQ(intake.offer({}), Answer::kTaken);
  EXPECT_EQ(intake.offer({}), Answer::kFull);
  EXPECT_EQ(intake.offer({}, Offer::kAgain), Answer::kFull);
  EXPECT_EQ(intake.room(Offer::kAgain), Answer::kFull);
  EXPECT_EQ(intake.counts().skipped, 1);
  EXPECT_TRUE(intake.next(milliseconds(0)));
  EXPECT_EQ(intake.offer({}, Offer::kAgain), Answer::kTaken);
  EXPECT_EQ(intake.counts().skipped, 0) << "it was not left out after all";
  EXPECT_EQ(intake.room(Offer::kFirst), Answer::kFull);
  EXPECT_EQ(intake.counts().skipped, 1);
}

TEST(FrameIntake, HandsOutWhatWaitsOnceItIsFinished) {
  FrameIntake intake(4);
  intake.offer({});
  intake.finish();
  EXPECT_EQ(intake.offer({}), Answer::kEnded);
  EXPECT_FALSE(intake.ended());
  EXPECT_TRUE(intake.next(milliseconds(0)));
  EXPECT_TRUE(intake.ended());
  EXPECT_FALSE(intake.next(std::chrono::hours(1))) << "nobody need wait any more";
}

TEST(FrameIntake, ACorrectionOfPosesWaitsForTheFramesBeforeIt) {
  FrameIntake intake(4);
  intake.offer(Frame());
  EXPECT_TRUE(intake.correct(PoseUpdate{false, {{1, Pose::Identity()}}}));
  EXPECT_TRUE(intake.correct(PoseUpdate{false, {{2, Pose::Identity()}}})) << "instead of the first";
  intake.offer(Frame());
  EXPECT_FALSE(intake.next_update());
  EXPECT_TRUE(intake.next(milliseconds(0)));
  EXPECT_FALSE(intake.next(std::chrono::hours(1))) << "the correction comes first";
  intake.finish();
  EXPECT_EQ(intake.next_update()->nodes[0].at, 2);
  EXPECT_FALSE(intake.next_update());
  EXPECT_FALSE(intake.ended());
  EXPECT_TRUE(intake.next(milliseconds(0)));
  EXPECT_TRUE(intake.ended());
  EXPECT_FALSE(intake.correct(PoseUpdate()));
}

/// Frames come with poses that are off to one side, then the graph says where they are: the frames
/// sent until then, and the map, move there.
TEST(FrameIntake, CorrectedPosesMoveTheMap) {
  const fixture::Sequence sequence;
  MapperConfig config;
  config.frame_store.max_mb = 100;
  FrameIntake intake(100);
  PoseUpdate update;
  for (int i = 0; i < sequence.frames; ++i) {
    Frame frame = frame_of(sequence, i);
    if (i < sequence.frames - 1) {
      update.nodes.push_back({static_cast<double>(i), frame.world_from_camera});
      frame.world_from_camera.translation().x() += 0.1;
    }
    if (i == sequence.frames - 1) intake.correct(std::move(update));
    intake.offer(std::move(frame));
  }
  intake.finish();
  LiveMapper live(config, {});
  std::size_t shown = 0;
  live.after_frame = [&](Mapper& mapper, const auto&, const PinholeCamera&) {
    shown = std::max(shown, mapper.touched_blocks().size());
  };
  const LiveRunResult result = run_pushed(intake, live);
  EXPECT_EQ(result.statistics.pose_updates, 1);
  for (const FrameLogEntry& frame : result.sequence.frames)
    EXPECT_TRUE(
        frame.world_from_camera.isApprox(fixture::room_pose(static_cast<int>(frame.index)), 1e-9))
        << frame.index;
  const Mapper made = live.take();
  EXPECT_GT(shown, made.map().block_count() * 9 / 10) << "whoever shows the map hears of all";
}

TEST(FrameIntake, APauseIsTold) {
  const fixture::Sequence sequence;
  FrameIntake intake(3);
  LiveMapper live({}, {});
  std::atomic<std::size_t> seen = 0;
  live.while_waiting = [&](Mapper& mapper, const auto& frames, const PinholeCamera&) {
    EXPECT_EQ(static_cast<std::size_t>(mapper.frames()), frames.size());
    seen = frames.size();
  };
  std::thread camera([&] {
    for (int i = 0; i < 2; ++i) {
      intake.offer(frame_of(sequence, i));
      while (seen != static_cast<std::size_t>(i + 1)) std::this_thread::sleep_for(milliseconds(1));
    }
    intake.finish();
  });
  (void)run_pushed(intake, live);
  camera.join();
}

TEST(FrameIntake, PushedFramesMapAsMapperDoes) {
  const fixture::Sequence sequence;
  MapperConfig config;
  Mapper direct(config);
  for (int i = 0; i < sequence.frames; ++i) {
    Frame frame = frame_of(sequence, i);
    frame.index = i;
    direct.process(frame);
  }
  FrameIntake intake(3);
  LiveMapper live(config, {});
  std::thread camera([&] {
    for (int i = 0; i < sequence.frames; ++i)
      while (intake.offer(frame_of(sequence, i)) == Answer::kFull)
        std::this_thread::sleep_for(milliseconds(1));
    intake.finish();
  });
  const LiveRunResult result = run_pushed(intake, live);
  camera.join();
  EXPECT_EQ(result.sequence.frames.size(), static_cast<std::size_t>(sequence.frames));
  EXPECT_EQ(result.statistics.frames_dropped, intake.counts().skipped);
  EXPECT_EQ(result.sequence.frames[5].index, 5);
  Mapper made = live.take();
  EXPECT_EQ(made.map().content_hash(), direct.map().content_hash());
}

TEST(FrameIntake, WithoutFramesThereIsNoMap) {
  FrameIntake intake(3);
  intake.finish();
  LiveMapper live(MapperConfig{}, {});
  const std::string fault = error_of([&] { run_pushed(intake, live); });
  EXPECT_NE(fault.find("no frame"), std::string::npos) << fault;
}

TEST(FrameIntake, ListsFramesOfWhichAFilterLeavesNothing) {
  const fixture::Sequence sequence;
  const auto pushed = [&](std::int64_t every) {
    FrameIntake intake(8);
    for (int i = 0; i < 8; ++i) intake.offer(frame_of(sequence, i));
    intake.finish();
    LiveMapper live(MapperConfig{}, {});
    return run_pushed(intake, live, nullptr, [every](Frame frame) {
      return frame.index % every == 0 ? FrameRead{std::nullopt, frame.name + ": is void"}
                                      : FrameRead{std::move(frame), ""};
    });
  };
  const LiveRunResult some = pushed(3);
  EXPECT_EQ(some.sequence.frames.size(), 5u);
  ASSERT_EQ(some.sequence.skipped.size(), 3u);
  EXPECT_EQ(some.sequence.skipped[1].position, 3);
  EXPECT_NE(some.sequence.skipped[1].fault.find(": is void"), std::string::npos);
  const std::string fault = error_of([&] { pushed(1); });
  EXPECT_NE(fault.find("none of the frames is usable"), std::string::npos) << fault;
}

TEST(FrameIntake, ShowsTheFirstFramesAndKeepsThem) {
  FrameIntake intake(3);
  intake.resume_at(20, std::nullopt);
  EXPECT_FALSE(intake.peek(2, milliseconds(0))) << "none came yet";
  Frame frame;
  for (const double time : {0.1, 0.2}) {
    frame.timestamp_s = time;
    intake.offer(frame);
  }
  ASSERT_EQ(intake.peek(2, milliseconds(0))->size(), 2u);
  EXPECT_DOUBLE_EQ(intake.peek(1, milliseconds(0))->front().timestamp_s, 0.1);
  EXPECT_FALSE(intake.peek(16, milliseconds(0))) << "one more may wait";
  intake.finish();
  EXPECT_EQ(intake.peek(16, milliseconds(0))->size(), 2u) << "no more come";
  EXPECT_EQ(intake.next(milliseconds(0))->index, 20);
}

TEST(FrameIntake, EndsWhenItIsTold) {
  const fixture::Sequence sequence;
  FrameIntake intake(3);
  LiveMapper live(MapperConfig{}, {});
  for (int i = 0; i < 2; ++i) intake.offer(frame_of(sequence, i));
  int looks = 0;
  const auto result = run_pushed(
      intake, live, [&](std::size_t done, std::size_t) { return done < 2 || ++looks < 2; });
  EXPECT_EQ(result.sequence.frames.size(), 2u);
  EXPECT_EQ(intake.offer({}), Answer::kEnded) << "who pushes hears of it";
}

}  // namespace
}  // namespace ovimap
