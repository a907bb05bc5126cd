// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/frames/readers/scannet_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

class Sens : public testing::Test {
 protected:
  fs::path file() const { return folder_.path() / "scene0000_00.sens"; }
  void write() const { write_file(file(), fixture::sens_bytes(sequence_, content_)); }
  std::string error() const {
    return error_of([&] { open_frame_source(file()); });
  }
  void expect_frame(const FrameSource& source, int i) const {
    const FrameRead read = source.read(i);
    ASSERT_TRUE(read.frame) << read.fault;
    EXPECT_EQ(read.frame->name, std::to_string(i));
    EXPECT_TRUE(read.frame->world_from_camera.isApprox(fixture::room_pose(i), 1e-6));
    EXPECT_EQ(read.frame->color, decode_rgb(encode_jpeg(sequence_.color(i), 95)));
    const DepthImage truth = sequence_.depth(i);
    for (std::size_t p = 0; p < truth.size(); ++p)
      ASSERT_NEAR(read.frame->depth[p], truth[p], 0.00051);
  }

  fixture::TemporaryFolder folder_;
  fixture::Sequence sequence_ = fixture::two_camera_sequence(5);
  fixture::SensContent content_;
};

TEST_F(Sens, WrittenSequenceComesBackFromFileAndFolder) {
  write();
  for (const fs::path& source_path : {file(), folder_.path()}) {
    const auto source = open_frame_source(source_path);
    EXPECT_EQ(source->kind(), "sens");
    ASSERT_EQ(source->size(), 5);
    for (int i : {3, 0, 4}) expect_frame(*source, i);
  }
}

TEST_F(Sens, CamerasAndTimesComeFromTheHeader) {
  content_.depth_microseconds = 40000;
  write();
  const FrameRead read = open_frame_source(file())->read(2);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_EQ(read.frame->color_camera, sequence_.color_camera);
  EXPECT_EQ(read.frame->depth_camera, sequence_.depth_camera);
  EXPECT_TRUE(read.frame->color_from_depth.isApprox(sequence_.color_from_depth, 1e-6));
  EXPECT_NEAR(read.frame->timestamp_s, 0.08, 1e-9);
}

TEST_F(Sens, DepthMayBeUncompressedAndOfAnotherScale) {
  content_.depth_compression = 0;
  content_.depth_units_per_m = 4000;
  sequence_.depth_units_per_m = 4000;
  write();
  expect_frame(*open_frame_source(file()), 2);
}

TEST_F(Sens, IsReadFromManyThreads) {
  write();
  const auto source = open_frame_source(file());
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 5; ++i) expect_frame(*source, (i + t) % 5);
    });
  for (std::thread& thread : threads) thread.join();
}

TEST_F(Sens, CalibrationBesideTheFileOverrides) {
  write();
  write_text(folder_.path() / "calibration.yaml", "depth_camera: {cx: 41}");
  EXPECT_FLOAT_EQ(open_frame_source(file())->read(0).frame->depth_camera.cx, 41);
}

TEST_F(Sens, LostFrameIsAFault) {
  sequence_.stored_pose = [](const Pose& pose) {
    if (!pose.isApprox(fixture::room_pose(2))) return Eigen::Matrix4d(pose.matrix());
    return Eigen::Matrix4d(Eigen::Matrix4d::Constant(-std::numeric_limits<double>::infinity()));
  };
  write();
  const auto source = open_frame_source(file());
  EXPECT_EQ(source->read(2).fault, "scene0000_00.sens frame 2: has a bad pose (not finite)");
  expect_frame(*source, 3);
}

TEST_F(Sens, BrokenDepthIsAFaultOfItsFrame) {
  Bytes bytes = fixture::sens_header(sequence_, content_);
  fixture::append_frame(bytes, sequence_, content_, 0);
  for (std::size_t i = bytes.size() - 4; i < bytes.size(); ++i) bytes[i] ^= 0xff;  // the check sum
  for (int i = 1; i < 5; ++i) fixture::append_frame(bytes, sequence_, content_, i);
  write_file(file(), bytes);
  const auto source = open_frame_source(file());
  EXPECT_EQ(source->read(0).fault, "scene0000_00.sens frame 0: is broken zlib data");
  expect_frame(*source, 1);
}

