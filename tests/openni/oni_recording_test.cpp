// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// The reader of .oni files against the library's own recorder and player.
#include <thread>

#include <OpenNI.h>
#include <gtest/gtest.h>

#include "camera_film_fixture.h"
#include "ovimap/frames/frame/frame_source.h"

namespace ovimap {
namespace {

/// Records the software camera with the library, for as long as its film lasts.
void record(const std::filesystem::path& file, bool lossy, std::chrono::milliseconds how_long) {
  openni::Device device;
  ASSERT_EQ(device.open(openni::ANY_DEVICE), openni::STATUS_OK)
      << openni::OpenNI::getExtendedError();
  openni::VideoStream depth, color;
  ASSERT_EQ(depth.create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
  ASSERT_EQ(color.create(device, openni::SENSOR_COLOR), openni::STATUS_OK);
  openni::Recorder recorder;
  ASSERT_EQ(recorder.create(file.c_str()), openni::STATUS_OK);
  recorder.attach(depth);
  recorder.attach(color, lossy);
  recorder.start();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // it begins on a thread of its own
  depth.start();
  color.start();
  std::this_thread::sleep_for(how_long);
  recorder.stop();
  recorder.destroy();
}

/// Depth of all frames as the library's own player gives it.
std::vector<std::vector<std::uint16_t>> played_depth(const std::filesystem::path& file) {
  openni::Device device;
  EXPECT_EQ(device.open(file.c_str()), openni::STATUS_OK) << openni::OpenNI::getExtendedError();
  openni::VideoStream depth;
  EXPECT_EQ(depth.create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
  device.getPlaybackControl()->setSpeed(-1);  // a frame at a time
  depth.start();
  std::vector<std::vector<std::uint16_t>> frames;
  const int count = device.getPlaybackControl()->getNumberOfFrames(depth);
  for (int i = 0; i < count; ++i) {
    openni::VideoFrameRef frame;
    if (depth.readFrame(&frame) != openni::STATUS_OK) break;
    const auto* pixels = static_cast<const std::uint16_t*>(frame.getData());
    frames.emplace_back(pixels, pixels + frame.getDataSize() / 2);
  }
  return frames;
}

class OniRecording : public ::testing::TestWithParam<bool> {
 protected:
  OniRecording() {
    sequence_.frames = 30;
    fixture::plug_in(folder_.path() / "film", fixture::film_of(sequence_, 60));
    EXPECT_EQ(openni::OpenNI::initialize(), openni::STATUS_OK);
  }
  ~OniRecording() override { openni::OpenNI::shutdown(); }

  fixture::Sequence sequence_;
  fixture::TemporaryFolder folder_;
};

TEST_P(OniRecording, IsReadAsItWasShown) {
  const bool lossy = GetParam();
  const auto file = folder_.path() / "room.oni";
  record(file, lossy, std::chrono::milliseconds(1500));
  FrameSourceConfig config;
  config.poses = PoseNeed::kAllOrNone;
  const auto source = open_frame_source(file, config);
  ASSERT_EQ(source->size(), sequence_.frames);
  const auto played = played_depth(file);
  ASSERT_EQ(played.size(), static_cast<std::size_t>(sequence_.frames));
  for (int i = 0; i < sequence_.frames; ++i) {
    const FrameRead read = source->read(i);
    ASSERT_TRUE(read.frame) << read.fault;
    const Image<std::uint16_t> shown = sequence_.stored_depth(i);
    for (std::size_t k = 0; k < shown.size(); ++k)
      ASSERT_EQ(std::lround(1000 * read.frame->depth[k]), shown[k]) << i << " " << k;
    // The camera swaps left and right, the player gives them as recorded.
    const std::size_t width = static_cast<std::size_t>(shown.width());
    EXPECT_EQ(played[static_cast<std::size_t>(i)][0], shown[width - 1]);
    const RgbImage color = sequence_.color(i);
    int furthest = 0;
    for (std::size_t k = 0; k < color.size(); ++k)
      if (k % width > 1)
        furthest = std::max(furthest, std::abs(color[k].g - read.frame->color[k].g));
    EXPECT_LE(furthest, lossy ? 60 : 0) << i;
    EXPECT_TRUE(lossy || read.frame->color == color) << i;
    EXPECT_NEAR(read.frame->timestamp_s, i / 30., 1e-4);
    EXPECT_NEAR(read.frame->depth_camera.fx, sequence_.depth_camera.fx, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Colour, OniRecording, ::testing::Values(false, true),
                         [](const auto& lossy) { return lossy.param ? "Jpeg" : "Plain"; });

}  // namespace
}  // namespace ovimap
