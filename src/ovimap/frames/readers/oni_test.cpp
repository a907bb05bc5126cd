// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/readers/oni_fixture.h"

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/frame/frame_source.h"

namespace ovimap {
namespace {

class Oni : public ::testing::Test {
 protected:
  std::filesystem::path file() const { return folder_.path() / "room.oni"; }
  void write(const fixture::OniWriter& writer) const { write_file(file(), writer.bytes()); }
  std::unique_ptr<FrameSource> open() const {
    FrameSourceConfig config;
    config.poses = PoseNeed::kAllOrNone;
    return open_frame_source(file(), config);
  }
  std::string error() const {
    return error_of([&] { open(); });
  }
  void expect_error(const fixture::OniWriter& writer, const char* words) const {
    write(writer);
    EXPECT_NE(error().find(words), std::string::npos) << error();
  }

  fixture::Sequence sequence_;
  fixture::TemporaryFolder folder_;
};

TEST_F(Oni, FramesAreThoseThatWereStored) {
  for (const bool mirrored : {false, true}) {
    write(fixture::oni_of(sequence_, {.mirrored = mirrored}));
    const auto source = open();
    EXPECT_EQ(source->kind(), "oni");
    EXPECT_FALSE(source->posed());
    ASSERT_EQ(source->size(), sequence_.frames);
    const FrameRead read = source->read(7);
    ASSERT_TRUE(read.frame) << read.fault;
    EXPECT_EQ(read.frame->color, sequence_.color(7));
    EXPECT_NEAR(read.frame->depth.at(12, 34), sequence_.depth(7).at(12, 34), 0.0006);
    EXPECT_NEAR(read.frame->timestamp_s, 7 * 0.033333, 1e-9);
    EXPECT_NEAR(read.frame->depth_camera.fx, sequence_.depth_camera.fx, 1e-3);
    EXPECT_NEAR(read.frame->depth_camera.cy, sequence_.depth_camera.cy, 1e-3);
    EXPECT_TRUE(read.frame->registered());
  }
}

TEST_F(Oni, ColourMayBeJpeg) {
  write(fixture::oni_of(sequence_, {.jpeg = true}));
  const FrameRead read = open()->read(3);
  ASSERT_TRUE(read.frame) << read.fault;
  const Rgb8 seen = read.frame->color.at(10, 10), stored = sequence_.color(3).at(10, 10);
  EXPECT_NEAR(seen.r, stored.r, 12);
  EXPECT_NEAR(seen.b, stored.b, 12);
}

TEST_F(Oni, ImagesThatWereTakenTogetherArePairs) {
  write(fixture::oni_of(sequence_, {.color_late_us = 30000}));  // nearer to the next image of depth
  const auto source = open();
  ASSERT_EQ(source->size(), sequence_.frames - 1);
  EXPECT_EQ(source->read(0).frame->color, sequence_.color(0));
  EXPECT_NEAR(source->read(0).frame->depth.at(12, 34), sequence_.depth(1).at(12, 34), 0.0006);
  sequence_.frames = 1;
  expect_error(fixture::oni_of(sequence_, {.color_late_us = 30000}), "max_time_gap_s");
}

TEST_F(Oni, AFileThatIsCutOffHasWhatCameBefore) {
  Bytes bytes = fixture::oni_of(sequence_).bytes();
  bytes.resize(bytes.size() * 2 / 3);
  write_file(file(), bytes);
  const auto source = open();
  EXPECT_GT(source->size(), sequence_.frames / 2);
  EXPECT_LT(source->size(), sequence_.frames);
  for (std::int64_t i = 0; i < source->size(); ++i) EXPECT_TRUE(source->read(i).frame);
}

TEST_F(Oni, WhatIsMissingIsNamed) {
  using fixture::OniWriter;
  expect_error(OniWriter(), "no depth images");
  auto only_depth = OniWriter();
  only_depth.add_node(OniWriter::kDepth, 2, "NONE");
  only_depth.add_property(OniWriter::kDepth, "xnMapOutputMode", std::array{80u, 60u, 30u});
  only_depth.add_image(OniWriter::kDepth, 1, 1, std::string(9600, 'x'));
  expect_error(only_depth, "no colour images");
  auto cropped = fixture::begin_oni(sequence_, {});
  cropped.add_property(OniWriter::kDepth, "xnCropping", std::array{1, 2, 3});
  cropped.add_image(OniWriter::kDepth, 1, 1, std::string(9600, 'x'));
  expect_error(cropped, "are cropped");
  write_text(file(), "NI11");
  EXPECT_NE(error().find("is no OpenNI recording"), std::string::npos);
  Bytes other = fixture::oni_of(sequence_).bytes();
  other[4] = 2;
  write_file(file(), other);
  EXPECT_NE(error().find("has version 2.0"), std::string::npos);
}

TEST_F(Oni, WithoutAFieldOfViewTheCameraIsAskedFor) {
  fixture::OniWriter writer;
  writer.add_node(1, 2, "NONE");
  writer.add_property(1, "xnMapOutputMode", std::array{80u, 60u, 30u});
  writer.add_node(2, 3, "NONE");
  writer.add_property(2, "xnMapOutputMode", std::array{80u, 60u, 30u});
  writer.add_image(2, 1, 1, std::string(14400, 'x'));
  writer.add_image(1, 1, 1, std::string(9600, '\3'));
  expect_error(writer, "camera.yaml");
  write_text(folder_.path() / "camera.yaml",
             "camera: {width: 80, height: 60, fx: 70, fy: 70, cx: 39.5, cy: 29.5}");
  EXPECT_TRUE(open()->read(0).frame);
}

TEST_F(Oni, AnyDamageIsReadOrRefused) {
  sequence_.frames = 3;
  const Bytes whole = fixture::oni_of(sequence_).bytes();
  for (std::size_t i = 0; i < 2500; ++i) {
    Bytes bytes = whole;
    bytes[i * 7919 % 1800] ^= static_cast<std::uint8_t>(1 + i % 255);  // header, nodes, first image
    write_file(file(), bytes);
    try {
      const auto source = open();
      for (std::int64_t k = 0; k < source->size(); ++k)
        EXPECT_TRUE(source->read(k).frame || !source->read(k).fault.empty());
    } catch (const Error&) {
    }
  }
}

}  // namespace
}  // namespace ovimap
