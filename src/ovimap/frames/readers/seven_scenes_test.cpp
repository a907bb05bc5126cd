// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/frames/frame/registration.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

TEST(SevenScenes, WrittenSequenceComesBack) {
  const fixture::TemporaryFolder folder;
  fixture::Sequence sequence;
  sequence.frames = 3;
  sequence.color_camera = {100, 70, 90.f, 88.f, 50.f, 34.f};
  sequence.color_from_depth.translation() = Eigen::Vector3d(0.05, 0.01, 0);
  fixture::write_seven_scenes(folder.path(), sequence);
  const auto source = open_frame_source(folder.path());
  EXPECT_EQ(source->kind(), "7scenes");
  ASSERT_EQ(source->size(), 3);
  const FrameRead read = source->read(2);
  ASSERT_TRUE(read.frame) << read.fault;
  const Frame& frame = *read.frame;
  EXPECT_EQ(frame.index, 2);
  EXPECT_EQ(frame.name, "frame-000002.color");
  EXPECT_EQ(frame.color, sequence.color(2));
  EXPECT_EQ(frame.color_camera, sequence.color_camera);
  EXPECT_EQ(frame.depth_camera, sequence.depth_camera);
  EXPECT_TRUE(frame.color_from_depth.isApprox(sequence.color_from_depth, 1e-6));
  EXPECT_TRUE(frame.world_from_camera.isApprox(fixture::room_pose(2), 1e-12));
  const DepthImage truth = sequence.depth(2);
  for (std::size_t i = 0; i < truth.size(); ++i) ASSERT_NEAR(frame.depth[i], truth[i], 0.00051);
  EXPECT_FALSE(source->truth_ids(0).has_value());
}

TEST(SevenScenes, FramesAreOrderedByNumberAndGapsAreKept) {
  const fixture::TemporaryFolder folder;
  fixture::Sequence sequence;
  sequence.frames = 1;
  fixture::write_seven_scenes(folder.path(), sequence);
  for (const char* stem : {"frame-000100", "frame-000020"})
    for (const char* ending : {".color.png", ".depth.png", ".pose.txt"})
      std::filesystem::copy(folder.path() / (std::string("frame-000000") + ending),
                            folder.path() / (std::string(stem) + ending));
  write_text(folder.path() / "frame-000030.notes.txt", "not a frame");
  const auto source = open_frame_source(folder.path());
  ASSERT_EQ(source->size(), 3);
  EXPECT_EQ(source->read(1).frame->name, "frame-000020.color");
  EXPECT_EQ(source->read(2).frame->name, "frame-000100.color");
  EXPECT_LT(source->read(1).frame->timestamp_s, source->read(2).frame->timestamp_s);
}

TEST(SevenScenes, CamerasAreThePublishedOnesWithoutACalibration) {
  const fixture::TemporaryFolder folder;
  fixture::Sequence sequence;
  sequence.frames = 1;
  sequence.depth_camera = sequence.color_camera = {640, 480, 585.f, 585.f, 320.f, 240.f};
  fixture::write_seven_scenes(folder.path(), sequence);
  std::filesystem::remove(folder.path() / "calibration.yaml");
  const FrameRead read = open_frame_source(folder.path())->read(0);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_EQ(read.frame->depth_camera, sequence.depth_camera);
  EXPECT_TRUE(read.frame->registered());
}

TEST(SevenScenes, KitchenIsRead) {
  const std::filesystem::path kitchen = OVIMAP_SOURCE_DIR "/../shared/data/kitchen";
  if (!std::filesystem::exists(kitchen)) GTEST_SKIP() << "no kitchen recording at " << kitchen;
  const auto source = open_frame_source(kitchen);
  EXPECT_EQ(source->kind(), "7scenes");
  ASSERT_EQ(source->size(), 200);
  const FrameRead read = source->read(20);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_EQ(read.frame->name, "frame-000100.color");
  EXPECT_FLOAT_EQ(read.frame->color_camera.fx, 531.1f);
  EXPECT_NEAR(read.frame->color_from_depth.translation().x(), -0.024, 1e-9);
  EXPECT_FALSE(read.frame->registered());
  // Nearly every depth pixel of a Kinect frame has a colour.
  const Registration registration(*read.frame);
  std::size_t valid = 0, colored = 0;
  for (std::size_t i = 0; i < read.frame->depth.size(); ++i) {
    valid += read.frame->depth[i] > 0 ? 1 : 0;
    colored += registration.color_index()[i] >= 0 ? 1 : 0;
  }
  EXPECT_GT(valid, 200000u);
  EXPECT_GT(colored, valid * 95 / 100);
}

}  // namespace
}  // namespace ovimap
