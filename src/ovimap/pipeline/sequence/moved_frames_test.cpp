// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/sequence/moved_frames.h"

#include <gtest/gtest.h>

#include "ovimap/pipeline/mapping/desk_fixture.h"
#include "ovimap/pipeline/sequence/sequence_run.h"

namespace ovimap {
namespace {

/// The desk with poses that drift away, ten frames a second.
class SlidingDesk : public DeskScene {
 public:
  FrameRead read(std::int64_t position) const override {
    FrameRead read = DeskScene::read(position);
    read.frame->timestamp_s = 100 + 0.1 * static_cast<double>(position);
    read.frame->world_from_camera.translation().x() += 0.01 * static_cast<double>(position);
    return read;
  }
};

MapperConfig keeping_frames() {
  MapperConfig config;
  config.frame_store.max_mb = 100;
  return config;
}

/// Blocks that hold something, and what.
std::map<std::uint64_t, std::vector<std::int16_t>> distances(const VoxelMap& map) {
  std::map<std::uint64_t, std::vector<std::int16_t>> result;
  for (std::uint32_t slot = 0; slot < map.block_count(); ++slot) {
    const VoxelBlock& block = map.block(slot);
    if (std::any_of(block.weight.begin(), block.weight.end(), [](float w) { return w > 0; }))
      result[pack_index(block.index)].assign(block.tsdf.begin(), block.tsdf.end());
  }
  return result;
}

class MovedFrames : public ::testing::Test {
 protected:
  MovedFrames() : done_(run_sequence(desk_, positions({}, desk_.size()), mapper_)) {}
  Pose truth(std::size_t frame) const {
    return DeskScene().read(static_cast<std::int64_t>(frame)).frame->world_from_camera;
  }
  double off_m(std::size_t frame) const {
    return (done_.frames[frame].world_from_camera.translation() - truth(frame).translation())
        .norm();
  }

  const SlidingDesk desk_;
  Mapper mapper_{keeping_frames(), std::make_shared<DeskMasks>()};
  SequenceResult done_;
};

TEST_F(MovedFrames, FollowNodesOfAnotherGraphByTheirTimes) {
  PoseUpdate update{true, {}};
  for (const std::size_t frame : {11, 0, 6})  // in any order
    update.nodes.push_back({100 + 0.1 * static_cast<double>(frame), truth(frame)});
  update.nodes.push_back({99, Pose::Identity()});   // before the first frame
  update.nodes.push_back({300, Pose::Identity()});  // not in the map yet
  const std::vector<MovedPose> moves = moves_of(update, done_.frames);
  ASSERT_EQ(moves.size(), 3u);
  const std::size_t objects = mapper_.registry().state().super_points.size();
  move_frames(moves, true, mapper_, done_.frames, done_.depth_camera);
  for (std::size_t i = 0; i < done_.frames.size(); ++i) EXPECT_LT(off_m(i), 1e-6) << i;
  EXPECT_EQ(mapper_.registry().state().super_points.size(), objects);
  EXPECT_EQ(mapper_.touched_blocks().size(), mapper_.map().block_count());
}

TEST_F(MovedFrames, ANodeBetweenTwoFramesIsHeldAgainstThePoseBetween) {
  PoseUpdate update{false, {{2.5, Pose::Identity()}}};
  const std::vector<MovedPose> moves = moves_of(update, done_.frames);
  ASSERT_EQ(moves.size(), 1u);
  const Eigen::Vector3d middle = (done_.frames[2].world_from_camera.translation() +
                                  done_.frames[3].world_from_camera.translation()) /
                                 2;
  EXPECT_LT((moves[0].before.translation() - middle).norm(), 1e-9);
}

/// The map is the one that the true poses would have made, of the frames as they were kept.
TEST_F(MovedFrames, TheMapIsThatOfTheNewPoses) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < done_.frames.size(); ++i) poses.push_back(truth(i));
  mapper_.fuse_again(poses, done_.depth_camera);
  VoxelMap straight;
  KeptFusion fusion(mapper_.config(), done_.depth_camera);
  for (const auto& [position, kept] : mapper_.kept_frames())
    fusion.fuse(*kept, poses[position], straight);
  EXPECT_EQ(distances(mapper_.map()), distances(straight));
}

/// Blocks that are being stored stay as they are meanwhile.
TEST_F(MovedFrames, FrozenBlocksKeepWhatTheyHad) {
  const std::vector<std::uint32_t> slots = mapper_.map().ordered_slots();
  const std::vector<const VoxelBlock*> frozen = mapper_.map().freeze(slots);
  const auto before = frozen.front()->weight;
  std::vector<Pose> poses(done_.frames.size(), Pose::Identity());
  mapper_.fuse_again(poses, done_.depth_camera);
  EXPECT_EQ(frozen.front()->weight, before);
  mapper_.map().thaw();
}

}  // namespace
}  // namespace ovimap
