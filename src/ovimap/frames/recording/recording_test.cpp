// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/recording.h"

#include <limits>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

/// A written sequence of three frames, of which tests damage frame 1.
class RecordingTest : public testing::Test {
 protected:
  RecordingTest() {
    sequence_.frames = 3;
    fixture::write_seven_scenes(folder_.path(), sequence_);
  }

  std::filesystem::path file(const std::string& ending) const {
    return folder_.path() / ("frame-000001." + ending);
  }
  void truncate(const std::string& ending) {
    Bytes bytes = read_file(file(ending));
    bytes.resize(bytes.size() / 2);
    write_file(file(ending), bytes);
  }

  /// The fault of frame 1, after checking that its neighbours are still read.
  std::string fault(const FrameSourceConfig& config = {}) {
    const auto source = open_frame_source(folder_.path(), config);
    EXPECT_EQ(source->size(), 3);
    EXPECT_TRUE(source->read(0).frame.has_value());
    EXPECT_TRUE(source->read(2).frame.has_value());
    const FrameRead read = source->read(1);
    EXPECT_NE(read.frame.has_value(), !read.fault.empty());
    return read.fault;
  }

  fixture::TemporaryFolder folder_;
  fixture::Sequence sequence_;
};

TEST_F(RecordingTest, GoodFrameHasNoFault) {
  EXPECT_EQ(fault(), "");
}

TEST_F(RecordingTest, MissingFilesAreNamed) {
  std::filesystem::remove(file("color.png"));
  EXPECT_EQ(fault(), "frame-000001.color.jpg: is missing");
  std::filesystem::remove(file("depth.png"));
  EXPECT_EQ(fault(), "frame-000001.depth.png: is missing");
  std::filesystem::remove(file("pose.txt"));
  write_text(file("depth.png"), "");
  EXPECT_EQ(fault(), "frame-000001.pose.txt: is missing");
}

TEST_F(RecordingTest, BrokenImagesAreNamed) {
  truncate("color.png");
  EXPECT_EQ(fault(), "frame-000001.color.png: is a truncated PNG");
  truncate("depth.png");
  EXPECT_EQ(fault(), "frame-000001.depth.png: is a truncated PNG");
  write_text(file("depth.png"), "");
  EXPECT_EQ(fault(), "frame-000001.depth.png: is empty");
  std::filesystem::remove(file("depth.png"));
  std::filesystem::create_directory(file("depth.png"));
  EXPECT_EQ(fault(), "frame-000001.depth.png: cannot be read");
}

TEST_F(RecordingTest, WrongSizesAreNamed) {
  write_file(file("color.png"), encode_png(RgbImage(20, 10)));
  EXPECT_EQ(fault(), "frame-000001.color.png: is 20x10, expected 80x60");
  write_file(file("depth.png"), encode_png(Image<std::uint16_t>(60, 80, 1000)));
  EXPECT_EQ(fault(), "frame-000001.depth.png: is 60x80, expected 80x60");
}

TEST_F(RecordingTest, ColourPictureInPlaceOfDepthIsNamed) {
  write_file(file("depth.png"), encode_png(RgbImage(80, 60)));
  EXPECT_EQ(fault(), "frame-000001.depth.png: is a PNG in colour, accepted is one grey channel");
}

TEST_F(RecordingTest, DepthWithoutAnyValidPixelIsNamed) {
  write_file(file("depth.png"), encode_png(Image<std::uint16_t>(80, 60, 0)));
  EXPECT_EQ(fault(), "frame-000001.depth.png: has no depth from 0.1 to 10 m");
  write_file(file("depth.png"), encode_png(Image<std::uint16_t>(80, 60, 65535)));
  EXPECT_EQ(fault(), "frame-000001.depth.png: has no depth from 0.1 to 10 m");
}

