// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/camera/video_camera.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"
#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/camera/small_camera_fixture.h"
#include "ovimap/synth/recordings/sequence.h"

namespace ovimap {
namespace {

using fixture::kSmallCamera;

WalkConfig motionless() {
  WalkConfig config;
  config.rise_m = config.sideways_m = config.drift_m = config.tremor_m = 0;
  config.nod_rad = config.roll_rad = config.drift_rad = config.tremor_rad = 0;
  return config;
}

/// Stands at one place and turns.
Walk turning(double radians_per_s) {
  std::vector<Eigen::Vector2d> gazes;
  for (int i = 0; i < 6; ++i) gazes.emplace_back(radians_per_s * i, 0);
  return {PlaneSpline({{1.8, 1.5}}, 1, true), PlaneSpline(gazes, 1, false), 5, 1, motionless()};
}

double mean_of(const RgbImage& image) {
  double sum = 0;
  for (const Rgb8& pixel : image) sum += pixel.r + pixel.g + pixel.b;
  return sum / static_cast<double>(3 * image.size());
}

/// Mean difference between neighbours along rows: how sharp upright edges are.
double sharpness(const RgbImage& image) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 1; x < image.width(); ++x)
      sum += std::abs(image.at(x, y).g - image.at(x - 1, y).g);
  return sum / static_cast<double>(image.size());
}

TEST(ShutterPoses, AreNoneWhenStillAndAPixelApartWhenNot) {
  EXPECT_TRUE(shutter_poses(turning(0), kSmallCamera, 2, {}).empty());
  VideoCameraConfig config;
  config.shutter_s = 0.1f;
  const auto poses = shutter_poses(turning(0.5), kSmallCamera, 2, config);
  EXPECT_EQ(poses.size(), 4u);  // 0.05 rad of 48 px: 2.4 px
  const Pose middle = turning(0.5).at(2);
  EXPECT_TRUE(poses[1].isApprox(turning(0.5).at(2 - 0.0125), 1e-9));
  EXPECT_FALSE(poses[0].isApprox(middle, 1e-3));
  config.max_subframes = 2;
  EXPECT_EQ(shutter_poses(turning(0.5), kSmallCamera, 2, config).size(), 2u);
  config.shutter_s = 0;
  EXPECT_TRUE(shutter_poses(turning(0.5), kSmallCamera, 2, config).empty());
}

TEST(Shutter, BlurSmearsAlongTheMotionAndKeepsBrightness) {
  const SynthRoom room = build_room(room_spec("bare"));
  const Renderer renderer(room);
  const Walk walk = turning(1);
  VideoCameraConfig config;
  config.shutter_s = 0.15f;
  const Pose pose = walk.at(2);
  const RenderedView sharp = renderer.render(kSmallCamera, pose, Shutter{});
  const RenderedView blurred =
      renderer.render(kSmallCamera, pose, Shutter{shutter_poses(walk, kSmallCamera, 2, config)});
  EXPECT_EQ(sharp.color, renderer.render(kSmallCamera, pose).color);
  EXPECT_EQ(sharp.depth, blurred.depth);
  EXPECT_EQ(sharp.ids, blurred.ids);
  EXPECT_LT(sharpness(blurred.color), 0.8 * sharpness(sharp.color));
  EXPECT_NEAR(mean_of(blurred.color), mean_of(sharp.color), 3);
  // Pictures of one and the same place are that place's picture, edges apart.
  const RenderedView still = renderer.render(kSmallCamera, pose, Shutter{{pose, pose, pose, pose}});
  double worst = 0;
  for (std::size_t i = 0; i < still.color.size(); ++i)
    worst += std::abs(still.color[i].g - sharp.color[i].g);
  EXPECT_LT(worst / static_cast<double>(still.color.size()), 2);
}

TEST(AutoExposureTest, AimsAtItsBrightnessAndFollowsLate) {
  SynthRoom room = build_room(room_spec("bare"));
  const auto brightness = [&](const SynthRoom& lit, const VideoCameraConfig& config) {
    const Renderer renderer(lit);
    const Walk walk = turning(0);
    Shutter shutter;
    shutter.exposure = AutoExposure(renderer, kSmallCamera, walk, config).at(1);
    double sum = 0;
    const RgbImage color = renderer.render(kSmallCamera, walk.at(1), shutter).color;
    for (const Rgb8& pixel : color) sum += std::pow(pixel.g / 255., 2.2);
    return sum / static_cast<double>(color.size());
  };
  VideoCameraConfig wide;
  wide.least_exposure = 0.05f, wide.most_exposure = 20;
  SynthRoom dim = room;
  dim.ambient *= 0.4f;
  for (AreaLight& light : dim.lights) light.intensity *= 0.4f;
  EXPECT_NEAR(brightness(room, wide), wide.brightness, 0.03);
  EXPECT_NEAR(brightness(dim, wide), wide.brightness, 0.03);

  const Renderer renderer(room);
  VideoCameraConfig slow = wide;
  slow.response_s = 5;
  const Walk walk = turning(0.6);
  const AutoExposure quick(renderer, kSmallCamera, walk, wide),
      late(renderer, kSmallCamera, walk, slow);
  double quick_changes = 0, late_changes = 0;
  for (double t = 0.1; t < 5; t += 0.1) {
    quick_changes += std::abs(quick.at(t) - quick.at(t - 0.1));
    late_changes += std::abs(late.at(t) - late.at(t - 0.1));
  }
  EXPECT_GT(quick_changes, 0.01);
  EXPECT_LT(late_changes, 0.5 * quick_changes);
}

TEST(Video, HasAsManyFramesAsItsSecondsHold) {
  for (const auto& [seconds, frames] : {std::pair{0.2f, 6}, {0.7f, 21}, {1.f, 30}}) {
    VideoConfig video;
    video.walk.seconds = seconds;
    EXPECT_EQ(SynthSequence(build_room(room_spec("bare")), kSmallCamera, video).size(), frames);
  }
}

TEST(Video, IsTheSameForAnyNumberOfThreadsAndInAnyOrder) {
  SynthSequenceConfig config;
  config.noise = true;
  VideoConfig video;
  video.walk.seconds = 0.5f;
  video.walk.fps = 10;
  video.walk.max_turn_rad_s = 2;
  const SynthSequence whole(build_room(room_spec("bare")), kSmallCamera, video, config);
  ASSERT_EQ(whole.size(), 5);
  EXPECT_TRUE(whole.is_video());
  const Frame frame = *whole.read(3).frame;
  EXPECT_NEAR(frame.timestamp_s, 0.3, 1e-12);
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    const SynthSequence again(build_room(room_spec("bare")), kSmallCamera, video, config);
    const Frame same = *again.read(3).frame;
    EXPECT_EQ(same.color, frame.color);
    EXPECT_EQ(same.depth, frame.depth);
    EXPECT_EQ(again.truth_ids(3), whole.truth_ids(3));
    EXPECT_TRUE(same.world_from_camera.isApprox(frame.world_from_camera, 0));
  }
}

}  // namespace
}  // namespace ovimap
