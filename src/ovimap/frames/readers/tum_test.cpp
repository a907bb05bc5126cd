// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

class Tum : public testing::Test {
 protected:
  Tum() {
    sequence_.frames = 4;
    sequence_.depth_units_per_m = 5000;
    fixture::write_tum(folder_.path(), sequence_);
  }
  std::string error() const {
    return error_of([&] { open_frame_source(folder_.path()); });
  }

  fixture::TemporaryFolder folder_;
  fixture::Sequence sequence_;
};

TEST_F(Tum, WrittenSequenceComesBack) {
  const auto source = open_frame_source(folder_.path());
  EXPECT_EQ(source->kind(), "tum");
  ASSERT_EQ(source->size(), 4);
  const FrameRead read = source->read(2);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_NEAR(read.frame->timestamp_s, 1305031102.166, 1e-6);
  EXPECT_EQ(read.frame->color, sequence_.color(2));
  EXPECT_TRUE(read.frame->world_from_camera.isApprox(fixture::room_pose(2), 1e-7));
  const DepthImage truth = sequence_.depth(2);
  for (std::size_t i = 0; i < truth.size(); ++i)
    ASSERT_NEAR(read.frame->depth[i], truth[i], 0.00011);
}

TEST_F(Tum, DefaultsAreThePublishedCamera) {
  std::filesystem::remove(folder_.path() / "calibration.yaml");
  EXPECT_NE(open_frame_source(folder_.path())->read(0).fault.find("is 80x60, expected 640x480"),
            std::string::npos);
}

TEST_F(Tum, EachImageIsUsedOnceAndTheNearestWins) {
  // Two depth images near the second colour image (1305031102.133): 10 ms and 3 ms away.
  write_text(folder_.path() / "depth.txt",
             "1305031102.143 depth/far.png\n1305031102.136 depth/near.png\n");
  write_file(folder_.path() / "depth" / "near.png", encode_png(Image<std::uint16_t>(80, 60, 5000)));
  const auto source = open_frame_source(folder_.path());
  ASSERT_EQ(source->size(), 1);
  const FrameRead read = source->read(0);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_FLOAT_EQ(read.frame->depth.at(3, 3), 1.f);
}

TEST_F(Tum, FrameWithoutAPoseInReachIsAFault) {
  const Eigen::Matrix4d pose = sequence_.pose(0);
  write_text(folder_.path() / "groundtruth.txt", "1305031102.112 " + fixture::tum_text(pose));
  const auto source = open_frame_source(folder_.path());
  ASSERT_EQ(source->size(), 4);
  EXPECT_TRUE(source->read(0).frame.has_value());
  EXPECT_EQ(source->read(3).fault, "1305031102.199: has no pose");
  FrameSourceConfig wide;
  wide.max_time_gap_s = 0.2f;
  EXPECT_TRUE(open_frame_source(folder_.path(), wide)->read(3).frame.has_value());
}

TEST_F(Tum, BrokenListsAreNamed) {
  write_text(folder_.path() / "rgb.txt", "1305031102.1 rgb/a.png\nnonsense\n");
  EXPECT_NE(error().find("rgb.txt line 2 is 'nonsense'"), std::string::npos);
  write_text(folder_.path() / "rgb.txt", "nan rgb/a.png\n");
  EXPECT_NE(error().find("rgb.txt line 1 is 'nan rgb/a.png'"), std::string::npos);
  for (const char* elsewhere : {"../a.png", "/tmp/a.png", "rgb/../../a.png"}) {
    write_text(folder_.path() / "rgb.txt", std::string("5.0 ") + elsewhere + "\n");
    EXPECT_NE(error().find("which is not in the recording"), std::string::npos) << elsewhere;
  }
  write_text(folder_.path() / "rgb.txt", "5.0 rgb/a.png\n");
  EXPECT_NE(error().find("within 0.02 s"), std::string::npos);
  std::filesystem::remove(folder_.path() / "groundtruth.txt");
  EXPECT_NE(error().find("groundtruth.txt"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
