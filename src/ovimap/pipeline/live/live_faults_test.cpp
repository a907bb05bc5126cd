// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Frames that are at fault themselves cost a live run no more than these frames.
#include <gtest/gtest.h>

#include <random>

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/pipeline/live/live_mapper.h"
#include "ovimap/pipeline/mapping/desk_fixture.h"

namespace ovimap {
namespace {

/// What a broken camera sends: each pixel somewhere else.
Frame with_noise(Frame frame) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> anywhere(1.f, 60.f);
  for (float& depth : frame.depth) depth = anywhere(random);
  return frame;
}

TEST(LiveFaults, AFrameOfNoiseIsLeftOut) {
  constexpr std::size_t kRoom = 40000000;  // bytes: enough for the desk
  const DeskScene scene;
  MapperConfig config;
  config.mask_interval = 2;
  config.free_space.enabled = false;  // else noise is known by what it sees through
  LiveConfig live;
  live.masks.rule = MaskRule::kInterval;
  live.masks.interval = 2;
  MapDocument begun;
  begun.map = VoxelMap(config.map);
  begun.map.set_room(kRoom);
  LiveMapper mapper(config, live, std::make_shared<DeskMasks>());
  mapper.restore(std::move(begun));
  for (std::int64_t i = 0; i < 6; ++i) {
    const Frame frame = *scene.read(i).frame;
    mapper.push_and_wait(i == 2 || i == 3 ? with_noise(frame) : frame);
  }
  mapper.drain();
  const LiveStatistics done = mapper.statistics();
  EXPECT_EQ(done.frames_fused, 4);
  EXPECT_EQ(done.frames_failed, 2);
  EXPECT_NE(done.frame_fault.find("its room"), std::string::npos) << done.frame_fault;
  EXPECT_EQ(mapper.frames().size(), 4u);
  const Mapper mapped = mapper.take();
  EXPECT_LE(mapped.map().blocks_in_memory() * VoxelBlock::kMostBytes, kRoom);
  EXPECT_EQ(mapped.frames(), 4);
}

}  // namespace
}  // namespace ovimap
