// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

/// color/00001.jpg to 00011.jpg, depth alike, trajectory.log and camera_intrinsic.json.
class Redwood : public testing::Test {
 protected:
  Redwood() {
    sequence_.frames = 11;
    fs::create_directories(path() / "color");
    fs::create_directories(path() / "depth");
    for (int i = 0; i < 11; ++i) {
      const std::string stem = fixture::padded(i + 1, 5);
      write_file(path() / "color" / (stem + ".jpg"), encode_jpeg(sequence_.color(i), 95));
      write_file(path() / "depth" / (stem + ".png"), encode_png(sequence_.stored_depth(i)));
    }
    write_log("trajectory.log", [](int i) { return i + 1; });
    write_text(path() / "camera_intrinsic.json",
               R"({"width": 80, "height": 60, "intrinsic_matrix":
                            [70, 0, 0, 0, 70, 0, 39.5, 29.5, 1]})");
  }

  const fs::path& path() const { return folder_.path(); }

  template <class Number>
  void write_log(const std::string& name, Number&& third, int frames = 11) const {
    std::string text;
    for (int i = 0; i < frames; ++i)
      text += concat(i, "\t", i, "\t", third(i), "\n", fixture::matrix_text(sequence_.pose(i)));
    write_text(path() / name, text);
  }
  void expect_frames(const FrameSource& source, std::initializer_list<int> frames) const {
    for (const int i : frames) {
      const FrameRead read = source.read(i);
      ASSERT_TRUE(read.frame) << read.fault;
      EXPECT_EQ(read.frame->name, fixture::padded(i + 1, 5));
      EXPECT_TRUE(read.frame->world_from_camera.isApprox(fixture::room_pose(i), 1e-12)) << i;
      const DepthImage truth = sequence_.depth(i);
      for (std::size_t p = 0; p < truth.size(); ++p)
        ASSERT_NEAR(read.frame->depth[p], truth[p], 0.00051);
    }
  }
  std::string error() const {
    return error_of([&] { open_frame_source(path()); });
  }

  fixture::TemporaryFolder folder_;
  fixture::Sequence sequence_;
};

TEST_F(Redwood, WrittenSequenceComesBack) {
  const auto source = open_frame_source(path());
  EXPECT_EQ(source->kind(), "redwood");
  ASSERT_EQ(source->size(), 11);
  expect_frames(*source, {0, 4, 10});
  EXPECT_EQ(source->read(0).frame->depth_camera, sequence_.depth_camera);
  EXPECT_TRUE(source->read(0).frame->registered());
}

TEST_F(Redwood, OtherNamesOfFoldersAndLog) {
  fs::rename(path() / "color", path() / "image");
  fs::rename(path() / "trajectory.log", path() / "lounge_trajectory.log");
  expect_frames(*open_frame_source(path()), {7});
  fs::create_directories(path() / "scene");
  fs::rename(path() / "lounge_trajectory.log", path() / "scene" / "trajectory.log");
  expect_frames(*open_frame_source(path()), {8});
}

TEST_F(Redwood, ThirdNumberSaysWhichImage) {
  std::string text;
  for (const int i : {9, 2, 5})
    text += concat("0 0 ", i + 1, "\n", fixture::matrix_text(sequence_.pose(i)));
  write_text(path() / "trajectory.log", text);
  const auto source = open_frame_source(path());
  ASSERT_EQ(source->size(), 11);
  expect_frames(*source, {2, 5, 9});
  EXPECT_EQ(source->read(3).fault, "00004: has no pose");
}

TEST_F(Redwood, PosesAreInOrderWhenTheNumberMeansSomethingElse) {
  write_log("trajectory.log", [](int) { return 0; });
  expect_frames(*open_frame_source(path()), {0, 10});
}

TEST_F(Redwood, DefaultIsThePrimeSenseCamera) {
  fs::remove(path() / "camera_intrinsic.json");
  EXPECT_NE(open_frame_source(path())->read(0).fault.find("is 80x60, expected 640x480"),
            std::string::npos);
  write_text(path() / "calibration.yaml", fixture::calibration_yaml(sequence_));
  expect_frames(*open_frame_source(path()), {0});
}

TEST_F(Redwood, BadPoseIsAFaultOfItsFrame) {
  sequence_.stored_pose = [](const Pose& pose) {
    Eigen::Matrix4d matrix = pose.matrix();
    if (pose.isApprox(fixture::room_pose(1))) matrix.setZero();
    return matrix;
  };
  write_log("trajectory.log", [](int i) { return i + 1; });
  const auto source = open_frame_source(path());
  EXPECT_NE(source->read(1).fault.find("trajectory.log line 6: has a bad pose"), std::string::npos)
      << source->read(1).fault;
  EXPECT_TRUE(source->read(2).frame.has_value());
}

TEST_F(Redwood, BrokenDescriptionsAreNamed) {
  write_text(path() / "camera_intrinsic.json", R"({"intrinsic_matrix": [1, 2]})");
  EXPECT_NE(error().find("camera_intrinsic.json is no camera of Open3D"), std::string::npos);
  fs::remove(path() / "camera_intrinsic.json");
  fs::remove(path() / "color" / "00011.jpg");
  EXPECT_NE(error().find("has a pose for image 11, but there are only 10 images"),
            std::string::npos);
  write_text(path() / "trajectory.log", "0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  EXPECT_NE(error().find("has 4 lines; a pose has five"), std::string::npos);
  write_text(path() / "trajectory.log", "0 0 1\n1 0 0\n");
  EXPECT_NE(error().find("trajectory.log line 2 is '1 0 0'; expected a row of a 4x4 matrix"),
            std::string::npos);
}

}  // namespace
}  // namespace ovimap
