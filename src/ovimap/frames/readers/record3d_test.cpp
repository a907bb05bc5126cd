// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

namespace fs = std::filesystem;

/// metadata, rgbd/N.jpg (four times the depth's size), N.depth and N.conf of eleven frames.
class Record3d : public testing::Test {
 protected:
  Record3d() {
    sequence_.frames = 11;
    sequence_.color_camera = sequence_.depth_camera.scaled_to(320, 240);
    fs::create_directories(path() / "rgbd");
    for (int i = 0; i < 11; ++i) {
      write_file(file(i, ".jpg"), encode_jpeg(sequence_.color(i), 95));
      write_file(file(i, ".depth"), lzfse_bytes(sequence_.depth(i)));
      write_file(file(i, ".conf"), lzfse_bytes(Image<std::uint8_t>(80, 60, 2)));
    }
    write_metadata("");
  }

  const fs::path& path() const { return folder_.path(); }
  fs::path file(int i, const char* ending) const { return path() / "rgbd" / concat(i, ending); }

  template <class Pixel>
  static Bytes plain_bytes(const Image<Pixel>& image) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(image.data());
    return Bytes(first, first + image.size() * sizeof(Pixel));
  }
  /// An LZFSE stream of one plain block.
  template <class Pixel>
  static Bytes lzfse_bytes(const Image<Pixel>& image) {
    const Bytes pixels = plain_bytes(image);
    Bytes bytes = {'b', 'v', 'x', '-'};
    for (int shift = 0; shift < 32; shift += 8)
      bytes.push_back(static_cast<std::uint8_t>(pixels.size() >> shift));
    bytes.insert(bytes.end(), pixels.begin(), pixels.end());
    for (const char letter : {'b', 'v', 'x', '$'}) bytes.push_back(std::uint8_t(letter));
    return bytes;
  }

  /// [qx, qy, qz, qw, px, py, pz] of a camera whose y points up and whose z points back.
  static std::string stored_pose(int index) {
    const Pose pose = fixture::room_pose(index);
    Eigen::Matrix3d axes = pose.linear();
    axes.col(1) = -axes.col(1);
    axes.col(2) = -axes.col(2);
    const Eigen::Quaterniond q(axes);
    char text[256];
    std::snprintf(text, sizeof(text), "[%.15g, %.15g, %.15g, %.15g, %.15g, %.15g, %.15g]", q.x(),
                  q.y(), q.z(), q.w(), pose.translation().x(), pose.translation().y(),
                  pose.translation().z());
    return text;
  }
  /// `more` begins with a comma.
  void write_metadata(const std::string& more) const {
    const PinholeCamera& k = sequence_.color_camera;
    std::string poses;
    for (int i = 0; i < 11; ++i) poses += (i == 0 ? "" : ", ") + stored_pose(i);
    write_text(
        path() / "metadata",
        concat(R"({"w": 320, "h": 240, "dw": 80, "dh": 60, "fps": 60, "K": [)", k.fx, ", 0, 0, 0, ",
               k.fy, ", 0, ", k.cx, ", ", k.cy, R"(, 1], "poses": [)", poses, "]", more, "}"));
  }
  std::string error() const {
    return error_of([&] { open_frame_source(path()); });
  }

  fixture::TemporaryFolder folder_;
  fixture::Sequence sequence_;
};

TEST_F(Record3d, WrittenSequenceComesBackWithOurAxes) {
  const auto source = open_frame_source(path());
  EXPECT_EQ(source->kind(), "record3d");
  ASSERT_EQ(source->size(), 11);
  for (int i : {0, 2, 10}) {
    const FrameRead read = source->read(i);
    ASSERT_TRUE(read.frame) << read.fault;
    EXPECT_EQ(read.frame->name, std::to_string(i));
    EXPECT_NEAR(read.frame->timestamp_s, i / 60.0, 1e-9);
    EXPECT_TRUE(read.frame->world_from_camera.isApprox(fixture::room_pose(i), 1e-9)) << i;
    EXPECT_EQ(read.frame->depth, sequence_.depth(i));
    EXPECT_EQ(read.frame->color, decode_rgb(encode_jpeg(sequence_.color(i), 95)));
  }
}

TEST_F(Record3d, DepthCameraIsTheColourCameraAtItsOwnSize) {
  const FrameRead read = open_frame_source(path())->read(1);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_EQ(read.frame->color_camera, sequence_.color_camera);
  EXPECT_EQ(read.frame->depth_camera, sequence_.color_camera.scaled_to(80, 60));
  EXPECT_TRUE(read.frame->color_from_depth.matrix().isIdentity());
}

TEST_F(Record3d, EachFrameHasItsOwnFocusAndTime) {
  write_metadata(R"(, "perFrameIntrinsicCoeffs": [[280, 280, 158, 118], [281, 282, 159, 119]],
                    "frameTimestamps": [5.0, 5.25])");
  const auto source = open_frame_source(path());
  const FrameRead read = source->read(1);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_EQ(read.frame->color_camera, (PinholeCamera{320, 240, 281.f, 282.f, 159.f, 119.f}));
  EXPECT_EQ(read.frame->depth_camera, read.frame->color_camera.scaled_to(80, 60));
  EXPECT_NEAR(read.frame->timestamp_s, 5.25, 1e-9);
  EXPECT_EQ(source->read(5).frame->color_camera, sequence_.color_camera);
}

