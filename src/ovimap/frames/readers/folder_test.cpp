// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

/// Eleven frames, so that names in alphabetical order (0, 1, 10, 2...) would be wrong.
class Folder : public testing::Test {
 protected:
  Folder() {
    sequence_.frames = 11;
    fixture::write_folder(folder_.path(), sequence_);
  }

  const fs::path& path() const { return folder_.path(); }
  void write_lines(const std::string& name, int rows, int frames = 11) const {
    std::string text;
    for (int i = 0; i < frames; ++i) text += fixture::matrix_text(sequence_.pose(i), ' ', rows);
    write_text(path() / name, text);
  }
  void expect_all_read(double tolerance = 1e-12) const {
    const auto source = open_frame_source(path());
    EXPECT_EQ(source->kind(), "folder");
    ASSERT_EQ(source->size(), 11);
    for (int i : {0, 2, 10}) {
      const FrameRead read = source->read(i);
      ASSERT_TRUE(read.frame) << read.fault;
      EXPECT_EQ(read.frame->color, sequence_.color(i));
      EXPECT_NEAR(read.frame->depth.at(9, 9), sequence_.depth(i).at(9, 9), 0.00051);
      EXPECT_TRUE(read.frame->world_from_camera.isApprox(fixture::room_pose(i), tolerance)) << i;
    }
  }
  std::string error() const {
    return error_of([&] { open_frame_source(path()); });
  }

  fixture::TemporaryFolder folder_;
  fixture::Sequence sequence_;
};

TEST_F(Folder, PosesAsSixteenNumbers) {
  write_lines("poses.txt", 4);
  expect_all_read();
}

TEST_F(Folder, PosesAsKitti) {
  write_lines("traj.txt", 3);
  expect_all_read();
}

TEST_F(Folder, PosesAsTumWhoseTimesAreTheNames) {
  std::string text;
  for (int i = 10; i >= 0; --i) text += concat(i, " ", fixture::tum_text(sequence_.pose(i)), "\n");
  write_text(path() / "groundtruth.txt", text);
  expect_all_read(1e-7);
}

TEST_F(Folder, PosesAsTumByRank) {
  std::string text;
  for (int i = 0; i < 11; ++i)
    text += concat(5000 + i, " ", fixture::tum_text(sequence_.pose(i)), "\n");
  write_text(path() / "poses.txt", text);
  expect_all_read(1e-7);
}

TEST_F(Folder, PosesAsFilesOfEqualName) {
  fs::create_directories(path() / "pose");
  for (int i = 0; i < 11; ++i)
    write_text(path() / "pose" / concat(i, ".txt"), fixture::matrix_text(sequence_.pose(i)));
  expect_all_read();
  fs::remove(path() / "pose" / "4.txt");
  EXPECT_EQ(open_frame_source(path())->read(4).fault, "4.txt: is missing");
}

TEST_F(Folder, LineIsTheFramesNumberWhenImagesWereThinned) {
  write_lines("poses.txt", 4);
  for (int i = 0; i < 11; ++i) {
    if (i % 5 == 0) continue;
    fs::remove(path() / "color" / concat(i, ".png"));
    fs::remove(path() / "depth" / concat(i, ".png"));
  }
  const auto source = open_frame_source(path());
  ASSERT_EQ(source->size(), 3);
  EXPECT_TRUE(source->read(2).frame->world_from_camera.isApprox(fixture::room_pose(10), 1e-12));
}

TEST_F(Folder, ImagesOfUnequalNamesArePairedByRank) {
  write_lines("poses.txt", 4);
  fs::rename(path() / "color", path() / "rgb");
  for (int i = 0; i < 11; ++i)
    fs::rename(path() / "depth" / concat(i, ".png"), path() / "depth" / concat("d", i, ".png"));
  expect_all_read();
  fs::remove(path() / "depth" / "d3.png");
  EXPECT_NE(error().find("has 10 .png files for 11 colour images"), std::string::npos);
}

