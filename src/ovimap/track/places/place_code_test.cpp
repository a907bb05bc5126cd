// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/places/place_code.h"

#include <gtest/gtest.h>

#include "ovimap/track/room_camera_fixture.h"

namespace ovimap {
namespace {

TEST(PlaceCode, IsAlikeWhereTheCameraWasAndNotElsewhere) {
  const fixture::RoomCamera camera;
  const PlaceCode here = place_code(make_pyramid(camera.take(fixture::room_pose(0))));
  const PlaceCode beside = place_code(make_pyramid(camera.take(fixture::room_pose(2))));
  Pose turned = fixture::room_pose(0);
  turned.rotate(Eigen::AngleAxisd(2, Eigen::Vector3d::UnitY()));
  const PlaceCode elsewhere = place_code(make_pyramid(camera.take(turned)));
  EXPECT_NEAR(similarity(here, here), 1, 1e-5);
  EXPECT_GT(similarity(here, beside), 0.8);
  EXPECT_LT(similarity(here, elsewhere), 0.5);
  EXPECT_EQ(most_similar(here, {elsewhere, beside, here}, 2, 0.5),
            (std::vector<std::size_t>{2, 1}));
}

TEST(PlaceCode, DoesNotMindExposure) {
  const fixture::RoomCamera camera;
  Frame frame = camera.take(fixture::room_pose(0));
  const PlaceCode bright = place_code(make_pyramid(frame));
  for (Rgb8& pixel : frame.color) {
    pixel.r = static_cast<std::uint8_t>(pixel.r * 0.6 + 1);
    pixel.g = static_cast<std::uint8_t>(pixel.g * 0.6 + 1);
    pixel.b = static_cast<std::uint8_t>(pixel.b * 0.6 + 1);
  }
  EXPECT_GT(similarity(bright, place_code(make_pyramid(frame))), 0.99);
}

TEST(TurnBetween, FindsAFastPan) {
  const fixture::RoomCamera camera;
  const Pose start = fixture::room_pose(0);
  const Pose pan(Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.2, 1, 0).normalized()));
  const Pose found =
      turn_between(make_pyramid(camera.take(start)), make_pyramid(camera.take(start * pan)));
  EXPECT_LT(fixture::angle_rad(found, pan), 0.04);
}

}  // namespace
}  // namespace ovimap
