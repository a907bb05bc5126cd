// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

/// Frames 0 to 10, of which frame 0 has no pose, as in the published archives.
class IclNuim : public testing::Test {
 protected:
  IclNuim() {
    sequence_.frames = 11;
    sequence_.depth_units_per_m = 5000;
    fs::create_directories(path() / "rgb");
    fs::create_directories(path() / "depth");
    std::string poses;
    for (int i = 0; i < 11; ++i) {
      write_file(path() / "rgb" / concat(i, ".png"), encode_png(sequence_.color(i)));
      write_file(path() / "depth" / concat(i, ".png"), encode_png(sequence_.stored_depth(i)));
      if (i > 0) poses += concat(i, " ", fixture::tum_text(stored_pose(i).matrix()), "\n\n");
    }
    write_text(path() / "livingRoom0.gt.freiburg", poses);
    write_text(path() / "calibration.yaml", fixture::calibration_yaml(sequence_));
  }

  const fs::path& path() const { return folder_.path(); }

  /// The room's pose as the renderer's left-handed frames (y up in both) have it, axis by axis.
  static Pose stored_pose(int index) {
    const Pose ours = fixture::room_pose(index);
    Pose stored = ours;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        if ((row == 1) != (column == 1)) stored.linear()(row, column) = -ours.linear()(row, column);
    stored.translation().y() = -ours.translation().y();
    return stored;
  }
  std::string error() const {
    return error_of([&] { open_frame_source(path()); });
  }

  fixture::TemporaryFolder folder_;
  fixture::Sequence sequence_;
};

TEST_F(IclNuim, WrittenSequenceComesBackInNumericalOrder) {
  const auto source = open_frame_source(path());
  EXPECT_EQ(source->kind(), "icl-nuim");
  ASSERT_EQ(source->size(), 11);
  for (int i : {1, 2, 10}) {
    const FrameRead read = source->read(i);
    ASSERT_TRUE(read.frame) << read.fault;
    EXPECT_EQ(read.frame->name, std::to_string(i));
    EXPECT_TRUE(read.frame->world_from_camera.isApprox(fixture::room_pose(i), 1e-7)) << i;
    EXPECT_EQ(read.frame->color, sequence_.color(i));
    const DepthImage truth = sequence_.depth(i);
    for (std::size_t p = 0; p < truth.size(); ++p)
      ASSERT_NEAR(read.frame->depth[p], truth[p], 0.00011);
  }
}

TEST_F(IclNuim, PointsAreThePublishedOnesWithYTurnedOver) {
  const FrameRead read = open_frame_source(path())->read(6);
  ASSERT_TRUE(read.frame) << read.fault;
  const Frame& frame = *read.frame;
  for (const auto& [u, v] : {std::pair{5, 7}, std::pair{60, 44}, std::pair{33, 12}}) {
    const float z = frame.depth.at(u, v);
    // As the data set says it: fy is negative, y points up.
    const PinholeCamera& k = frame.depth_camera;
    const Eigen::Vector3d published =
        stored_pose(6) * Eigen::Vector3d((u - k.cx) / k.fx * z, (v - k.cy) / -k.fy * z, z);
    const Eigen::Vector3d ours =
        frame.world_from_camera * k.unproject(float(u), float(v), z).cast<double>();
    EXPECT_LT((ours - Eigen::Vector3d(published.x(), -published.y(), published.z())).norm(), 1e-5);
  }
}

TEST_F(IclNuim, DefaultCameraHasAPositiveFocalLength) {
  fs::remove(path() / "calibration.yaml");
  for (int i = 0; i < 11; ++i)
    write_file(path() / "depth" / concat(i, ".png"),
               encode_png(Image<std::uint16_t>(640, 480, 5000)));
  write_file(path() / "rgb" / "3.png", encode_png(RgbImage(640, 480)));
  const FrameRead read = open_frame_source(path())->read(3);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_EQ(read.frame->depth_camera, (PinholeCamera{640, 480, 481.2f, 480.f, 319.5f, 239.5f}));
  EXPECT_TRUE(read.frame->registered());
  EXPECT_FLOAT_EQ(read.frame->depth.at(3, 3), 1.f);
}

TEST_F(IclNuim, FramesWithoutPoseOrNumberAreFaults) {
  fs::copy_file(path() / "rgb" / "3.png", path() / "rgb" / "cover.png");
  const auto source = open_frame_source(path());
  EXPECT_EQ(source->size(), 12);
  EXPECT_EQ(source->read(0).fault, "0: has no pose");
  EXPECT_EQ(source->read(11).fault, "cover.png: is not named by a frame number");
}

TEST_F(IclNuim, BrokenDescriptionsAreNamed) {
  write_text(path() / "livingRoom0.gt.freiburg", "nothing");
  EXPECT_NE(error().find("livingRoom0.gt.freiburg holds no pose"), std::string::npos);
  fs::remove(path() / "livingRoom0.gt.freiburg");
  EXPECT_NE(error().find("no poses"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