TEST_F(Folder, MissingDepthIsAFaultOfItsFrame) {
  write_lines("poses.txt", 4);
  fs::remove(path() / "depth" / "3.png");
  const auto source = open_frame_source(path());
  EXPECT_EQ(source->size(), 11);
  EXPECT_EQ(source->read(3).fault, "3.png: is missing");
}

TEST_F(Folder, IntrinsicsMayBeText) {
  write_lines("poses.txt", 4);
  fs::remove(path() / "camera.yaml");
  for (const char* text : {"70 70 39.5 29.5", "70 0 39.5\n0 70 29.5\n0 0 1\n",
                           "70 0 39.5 0\n0 70 29.5 0\n0 0 1 0\n0 0 0 1\n"}) {
    write_text(path() / "intrinsics.txt", text);
    const FrameRead read = open_frame_source(path())->read(0);
    ASSERT_TRUE(read.frame) << read.fault;
    EXPECT_EQ(read.frame->depth_camera, sequence_.depth_camera);
    EXPECT_TRUE(read.frame->registered());
  }
  write_text(path() / "intrinsics.txt", "70 70");
  EXPECT_NE(error().find("'fx fy cx cy' or a 3x3"), std::string::npos);
}

TEST_F(Folder, TwoIntrinsicsAsScanNetExportsThem) {
  write_lines("poses.txt", 4);
  fs::remove(path() / "camera.yaml");
  fs::create_directories(path() / "intrinsic");
  for (int i = 0; i < 11; ++i)
    write_file(path() / "color" / concat(i, ".png"), encode_png(RgbImage(160, 121)));
  write_text(path() / "intrinsic" / "intrinsic_depth.txt",
             "70 0 39.5 0 0 70 29.5 0 0 0 1 0 0 0 0 1");
  EXPECT_NE(error().find("give both depth_camera and color_camera"), std::string::npos);
  write_text(path() / "intrinsic" / "intrinsic_color.txt", "140 0 80 0 0 140 60 0 0 0 1 0 0 0 0 1");
  const FrameRead read = open_frame_source(path())->read(0);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_EQ(read.frame->color_camera, (PinholeCamera{160, 121, 140.f, 140.f, 80.f, 60.f}));
}

TEST_F(Folder, WhatIsMissingIsSaidWithAnExample) {
  EXPECT_NE(error().find("no poses; give poses.txt"), std::string::npos);
  write_lines("poses.txt", 4, 7);
  EXPECT_NE(error().find("has 11 images, but the pose file 7 lines"), std::string::npos);
  write_lines("poses.txt", 4);
  fs::remove(path() / "camera.yaml");
  EXPECT_NE(error().find("camera: {width: 640"), std::string::npos);
  write_text(path() / "camera.yaml", "camera: {fx: 70, cx: 39.5, cy: 29.5}");
  EXPECT_NE(error().find("the depth camera lacks fy"), std::string::npos);
  write_text(path() / "camera.yaml", "camera: {fx: 70, fy: 70}");
  EXPECT_NE(error().find("lacks cx, cy"), std::string::npos);
  write_text(path() / "camera.yaml", "camera: {fx: 70, fy: 70, cx: 39.5, cy: 29.5}");
  expect_all_read();
  for (const auto& entry : fs::directory_iterator(path() / "color")) fs::remove(entry.path());
  EXPECT_NE(error().find("holds no .jpg or .png image"), std::string::npos);
}

TEST_F(Folder, OfABagTheToolForItIsNamed) {
  write_text(path() / "lab.mcap", "");
  const std::string fault = error_of([&] { open_frame_source(path() / "lab.mcap"); });
  EXPECT_NE(fault.find("`ovimap-bag lab.mcap FOLDER`"), std::string::npos) << fault;
}

}  // namespace
}  // namespace ovimap