TEST_F(RecordingTest, BadPosesAreNamed) {
  Eigen::Matrix4d pose = sequence_.pose(1);
  pose(0, 3) = -std::numeric_limits<double>::infinity();
  write_text(file("pose.txt"), fixture::matrix_text(pose));
  EXPECT_EQ(fault(), "frame-000001.pose.txt: has a bad pose (not finite)");
  pose = sequence_.pose(1);
  pose.topLeftCorner<3, 3>() *= 1.1;
  write_text(file("pose.txt"), fixture::matrix_text(pose));
  EXPECT_EQ(fault(), "frame-000001.pose.txt: has a bad pose (rotation not orthonormal)");
  write_text(file("pose.txt"), "1 0 0 0 0 1 0 0 0 0 1 0");
  EXPECT_EQ(fault(), "frame-000001.pose.txt: does not hold a 4x4 matrix");
  write_text(file("pose.txt"), "lost");
  EXPECT_EQ(fault(), "frame-000001.pose.txt: does not hold a 4x4 matrix");
}

TEST_F(RecordingTest, DepthIsMetresAndOutOfRangeIsZero) {
  Image<std::uint16_t> stored(80, 60, 2345);
  stored.at(0, 0) = 999;
  stored.at(1, 0) = 1000;
  stored.at(2, 0) = 3000;
  stored.at(3, 0) = 3001;
  stored.at(4, 0) = 0;
  write_file(file("depth.png"), encode_png(stored));
  const auto source = open_frame_source(folder_.path(), {1.f, 3.f});
  const FrameRead read = source->read(1);
  ASSERT_TRUE(read.frame) << read.fault;
  const DepthImage& depth = read.frame->depth;
  EXPECT_FLOAT_EQ(depth.at(10, 10), 2.345f);
  EXPECT_EQ(depth.at(0, 0), 0.f);
  EXPECT_FLOAT_EQ(depth.at(1, 0), 1.f);
  EXPECT_FLOAT_EQ(depth.at(2, 0), 3.f);
  EXPECT_EQ(depth.at(3, 0), 0.f);
  EXPECT_EQ(depth.at(4, 0), 0.f);
}

TEST_F(RecordingTest, NoCompleteFrameIsAnErrorThatNamesWhatIsMissing) {
  for (int i = 0; i < 3; ++i)
    std::filesystem::remove(folder_.path() / ("frame-" + fixture::padded(i, 6) + ".pose.txt"));
  const std::string fault = error_of([&] { open_frame_source(folder_.path()); });
  EXPECT_NE(fault.find("frame-000000.pose.txt is missing"), std::string::npos) << fault;
}

TEST_F(RecordingTest, PosesMayBeMissingWhereTheCallerAllowsIt) {
  const auto open = [&](PoseNeed need) {
    FrameSourceConfig config;
    config.poses = need;
    return open_frame_source(folder_.path(), config);
  };
  EXPECT_TRUE(open(PoseNeed::kAllOrNone)->posed());
  EXPECT_FALSE(open(PoseNeed::kNone)->read(1).frame->posed);
  std::filesystem::remove(file("pose.txt"));
  EXPECT_EQ(open(PoseNeed::kAllOrNone)->read(1).fault, "frame-000001.pose.txt: is missing");
  for (int i : {0, 2})
    std::filesystem::remove(folder_.path() / ("frame-" + fixture::padded(i, 6) + ".pose.txt"));
  const auto unposed = open(PoseNeed::kAllOrNone);
  EXPECT_FALSE(unposed->posed());
  ASSERT_TRUE(unposed->read(1).frame);
  EXPECT_FALSE(unposed->read(1).frame->posed);
  EXPECT_TRUE(unposed->read(1).frame->world_from_camera.matrix().isIdentity());
}

TEST(OpenFrameSource, WhatCannotBeOpenedIsNamed) {
  const fixture::TemporaryFolder folder;
  const auto message = [](const std::filesystem::path& path) {
    return error_of([&] { open_frame_source(path); });
  };
  EXPECT_NE(message(folder.path() / "none").find("does not exist"), std::string::npos);
  EXPECT_NE(message(folder.path()).find("is empty"), std::string::npos);
  write_text(folder.path() / "readme.txt", "no recording");
  EXPECT_NE(message(folder.path()).find("frame-NNNNNN.color.jpg"), std::string::npos);
  write_text(folder.path() / "a.txt", "x");
  EXPECT_NE(message(folder.path() / "a.txt").find("is a file"), std::string::npos);
  EXPECT_THROW(open_frame_source(folder.path(), {2.f, 1.f}), Error);
}

}  // namespace
}  // namespace ovimap
