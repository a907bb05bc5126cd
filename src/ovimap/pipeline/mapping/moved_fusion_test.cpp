// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/moved_fusion.h"

#include <gtest/gtest.h>

#include <set>

#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace ovimap {
namespace {

/// A camera that goes round one desk, then round the next ones, 1.5 m apart: what two neighbours
/// show overlaps a little.
class ThreeDesks : public FrameSource {
 public:
  static constexpr std::int64_t kDesks = 3;
  std::string kind() const override { return "desks"; }
  std::int64_t size() const override { return kDesks * DeskScene::kFrames; }
  FrameRead read(std::int64_t position) const override {
    FrameRead read = desk_.read(position % DeskScene::kFrames);
    read.frame->index = position;
    read.frame->world_from_camera.translation().x() += 1.5 * static_cast<double>(desk_of(position));
    return read;
  }
  static std::int64_t desk_of(std::int64_t position) { return position / DeskScene::kFrames; }

 private:
  DeskScene desk_;
};

class ThreeDesksMasks : public MaskSource {
 public:
  std::string kind() const override { return "desks"; }
  std::optional<Entities> entities(const Frame& frame, std::span<const MaskPrompt>) override {
    return Entities{*desk_.truth_ids(frame.index % DeskScene::kFrames), {1.f, 1.f, 1.f}};
  }

 private:
  DeskScene desk_;
};

MapperConfig keeping() {
  MapperConfig config;
  config.frame_store.max_mb = 100;
  return config;
}

struct Mapped {
  Mapped() : sequence(run_sequence(ThreeDesks(), positions({}, ThreeDesks().size()), mapper)) {}
  std::vector<Pose> poses() const { return poses_of(sequence.frames); }

  Mapper mapper{keeping(), std::make_shared<ThreeDesksMasks>()};
  SequenceResult sequence;
};

/// The whole map, from all kept frames in order: the oracle of these tests.
void fuse_all(Mapped& mapped, const std::vector<Pose>& poses) {
  BlockChoice all(mapped.mapper.map().block_count());
  for (std::uint32_t slot = 0; slot < mapped.mapper.map().block_count(); ++slot) all.add(slot);
  mapped.mapper.map().empty_blocks(all);
  KeptFusion fusion(mapped.mapper.config(), mapped.sequence.depth_camera);
  for (const auto& [position, kept] : mapped.mapper.kept_frames())
    fusion.fuse(*kept, poses[position], mapped.mapper.map());
}

FusedAgain fuse_moved(Mapped& mapped, const KeptFrames& kept, const std::vector<Pose>& before,
                      const std::vector<Pose>& after) {
  return fuse_moved(mapped.mapper.map(), kept, change_of(before, after, 1e-9, 1.),
                    mapped.mapper.config(), mapped.sequence.depth_camera);
}

/// The frames of the last desk stand elsewhere, one of them far off.
std::vector<Pose> last_desk_moved(std::vector<Pose> poses) {
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (ThreeDesks::desk_of(static_cast<std::int64_t>(i)) == 2)
      poses[i].pretranslate(Eigen::Vector3d(0.02, 0.01 * static_cast<double>(i % 3), 0.01));
  poses[30].pretranslate(Eigen::Vector3d(0., 0., 0.12));
  return poses;
}

std::size_t doubted_blocks(const VoxelMap& map) {
  std::size_t count = 0;
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot) count += map.block(slot).doubted();
  return count;
}

