// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

class Replica : public testing::Test {
 protected:
  Replica() {
    sequence_.frames = 3;
    sequence_.depth_units_per_m = 6553.5;
    scene_ = fixture::write_replica(folder_.path(), sequence_);
  }
  std::string error() const {
    return error_of([&] { open_frame_source(scene_); });
  }

  fixture::TemporaryFolder folder_;
  fixture::Sequence sequence_;
  std::filesystem::path scene_;
};

TEST_F(Replica, WrittenSequenceComesBack) {
  const auto source = open_frame_source(scene_ / "");  // as completed by a shell
  EXPECT_EQ(source->kind(), "replica");
  ASSERT_EQ(source->size(), 3);
  const FrameRead read = source->read(1);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_EQ(read.frame->name, "frame000001");
  EXPECT_TRUE(read.frame->registered());
  EXPECT_TRUE(read.frame->world_from_camera.isApprox(fixture::room_pose(1), 1e-12));
  const DepthImage truth = sequence_.depth(1);
  for (std::size_t i = 0; i < truth.size(); ++i)
    ASSERT_NEAR(read.frame->depth[i], truth[i], 0.0001);
  EXPECT_TRUE(read.frame->color.same_size(truth));
}

TEST_F(Replica, TruthIdsAreReadWhereGiven) {
  std::filesystem::remove(scene_ / "results" / "instance000001.png");
  const auto source = open_frame_source(scene_);
  EXPECT_EQ(source->truth_ids(0), sequence_.ids(0));
  EXPECT_FALSE(source->truth_ids(1).has_value());
  write_file(scene_ / "results" / "instance000002.png", encode_png(IdImage(8, 8)));
  EXPECT_THROW((void)source->truth_ids(2), Error);
}

TEST_F(Replica, TimesAreThoseOfItsFileOrOfThirtyFramesASecond) {
  EXPECT_NEAR(open_frame_source(scene_)->read(2).frame->timestamp_s, 2. / 30, 1e-12);
  const auto write = [&](const std::string& text) {
    write_file(scene_ / "timestamps.txt", Bytes(text.begin(), text.end()));
  };
  write("0\n0.1\n0.2\n");
  EXPECT_EQ(open_frame_source(scene_)->read(2).frame->timestamp_s, 0.2);
  write("0\nsoon\n");
  EXPECT_NE(error().find("timestamps.txt"), std::string::npos) << error();
}

TEST_F(Replica, NumbersBelowZeroAreNoFrames) {
  write_text(scene_ / "timestamps.txt", "0\n0.1\n0.2\n");
  std::filesystem::copy(scene_ / "results/frame000000.jpg", scene_ / "results/frame-1.jpg");
  std::filesystem::copy(scene_ / "results/frame000000.jpg", scene_ / "results/frame-10000000.jpg");
  EXPECT_EQ(open_frame_source(scene_)->size(), 3);
}

TEST_F(Replica, AnImageThatIsLostIsAFaultOfItsFrame) {
  std::filesystem::remove(scene_ / "results/frame000001.jpg");
  std::filesystem::remove(scene_ / "results/depth000002.png");
  const auto source = open_frame_source(scene_);
  ASSERT_EQ(source->size(), 3);
  EXPECT_TRUE(source->read(0).frame.has_value());
  EXPECT_EQ(source->read(1).fault, "frame000001.jpg: is missing");
  EXPECT_EQ(source->read(2).fault, "depth000002.png: is missing");
}

TEST_F(Replica, CameraFileMayStandInTheScene) {
  std::filesystem::rename(folder_.path() / "cam_params.json", scene_ / "cam_params.json");
  EXPECT_EQ(open_frame_source(scene_)->size(), 3);
}

TEST_F(Replica, BrokenDescriptionsAreNamed) {
  std::filesystem::rename(folder_.path() / "cam_params.json", folder_.path() / "other");
  EXPECT_NE(error().find("no cam_params.json"), std::string::npos);
  write_text(folder_.path() / "cam_params.json", "{\"camera\": {\"w\": 80}}");
  EXPECT_NE(error().find("cam_params.json is not a camera description"), std::string::npos);
  write_text(
      folder_.path() / "cam_params.json",
      R"({"camera": {"w": 80, "h": 60, "fx": 1e10, "fy": 60, "cx": 40, "cy": 30, "scale": 1000}})");
  EXPECT_NE(error().find("are of no camera"), std::string::npos) << "no map could keep it";
  write_text(folder_.path() / "cam_params.json", "{nonsense");
  EXPECT_NE(error().find("cam_params.json is not JSON: line 1"), std::string::npos);
  const auto nested = [](std::size_t levels) {
    return R"({"camera": )" + std::string(levels, '[') + std::string(levels, ']') + "}";
  };
  write_text(folder_.path() / "cam_params.json", nested(100'000));
  EXPECT_NE(error().find("nested more than 32 levels deep"), std::string::npos);
  write_text(folder_.path() / "cam_params.json", nested(500'000));
  EXPECT_NE(error().find("cam_params.json is larger than"), std::string::npos);
  std::filesystem::rename(folder_.path() / "other", folder_.path() / "cam_params.json");
  std::filesystem::remove(scene_ / "traj.txt");
  EXPECT_NE(error().find("traj.txt"), std::string::npos);
}

TEST_F(Replica, ShortOrBrokenTrajectoryIsAFaultOfItsFrames) {
  write_text(scene_ / "traj.txt", fixture::matrix_text(sequence_.pose(0), ' ') + "1 0 0\n");
  const auto source = open_frame_source(scene_);
  EXPECT_TRUE(source->read(0).frame.has_value());
  EXPECT_EQ(source->read(1).fault, "traj.txt line 2: holds no pose");
  EXPECT_EQ(source->read(2).fault, "frame000002: has no pose");
}

}  // namespace
}  // namespace ovimap
