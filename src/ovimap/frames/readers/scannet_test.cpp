// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/frames/readers/scannet_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

/// Eleven frames, so that names in alphabetical order (0, 1, 10, 2...) would be wrong.
class ScanNet : public testing::Test {
 protected:
  ScanNet() { fixture::write_scannet(folder_.path(), sequence_); }

  const fs::path& path() const { return folder_.path(); }
  std::string error() const {
    return error_of([&] { open_frame_source(path()); });
  }

  fixture::TemporaryFolder folder_;
  fixture::Sequence sequence_ = fixture::two_camera_sequence(11);
};

TEST_F(ScanNet, WrittenSequenceComesBack) {
  const auto source = open_frame_source(path());
  EXPECT_EQ(source->kind(), "scannet");
  ASSERT_EQ(source->size(), 11);
  for (int i : {0, 2, 10}) {
    const FrameRead read = source->read(i);
    ASSERT_TRUE(read.frame) << read.fault;
    EXPECT_EQ(read.frame->name, std::to_string(i));
    EXPECT_NEAR(read.frame->timestamp_s, i / 30.0, 1e-9);
    EXPECT_TRUE(read.frame->world_from_camera.isApprox(fixture::room_pose(i), 1e-12));
    const DepthImage truth = sequence_.depth(i);
    for (std::size_t p = 0; p < truth.size(); ++p)
      ASSERT_NEAR(read.frame->depth[p], truth[p], 0.00051);
  }
}

TEST_F(ScanNet, CamerasComeFromTheIntrinsicFolder) {
  const FrameRead read = open_frame_source(path())->read(3);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_EQ(read.frame->color_camera, sequence_.color_camera);
  EXPECT_EQ(read.frame->depth_camera, sequence_.depth_camera);
  EXPECT_TRUE(read.frame->color_from_depth.isApprox(sequence_.color_from_depth, 1e-9));
  EXPECT_FALSE(read.frame->registered());
}

TEST_F(ScanNet, ExtrinsicsMeetInOneFrame) {
  // The same relation between the cameras, written from a frame that is neither camera's.
  const Pose common_from_color = fixture::room_pose(7);
  const auto write = [&](const char* name, const Pose& pose) {
    write_text(path() / "intrinsic" / name, fixture::matrix_text(pose.matrix()));
  };
  write("extrinsic_color.txt", common_from_color);
  write("extrinsic_depth.txt", common_from_color * sequence_.color_from_depth);
  EXPECT_TRUE(open_frame_source(path())->read(0).frame->color_from_depth.isApprox(
      sequence_.color_from_depth, 1e-9));
  fs::remove(path() / "intrinsic" / "extrinsic_color.txt");
  fs::remove(path() / "intrinsic" / "extrinsic_depth.txt");
  EXPECT_TRUE(open_frame_source(path())->read(0).frame->color_from_depth.matrix().isIdentity());
}

TEST_F(ScanNet, TwoDimensionalAnnotationIsTheTruth) {
  EXPECT_FALSE(open_frame_source(path())->truth_ids(2));
  for (const char* part : {"instance", "instance-filt"}) {
    fs::create_directories(path() / part);
    IdImage ids = sequence_.ids(2);
    if (part == std::string("instance")) ids.fill(9);
    write_file(path() / part / "2.png", encode_png(ids));
  }
  const auto source = open_frame_source(path());
  EXPECT_EQ(source->truth_ids(2), sequence_.ids(2));
  EXPECT_FALSE(source->truth_ids(3));
}

TEST_F(ScanNet, LostAndIncompleteFramesAreFaults) {
  std::string lost;
  for (int i = 0; i < 16; ++i) lost += "-inf ";
  write_text(path() / "pose" / "4.txt", lost);
  fs::remove(path() / "depth" / "5.png");
  fs::remove(path() / "pose" / "6.txt");
  const auto source = open_frame_source(path());
  EXPECT_EQ(source->size(), 11);
  EXPECT_EQ(source->read(4).fault, "4.txt: has a bad pose (not finite)");
  EXPECT_EQ(source->read(5).fault, "5.png: is missing");
  EXPECT_EQ(source->read(6).fault, "6.txt: is missing");
  EXPECT_TRUE(source->read(7).frame.has_value());
}

TEST_F(ScanNet, CalibrationOverrides) {
  write_text(path() / "calibration.yaml",
             "depth_camera: {fx: 71, depth_scale: 500}\ncolor_camera: {fy: 150}");
  const FrameRead read = open_frame_source(path())->read(1);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_FLOAT_EQ(read.frame->depth_camera.fx, 71);
  EXPECT_FLOAT_EQ(read.frame->color_camera.fy, 150);
  EXPECT_NEAR(read.frame->depth.at(9, 9), 2 * sequence_.depth(1).at(9, 9), 0.0011);
}

TEST_F(ScanNet, BrokenDescriptionsAreNamed) {
  const fs::path cameras = path() / "intrinsic";
  write_text(cameras / "extrinsic_depth.txt", "1 2 3");
  EXPECT_NE(error().find("extrinsic_depth.txt does not hold a 4x4 matrix"), std::string::npos);
  write_text(cameras / "extrinsic_depth.txt", "2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  EXPECT_NE(error().find("extrinsic_depth.txt holds no rigid transform"), std::string::npos);
  write_text(cameras / "intrinsic_color.txt", "0 0 0 0 0 0 0 0 0 0 1 0 0 0 0 1");
  EXPECT_NE(error().find("intrinsic_color.txt: focal lengths are 0 and 0"), std::string::npos);
  fs::remove(cameras / "intrinsic_depth.txt");
  EXPECT_NE(error().find("intrinsic_depth.txt is missing"), std::string::npos);
  fixture::write_scannet(path(), sequence_);
  fs::remove_all(path() / "color");
  fs::create_directories(path() / "color");
  EXPECT_NE(error().find("holds no .jpg or .png image"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
