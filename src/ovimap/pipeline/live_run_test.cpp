// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/live_run.h"

#include <numeric>

#include <gtest/gtest.h>

#include "ovimap/pipeline/desk_fixture.h"

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

TEST(RunLive, SaysWhenNoFrameIsUsable) {
  DeskScene scene;
  scene.bad_frame = 0;
  LiveMapper mapper({}, {});
  EXPECT_THROW((void)run_live(scene, {0}, mapper, 100), Error);
}

}  // namespace
}  // namespace ovimap
