// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live/live_run.h"

#include <numeric>

#include <gtest/gtest.h>

#include "ovimap/pipeline/mapping/desk_fixture.h"

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
  try {
    (void)run_live(source, positions, mapper, 200);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
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

}  // namespace
}  // namespace ovimap
