// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include "ovimap/frames/calibration/color_calibration.h"
#include "ovimap/synth/buildings/room_builder.h"
#include "ovimap/synth/camera/sensor_noise.h"
#include "ovimap/synth/furniture/furniture_catalog.h"
#include "ovimap/synth/recordings/sequence.h"
#include "ovimap/synth/rooms/room_spec.h"

namespace ovimap {
namespace {

/// A furnished room seen by a noisy depth camera and by a colour camera beside it, of which the
/// frames tell nothing.
class TwoCameraRoom final : public FrameSource {
 public:
  TwoCameraRoom(const std::string& room, int frames, const ColorView& truth)
      : spec_(small(room_spec(room))),
        sequence_(build_room(spec_), spec_.camera, frames),
        renderer_(sequence_.room()),
        truth_(truth) {}

  std::string kind() const override { return "two cameras"; }
  std::int64_t size() const override { return sequence_.size(); }
  FrameRead read(std::int64_t position) const override {
    const Pose& pose = sequence_.true_poses()[static_cast<std::size_t>(position)];
    const auto seed = static_cast<std::uint64_t>(position) + 1;
    Frame frame;
    frame.world_from_camera = pose;
    frame.depth_camera = frame.color_camera = spec_.camera;
    frame.depth = noisy_depth(renderer_.render(spec_.camera, pose, false), {}, seed);
    frame.color =
        noisy_color(seen_through_lens(pose * truth_.color_from_depth.inverse()), {}, seed);
    return {std::move(frame), {}};
  }
  const PinholeCamera& camera() const { return spec_.camera; }

 private:
  /// A straight picture with a border of half its size around, looked up where the lens shows it.
  RgbImage seen_through_lens(const Pose& pose) const {
    if (truth_.lens == Lens{}) return renderer_.render(truth_.camera, pose).color;
    PinholeCamera wide = truth_.camera;
    wide.width *= 2, wide.height *= 2;
    wide.cx += static_cast<float>(truth_.camera.width / 2);
    wide.cy += static_cast<float>(truth_.camera.height / 2);
    const RgbImage straight = renderer_.render(wide, pose).color;
    RgbImage bent(truth_.camera.width, truth_.camera.height);
    for (int y = 0; y < bent.height(); ++y)
      for (int x = 0; x < bent.width(); ++x) {
        const Eigen::Vector2d at =
            truth_.camera.unproject(static_cast<float>(x), static_cast<float>(y), 1)
                .head<2>()
                .cast<double>();
        Eigen::Vector2d ray = at;
        for (int i = 0; i < 20; ++i) ray += at - truth_.lens.bend(ray);
        const Eigen::Vector2f pixel = wide.project(ray.homogeneous().cast<float>());
        bent.at(x, y) =
            straight.at(std::clamp(static_cast<int>(pixel.x() + 0.5f), 0, wide.width - 1),
                        std::clamp(static_cast<int>(pixel.y() + 0.5f), 0, wide.height - 1));
      }
    return bent;
  }

  static RoomSpec small(RoomSpec spec) {
    spec.camera = spec.camera.scaled_to(320, 240);
    return spec;
  }

  RoomSpec spec_;
  SynthSequence sequence_;
  Renderer renderer_;
  ColorView truth_;
};

ColorView view(const PinholeCamera& camera, const Eigen::Vector3d& rotation,
               const Eigen::Vector3d& translation) {
  ColorView view{camera, Pose::Identity()};
  view.color_from_depth.linear() =
      Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
  view.color_from_depth.translation() = translation;
  return view;
}

void expect_found_within_a_pixel(const std::string& room, const ColorView& truth) {
  if (!std::filesystem::is_directory(default_furniture_folder()))
    GTEST_SKIP() << "the Debian package sweethome3d-furniture is not installed";
  const TwoCameraRoom source(room, 16, truth);
  const ColorCalibration result = calibrate_color(source, positions({}, source.size()));
  EXPECT_EQ(result.verdict, ColorCalibration::Verdict::kFound) << result.message;
  EXPECT_LT(result.spread_px, 1.5);
  for (const float depth_m : {1.f, 2.f, 3.f, 4.f}) {
    const double px = view_difference_px(source.camera(), result.found, truth, depth_m);
    EXPECT_LT(px, 1) << room << " at " << depth_m << " m";
    ::testing::Test::RecordProperty(concat("px_at_", static_cast<int>(depth_m), "_m"),
                                    std::to_string(px));
  }
}

TEST(RoomCalibration, ShorterFocalLengthInTheTinyRoom) {
  expect_found_within_a_pixel("tiny", view({320, 240, 218.4f, 218.4f, 159, 116},
                                           {-0.0062, 0.0025, 0.0087}, {-0.024, 0.0034, 0.012}));
}

TEST(RoomCalibration, LongerFocalLengthInTheTinyRoom) {
  expect_found_within_a_pixel("tiny", view({320, 240, 268.8f, 268.8f, 162.5f, 124},
                                           {0.012, -0.015, -0.006}, {0.05, 0, -0.005}));
}

TEST(RoomCalibration, ALensThatNobodyTold) {
  ColorView truth = view({320, 240, 232, 232, 161, 118}, {0.006, -0.004, 0.003}, {0.03, 0.002, 0});
  truth.lens = {Lens::Model::kBrownConrady, {-0.28, 0.09}};
  expect_found_within_a_pixel("bedroom", truth);
}

TEST(RoomCalibration, FarBesideInTheBedroom) {
  expect_found_within_a_pixel(
      "bedroom", view({320, 240, 192, 192, 155.5f, 122}, {0.02, 0.01, 0.015}, {-0.06, 0.02, 0}));
}

}  // namespace
}  // namespace ovimap