TEST_F(Record3d, CalibrationGoesBeforeTheFocusOfFrames) {
  write_metadata(R"(, "perFrameIntrinsicCoeffs": [[280, 280, 158, 118], [281, 282, 159, 119]])");
  write_text(path() / "calibration.yaml", "color_camera: {fx: 300}\ndepth_camera: {fx: 75}");
  const FrameRead read = open_frame_source(path())->read(1);
  ASSERT_TRUE(read.frame) << read.fault;
  EXPECT_FLOAT_EQ(read.frame->color_camera.fx, 300);
  EXPECT_FLOAT_EQ(read.frame->depth_camera.fx, 75);
  EXPECT_FLOAT_EQ(read.frame->color_camera.fy, sequence_.color_camera.fy);
}

TEST_F(Record3d, UnsureDepthIsInvalid) {
  Image<std::uint8_t> confidence(80, 60, 2);
  confidence.at(3, 4) = 0;
  confidence.at(5, 6) = 1;
  write_file(file(2, ".conf"), plain_bytes(confidence));
  const DepthImage truth = sequence_.depth(2);
  const auto depth_with = [&](int min_confidence) {
    FrameSourceConfig config;
    config.min_confidence = min_confidence;
    return open_frame_source(path(), config)->read(2).frame->depth;
  };
  EXPECT_EQ(depth_with(0), truth);
  DepthImage expected = truth;
  expected.at(3, 4) = 0;
  EXPECT_EQ(depth_with(1), expected);
  expected.at(5, 6) = 0;
  EXPECT_EQ(depth_with(2), expected);
  fs::remove(file(2, ".conf"));
  EXPECT_EQ(depth_with(2), truth);
}

TEST_F(Record3d, DepthMayBePlainAndHasHoles) {
  DepthImage depth = sequence_.depth(3);
  depth.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
  depth.at(1, 0) = std::numeric_limits<float>::infinity();
  depth.at(2, 0) = 0.01f;
  write_file(file(3, ".depth"), plain_bytes(depth));
  const FrameRead read = open_frame_source(path())->read(3);
  ASSERT_TRUE(read.frame) << read.fault;
  for (int u = 0; u < 3; ++u) {
    EXPECT_EQ(read.frame->depth.at(u, 0), 0.f);
    depth.at(u, 0) = 0;
  }
  EXPECT_EQ(read.frame->depth, depth);
}

TEST_F(Record3d, BadFramesAreFaults) {
  Bytes cut = read_file(file(1, ".depth"));
  cut.resize(cut.size() / 2);
  write_file(file(1, ".depth"), cut);
  write_file(file(2, ".depth"), lzfse_bytes(Image<float>(80, 61, 1.f)));
  write_file(file(3, ".depth"), lzfse_bytes(Image<float>(80, 59, 1.f)));
  fs::remove(file(4, ".depth"));
  write_file(file(5, ".conf"), Bytes(7, 1));
  fs::copy_file(file(0, ".jpg"), file(40, ".jpg"));
  fs::copy_file(file(0, ".depth"), file(40, ".depth"));
  const auto source = open_frame_source(path());
  EXPECT_EQ(source->read(1).fault, "1.depth: is broken LZFSE data");
  EXPECT_EQ(source->read(2).fault, "2.depth: holds more than the expected 19200 bytes");
  EXPECT_EQ(source->read(3).fault, "3.depth: holds 18880 bytes, expected 19200 for 80x60");
  EXPECT_EQ(source->read(4).fault, "4.depth: is missing");
  EXPECT_EQ(source->read(5).fault, "5.conf: holds 7 bytes, expected 4800 for 80x60");
  EXPECT_EQ(source->read(11).fault, "40: has no pose");
  EXPECT_TRUE(source->read(6).frame.has_value());
}

TEST_F(Record3d, BrokenDescriptionsAreNamed) {
  write_text(path() / "metadata", R"({"w": 320})");
  EXPECT_NE(error().find("expected are K, w, h, dw and dh"), std::string::npos);
  write_text(path() / "metadata", R"({"K": [1], "w": 1, "h": 1, "dw": 1, "dh": 1, "poses": []})");
  EXPECT_NE(error().find("K has 1 numbers"), std::string::npos);
  write_text(path() / "metadata",
             R"({"K": [1,0,0,0,1,0,1,1,1], "w": 1, "h": 1, "dw": 0, "dh": 1, "poses": []})");
  EXPECT_NE(error().find("is not above 0"), std::string::npos);
  write_text(path() / "metadata",
             R"({"K": [1,0,0,0,1,0,1,1,1], "w": 1, "h": 1, "dw": 2147483647,
                          "dh": 2147483647, "poses": []})");
  EXPECT_NE(error().find("2147483647x2147483647 are too large"), std::string::npos);
  write_metadata("");
  write_text(path() / "take.r3d", "PK");
  const std::string fault = error_of([&] { open_frame_source(path() / "take.r3d"); });
  EXPECT_NE(fault.find("is a zip file; unzip it"), std::string::npos);
}

}  // namespace
}  // namespace ovimap