TEST_F(Sens, CutOffFileKeepsItsWholeFrames) {
  Bytes bytes = fixture::sens_bytes(sequence_, content_);
  bytes.resize(bytes.size() - 200);
  write_file(file(), bytes);
  const auto source = open_frame_source(file());
  ASSERT_EQ(source->size(), 5);
  expect_frame(*source, 3);
  EXPECT_EQ(source->read(4).fault, "scene0000_00.sens frame 4: is cut off");
}

TEST_F(Sens, MoreFramesPromisedThanThereAre) {
  content_.promised_frames = std::uint64_t{1} << 60;
  write();
  const auto source = open_frame_source(file());
  ASSERT_EQ(source->size(), 6);
  expect_frame(*source, 4);
  EXPECT_EQ(source->read(5).fault, "scene0000_00.sens frame 5: is cut off");
}

TEST_F(Sens, ClaimedSizesCostNothing) {
  sequence_.frames = 1;
  Bytes bytes = fixture::sens_bytes(sequence_, content_);
  const std::size_t sizes =
      4 + 8 + content_.sensor.size() + 4 * 64 + 2 * 4;  // of colour, then depth
  const auto claim = [&](std::size_t at, std::uint32_t side_px) {
    for (std::size_t i = 0; i < 8; ++i)
      bytes[at + i] = static_cast<std::uint8_t>(side_px >> 8 * (i % 4));
    write_file(file(), bytes);
  };
  claim(sizes + 8, 32767);  // two gigabytes a frame
  EXPECT_NE(error().find("depth images are 32767x32767; accepted are sides from 1 to 32767 and up "
                         "to 134217728 pixels"),
            std::string::npos)
      << error();
  claim(sizes + 8, 11000);
  EXPECT_NE(open_frame_source(file())->read(0).fault.find("bytes, for 11000x11000"),
            std::string::npos)
      << open_frame_source(file())->read(0).fault;
  claim(sizes, 32767);
  EXPECT_NE(error().find("colour images are 32767x32767"), std::string::npos);
}

TEST_F(Sens, AnImageOfManyGigabytesIsAFaultOfItsFrame) {
  Bytes bytes = fixture::sens_header(sequence_, content_);
  const std::size_t frame = bytes.size();
  fixture::append_frame(bytes, sequence_, content_, 0);
  constexpr std::uint64_t kColorSize = std::uint64_t{1} << 34;
  for (std::size_t i = 0; i < 8; ++i)
    bytes[frame + 64 + 16 + i] = static_cast<std::uint8_t>(kColorSize >> 8 * i);
  write_file(file(), bytes);
  fs::resize_file(file(), kColorSize + bytes.size());  // sparse: it takes no room
  EXPECT_EQ(open_frame_source(file())->read(0).fault,
            "scene0000_00.sens frame 0: its images are larger than they can be");
}

TEST_F(Sens, WrongHeadersAreNamed) {
  content_.version = 3;
  write();
  EXPECT_NE(error().find("has version 3; accepted are .sens files of version 4"),
            std::string::npos);
  content_.version = 4;
  content_.color_compression = 0;
  write();
  EXPECT_NE(error().find("colour has compression 0"), std::string::npos);
  content_.color_compression = 2;
  content_.depth_compression = 2;
  write();
  EXPECT_NE(error().find("depth has compression 2"), std::string::npos);
  content_.depth_compression = 1;
  content_.depth_units_per_m = 0;
  write();
  EXPECT_NE(error().find("the depth scale is 0 units per metre"), std::string::npos);
  write_file(file(), Bytes(20, 4));
  EXPECT_NE(error().find("has version 67372036"), std::string::npos);
  Bytes header = fixture::sens_header(sequence_, {});
  header.resize(100);
  write_file(file(), header);
  EXPECT_NE(error().find("ends within its header"), std::string::npos);
}

TEST_F(Sens, OneOfSeveralFilesMustBeChosen) {
  write();
  fs::copy_file(file(), folder_.path() / "other.sens");
  EXPECT_EQ(open_frame_source(file())->size(), 5);
  EXPECT_THROW(open_frame_source(folder_.path()), Error);
}

}  // namespace
}  // namespace ovimap
