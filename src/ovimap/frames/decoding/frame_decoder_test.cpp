// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/decoding/frame_decoder.h"

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/frames/recording/sequence_fixture.h"

namespace ovimap {
namespace {

CameraRig rig_of(const fixture::Sequence& sequence) {
  CameraRig rig;
  rig.depth_camera = sequence.depth_camera;
  return rig;
}

std::string decoding_fault(const FrameDecoder& decoder, const Bytes& color, const Bytes& depth,
                           const Eigen::Matrix4d& pose) {
  return fault_of([&] { decoder.decode(color, depth, pose); });
}

TEST(FrameDecoder, GivesWhatTheReadersGive) {
  fixture::Sequence sequence;
  const fixture::TemporaryFolder folder;
  fixture::write_seven_scenes(folder.path(), sequence);
  const auto source = open_frame_source(folder.path());
  const Frame read = *source->read(3).frame;
  const FrameDecoder decoder(rig_of(sequence));
  const Frame made = decoder.decode(encode_png(sequence.color(3)),
                                    encode_png(sequence.stored_depth(3)), sequence.pose(3));
  EXPECT_EQ(made.color, read.color);
  EXPECT_EQ(made.depth, read.depth);
  EXPECT_EQ(made.color_camera, read.color_camera);
  EXPECT_EQ(made.depth_camera, read.depth_camera);
  EXPECT_EQ(made.world_from_camera.matrix(), read.world_from_camera.matrix());
}

TEST(FrameDecoder, RectifiesAsReadersDo) {
  fixture::Sequence sequence;
  const fixture::TemporaryFolder folder;
  fixture::write_seven_scenes(folder.path(), sequence);
  const Frame bent = *open_frame_source(folder.path())->read(3).frame;
  write_text(folder.path() / "camera.yaml",
             "camera: {distortion: {coefficients: [-.3, .1, .001, .002, -.01]}}\n");
  const FrameRead straight = open_frame_source(folder.path())->read(3);
  ASSERT_TRUE(straight.frame) << straight.fault;
  const Frame& read = *straight.frame;
  CameraRig rig = rig_of(sequence);
  rig.depth_lens = {Lens::Model::kBrownConrady, {-.3, .1, .001, .002, -.01}};
  const Frame made = FrameDecoder(rig).decode(
      encode_png(sequence.color(3)), encode_png(sequence.stored_depth(3)), sequence.pose(3));
  EXPECT_EQ(made.color, read.color);
  EXPECT_EQ(made.depth, read.depth);
  EXPECT_EQ(made.color, Rectification(rig.depth_camera, rig.depth_lens, "").color(bent.color));
  EXPECT_EQ(made.depth, Rectification(rig.depth_camera, rig.depth_lens, "").depth(bent.depth));
  EXPECT_NE(made.depth, bent.depth);
}

TEST(FrameDecoder, SaysWhatIsWrongWithAFrame) {
  fixture::Sequence sequence;
  const FrameDecoder decoder(rig_of(sequence));
  const Bytes color = encode_png(sequence.color(0)), depth = encode_png(sequence.stored_depth(0));
  const Eigen::Matrix4d pose = sequence.pose(0);
  const auto expect = [&](const std::string& fault, const char* words) {
    EXPECT_NE(fault.find(words), std::string::npos) << fault;
  };
  EXPECT_EQ(decoding_fault(decoder, color, depth, pose), "");
  expect(decoding_fault(decoder, depth, color, pose), "depth");
  expect(decoding_fault(decoder, {1, 2, 3}, depth, pose), "color");
  expect(decoding_fault(decoder, color, {}, pose), "depth");
  expect(decoding_fault(decoder, color, depth, 2 * pose), "pose");
  expect(decoding_fault(decoder, encode_png(RgbImage(3, 2)), depth, pose), "3x2");
  expect(decoding_fault(decoder, color, encode_png(Image<std::uint16_t>(3, 2)), pose), "3x2");
  expect(decoding_fault(decoder, color, encode_png(Image<std::uint16_t>(80, 60)), pose),
         "no value");
  expect(decoding_fault(decoder, color, encode_png(Image<std::uint8_t>(80, 60)), pose), "8 bits");
}

TEST(FrameDecoder, NeedsWholeCameras) {
  CameraRig rig;
  EXPECT_THROW(FrameDecoder{rig}, Error);
  rig.color_camera = {80, 60, 70, 70, 39.5f, 29.5f};
  EXPECT_EQ(FrameDecoder(rig).rig().depth_camera, rig.color_camera);
  rig.depth_camera.width = 80;
  EXPECT_THROW(FrameDecoder{rig}, Error);
}

}  // namespace
}  // namespace ovimap
