// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/alignment/place_agreement.h"

#include <gtest/gtest.h>

#include "ovimap/pipeline/mapping/furnished_fixture.h"

namespace ovimap {
namespace {

MapDocument room_with(std::vector<Furniture> things) {
  FurnishedRoom room;
  room.things = std::move(things);
  return map_of(room, MapDocument(), false);
}

PlaceAgreement held_against(const MapDocument& seen, const MapDocument& map, const Pose& pose) {
  const PlaceConfig config;
  PlaceAgreement sum;
  for (const PlaceView& view : place_views(seen, config))
    sum += agreement(view, map.map, pose * view.world_from_camera, config);
  return sum;
}

const Furniture kBox = furniture(-1.2f, 0.9f, {0.8f, 0.6f, 1.1f}, {200, 30, 30});

TEST(PlaceAgreement, AMapIsWhatItsCamerasSaw) {
  const MapDocument map = room_with({kBox});
  const PlaceAgreement found = held_against(map, map, Pose::Identity());
  EXPECT_GT(found.pixels, 1000);
  EXPECT_GT(found.overlap(), 0.99);
  EXPECT_LT(found.seen_through, 0.005 * found.pixels);
}

TEST(PlaceAgreement, WhatCamerasSeeThroughSpeaksAgainstAPlace) {
  const MapDocument with = room_with({kBox}), without = room_with({});
  const PlaceAgreement seen = held_against(without, with, Pose::Identity());
  EXPECT_GT(seen.seen_through, 0.02 * seen.pixels) << "the wall behind the box";
  const PlaceAgreement other = held_against(with, without, Pose::Identity());
  EXPECT_LT(other.seen_through, 0.005 * other.pixels) << "a box before the wall hides it";
}

TEST(PlaceAgreement, AnotherPoseMeetsLess) {
  const MapDocument map = room_with({kBox});
  Pose aside = Pose::Identity();
  aside.translation().x() = 0.3;
  EXPECT_LT(held_against(map, map, aside).overlap(), 0.8);
  aside.translation().x() = 40;
  const PlaceAgreement nowhere = held_against(map, map, aside);
  EXPECT_EQ(nowhere.meeting + nowhere.seen_through, 0);
}

TEST(PlaceAgreement, FloorsAndTableTopsTellNothing) {
  const MapDocument map = room_with({kBox});
  for (const PlaceView& view : place_views(map, {})) {
    const Eigen::Vector3f up = view.world_from_camera.linear().cast<float>().transpose() * map.up;
    for (std::size_t i = 0; i < view.telling.size(); ++i)
      if (view.telling[i] != 0) {
        ASSERT_LT(std::fabs(view.normals[i].dot(up)), 0.8f);
      }
  }
}

}  // namespace
}  // namespace ovimap
