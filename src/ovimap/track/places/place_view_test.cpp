// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/places/place_view.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/track/room_camera_fixture.h"

namespace ovimap {
namespace {

/// Shares of pixels that a view knows, and that it knows right.
struct ViewScore {
  double known = 0, depth = 0, intensity = 0;

  ViewScore(const TrackLevel& view, const TrackLevel& truth) {
    for (std::size_t i = 0; i < view.inverse_depth.size(); ++i) {
      if (view.inverse_depth[i] == 0) continue;
      known += 1;
      depth += std::fabs(view.inverse_depth[i] / truth.inverse_depth[i] - 1) < 0.03f;
      intensity += std::fabs(view.intensity[i] - truth.intensity[i]) < 12;
    }
    depth /= known, intensity /= known;
    known /= static_cast<double>(view.inverse_depth.size());
  }
};

class PlaceView : public ::testing::Test {
 protected:
  PlaceView() {
    for (int i = 0; i <= 30; i += 10)
      places_.push_back(make_keyframe(make_pyramid(camera_.take(fixture::room_pose(i))), i,
                                      fixture::room_pose(i)));
  }
  TrackLevel truth_at(const Pose& pose) const {
    return make_pyramid(camera_.take(pose))[kSurfaceLevel];
  }
  static Pose between() {
    Pose pose = fixture::room_pose(15);
    pose.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
    pose.translation() += Eigen::Vector3d(0.1, 0.1, 0.2);
    return pose;
  }

  fixture::RoomCamera camera_;
  std::vector<Keyframe> places_;
};

TEST_F(PlaceView, ShowsAPlaceFromWhereNobodyStood) {
  const TrackLevel truth = truth_at(between());
  const ViewScore score(place_view(places_, truth.camera, between()), truth);
  EXPECT_GT(score.known, 0.8);
  EXPECT_GT(score.depth, 0.95);
  EXPECT_GT(score.intensity, 0.7);  // the texture is hardly wider than pixels of this level
}

TEST_F(PlaceView, WhatNobodySawIsUnknown) {
  Pose behind = fixture::room_pose(15);
  behind.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()));
  const TrackLevel view = place_view(places_, truth_at(behind).camera, behind);
  EXPECT_EQ(std::count(view.inverse_depth.begin(), view.inverse_depth.end(), 0.f),
            static_cast<std::ptrdiff_t>(view.inverse_depth.size()));
  EXPECT_EQ(std::count(view.intensity.begin(), view.intensity.end(), -1.f),
            static_cast<std::ptrdiff_t>(view.intensity.size()));
}

}  // namespace
}  // namespace ovimap
