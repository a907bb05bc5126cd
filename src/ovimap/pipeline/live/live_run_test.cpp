// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/live_run.h"

#include <memory>
#include <numeric>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/sequence/pose_finder.h"

namespace ovimap {
namespace {

std::vector<std::int64_t> all_positions() {
  std::vector<std::int64_t> positions(DeskScene::kFrames);
  std::iota(positions.begin(), positions.end(), 0);
  return positions;
}

TEST(RunLive, KeepsTheCamerasPace) {
  const DeskScene scene;
  LiveMapper mapper({}, {});
  const LiveRunResult result = run_live(scene, all_positions(), mapper, 100);
  EXPECT_GE(result.sequence.seconds, (DeskScene::kFrames - 1) / 100.);
  EXPECT_EQ(result.statistics.frames_pushed, DeskScene::kFrames);
  EXPECT_EQ(result.sequence.frames.size(),
            static_cast<std::size_t>(result.statistics.frames_fused));
  EXPECT_EQ(result.sequence.depth_camera.width, 160);
}

TEST(RunLive, ListsFramesThatCannotBeRead) {
  DeskScene scene;
  scene.bad_frame = 3;
  LiveMapper mapper({}, {});
  const LiveRunResult result = run_live(scene, all_positions(), mapper, 200);
  ASSERT_EQ(result.sequence.skipped.size(), 1u);
  EXPECT_EQ(result.sequence.skipped[0].position, 3);
  EXPECT_EQ(result.sequence.skipped[0].fault, "pose is not finite");
}

TEST(RunLive, StopsWhenTold) {
  const DeskScene scene;
  LiveMapper mapper({}, {});
  const LiveRunResult result = run_live(scene, all_positions(), mapper, 200,
                                        [](std::size_t done, std::size_t) { return done < 4; });
  EXPECT_EQ(result.statistics.frames_pushed, 4);
}

std::string failure_of(const FrameSource& source, const std::vector<std::int64_t>& positions,
                       std::shared_ptr<MaskSource> masks = nullptr) {
  LiveMapper mapper({}, {}, std::move(masks));
  return error_of([&] { (void)run_live(source, positions, mapper, 200); });
}

TEST(RunLive, SaysWhenNoFrameIsUsable) {
  DeskScene scene;
  scene.bad_frame = 0;
  EXPECT_NE(failure_of(scene, {0}).find("pose is not finite"), std::string::npos);
}

TEST(RunLive, RefusesPosesThatNeverChange) {
  EXPECT_NE(failure_of(DeskScene(), {3, 3, 3}).find("same pose"), std::string::npos);
}

class WrongMasks : public DeskMasks {
 public:
  std::optional<Entities> entities(const Frame&, std::span<const MaskPrompt>) override {
    throw FrameError("frame0.png: is 1x1, expected 160x120");
  }
};

TEST(RunLive, SaysWhenNoFrameHasGoodMasks) {
  EXPECT_EQ(failure_of(DeskScene(), all_positions(), std::make_shared<WrongMasks>()),
            "frame0.png: is 1x1, expected 160x120");
}

std::string repeat_failure(const FrameSource& source, const std::vector<LiveStep>& steps,
                           bool tracked = false) {
  LiveMapper mapper({}, {});
  return error_of([&] {
    require_repeatable(steps, tracked);
    (void)repeat_live(source, steps, mapper);
  });
}

TEST(RepeatLive, TakesTheFramesThatTheRunTook) {
  const DeskScene scene;
  LiveMapper mapper({}, {});
  const LiveRunResult result =
      repeat_live(scene, {{LiveStep::Kind::kFrame, 4}, {LiveStep::Kind::kFrame, 7}}, mapper);
  ASSERT_EQ(result.sequence.frames.size(), 2u);
  EXPECT_EQ(result.sequence.frames[0].index, 4);
  EXPECT_EQ(result.sequence.frames[1].index, 7);
}

TEST(RepeatLive, SaysWhatCannotBeRepeated) {
  using Kind = LiveStep::Kind;
  const LiveStep frame{Kind::kFrame, 1}, resumed{Kind::kResumed}, moved{Kind::kMoved};
  DeskScene scene;
  const auto refuses = [&](const std::vector<LiveStep>& steps, const char* why,
                           bool tracked = false) {
    const std::string failure = repeat_failure(scene, steps, tracked);
    EXPECT_NE(failure.find(why), std::string::npos) << failure;
  };
  refuses({}, "does not say");
  refuses({resumed, frame}, "map of another run");
  refuses({frame, moved}, "corrected from outside");
  refuses({frame, resumed, frame}, "was resumed", true);
  refuses({frame, {Kind::kFrame, 1000}}, "frame 1000");
  scene.bad_frame = 1;
  refuses({frame}, "pose is not finite");
}

class BrokenSource : public DeskScene {
 public:
  FrameRead read(std::int64_t position) const override {
    if (position == 2) throw Error("the disk is gone");
    return DeskScene::read(position);
  }
};

TEST(RunLive, CarriesOutWhatReadingThrows) {
  EXPECT_EQ(failure_of(BrokenSource(), all_positions()), "the disk is gone");
}

/// A camera that is lost for good, while its frames go on coming.
TEST(RunLive, WhileTheCameraIsLostWhoeverWatchesIsTold) {
  const DeskScene scene;
  MapperConfig config;
  config.map.voxel_size_m = 0.02f;
  LiveMapper mapper(config, {});
  mapper.track_with(std::make_shared<PoseFinder>(Tracker(TrackConfig{}), LoopConfig{}));
  std::size_t told = 0;
  mapper.while_waiting = [&](Mapper&, const auto& frames, const PinholeCamera&) {
    told = frames.size();
  };
  Frame frame = *scene.read(0).frame;
  mapper.push_and_wait(frame);
  for (const float far_m : {5.f, 5.f}) {  // nothing that the map knows
    for (float& depth : frame.depth) depth = far_m;
    mapper.push_and_wait(frame);
  }
  mapper.drain();
  EXPECT_EQ(mapper.statistics().frames_lost, 2);
  EXPECT_EQ(told, 1u);
}

}  // namespace
}  // namespace ovimap