TEST(MovedFusion, MakesWhatFusingEverythingAgainWouldMake) {
  Mapped incremental, whole;
  const std::vector<Pose> before = whole.poses(), after = last_desk_moved(before);
  for (Mapped* mapped : {&incremental, &whole}) fuse_all(*mapped, before);
  ASSERT_EQ(incremental.mapper.map().content_hash(), whole.mapper.map().content_hash());
  const FusedAgain done = fuse_moved(incremental, incremental.mapper.kept_frames(), before, after);
  fuse_all(whole, after);
  EXPECT_EQ(incremental.mapper.map().content_hash(), whole.mapper.map().content_hash());
  EXPECT_GT(doubted_blocks(whole.mapper.map()), 0u) << "no frame sees through anything";
  EXPECT_EQ(done.moved, 12u);
  EXPECT_LT(done.frames, 36u);
  EXPECT_LT(2 * done.slots.size(), incremental.mapper.map().block_count());
  // And back: what a frame left behind from where it was is gone.
  fuse_moved(incremental, incremental.mapper.kept_frames(), after, before);
  fuse_all(whole, before);
  EXPECT_EQ(incremental.mapper.map().content_hash(), whole.mapper.map().content_hash());
}

TEST(MovedFusion, WhatNoMovedFrameTouchesStaysBitForBit) {
  Mapped mapped;
  const VoxelMap& map = mapped.mapper.map();
  std::vector<VoxelBlock> blocks;
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot) blocks.push_back(map.block(slot));
  const FusedAgain done = fuse_moved(mapped, mapped.mapper.kept_frames(), mapped.poses(),
                                     last_desk_moved(mapped.poses()));
  const std::set<std::uint32_t> anew(done.slots.begin(), done.slots.end());
  std::size_t changed = 0;
  for (std::uint32_t slot = 0; slot < blocks.size(); ++slot) {
    const VoxelBlock &was = blocks[slot], &is = map.block(slot);
    const bool same = was.tsdf == is.tsdf && was.weight == is.weight && was.color == is.color &&
                      was.slots == is.slots && was.palette == is.palette && was.doubts == is.doubts;
    EXPECT_TRUE(same || anew.contains(slot)) << slot;
    changed += !same;
  }
  EXPECT_GT(changed, 100u);
  EXPECT_LT(anew.size(), map.block_count() / 2);
}

/// Every second frame is not kept; from where those were nothing may be left.
TEST(MovedFusion, FramesThatAreNotKeptLeaveNothingBehind) {
  Mapped mapped;
  KeptFrames kept = mapped.mapper.kept_frames();
  std::erase_if(kept, [](const auto& frame) { return frame.first % 2 != 0; });
  std::vector<Pose> after = mapped.poses();
  for (std::size_t i = 24; i < after.size(); ++i) after[i].pretranslate(Eigen::Vector3d(3, 0, 0));
  fuse_moved(mapped, kept, mapped.poses(), after);
  const VoxelMap& map = mapped.mapper.map();
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot) {
    const float x = static_cast<float>(map.block_index(slot).x()) * map.config().block_size_m();
    if (x < 2.5f || x > 3.5f) continue;  // where the last desk was, and nothing else
    for (const float weight : map.block(slot).weight) ASSERT_EQ(weight, 0.f) << x;
  }
}

TEST(MovedFusion, FramesThatHardlyMovedStayUntilItAddsUp) {
  Mapped mapped;
  const std::uint64_t hash = mapped.mapper.map().content_hash();
  std::vector<Pose> poses = mapped.poses();
  const auto move = [&] {
    for (Pose& pose : poses) pose.translation().x() += 0.003;
    return mapped.mapper.fuse_again(poses, mapped.sequence.depth_camera).moved;
  };
  EXPECT_EQ(move(), 0u);
  EXPECT_EQ(mapped.mapper.map().content_hash(), hash);
  EXPECT_EQ(mapped.mapper.touched_blocks().size(), 0u);
  EXPECT_EQ(move(), poses.size());
  EXPECT_NE(mapped.mapper.map().content_hash(), hash);
}

TEST(MovedFusion, ATurnCountsByWhatItMoves) {
  const std::vector<Pose> before(1, Pose::Identity());
  std::vector<Pose> after = before;
  after[0].linear() = Eigen::AngleAxisd(0.002, Eigen::Vector3d::UnitY()).matrix();
  EXPECT_EQ(change_of(before, after, 0.005, 2.).moved[0], 0);
  EXPECT_EQ(change_of(before, after, 0.005, 3.).moved[0], 1);
}

}  // namespace
}  // namespace ovimap
