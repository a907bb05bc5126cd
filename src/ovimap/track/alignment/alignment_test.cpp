// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/alignment/alignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ovimap/base/parallel.h"
#include "ovimap/geometry/pose.h"
#include "ovimap/track/alignment/plain_residuals.h"
#include "ovimap/track/room_camera_fixture.h"

namespace ovimap {
namespace {

Pose moved(double x, double y, double z, double rx, double ry, double rz) {
  Vector6d motion;
  motion << x, y, z, rx, ry, rz;
  return small_motion(motion);
}

struct Scene {
  explicit Scene(bool textured = true) { camera.textured = textured; }

  Reference reference() const {
    return make_reference(make_pyramid(camera.take(start)), {}, Pose::Identity());
  }
  TrackPyramid seen_from(const Pose& motion) const {
    return make_pyramid(camera.take(start * motion));
  }

  fixture::RoomCamera camera;
  Pose start = fixture::room_pose(10);
};

TEST(Alignment, FindsTheMotionOfACamera) {
  const Scene scene;
  const Pose motion = moved(0.03, -0.02, 0.04, 0.02, -0.03, 0.015);
  const Alignment found = align(scene.reference(), scene.seen_from(motion), Pose::Identity(), {});
  EXPECT_LT(fixture::distance_m(found.reference_from_frame, motion), 0.002);
  EXPECT_LT(fixture::angle_rad(found.reference_from_frame, motion), 0.002);
  EXPECT_EQ(found.degenerate, 0);
  EXPECT_GT(found.quality.agreement, 0.9);
  EXPECT_GT(found.quality.correlation, 0.9);
}

TEST(Alignment, FindsItByDepthAlone) {
  Scene scene(false);
  scene.start.linear() = shortest_turn(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(2.5, 1, 2.5))
                             .matrix();  // into a corner
  const Pose motion = moved(0.02, -0.01, 0.03, 0.01, -0.02, 0.01);
  const Alignment found = align(scene.reference(), scene.seen_from(motion), Pose::Identity(), {});
  EXPECT_LT(fixture::distance_m(found.reference_from_frame, motion), 0.004);
  EXPECT_LT(fixture::angle_rad(found.reference_from_frame, motion), 0.004);
}

TEST(Alignment, IsTheSameForAnyNumberOfThreads) {
  const Scene scene;
  const Reference reference = scene.reference();
  const TrackPyramid frame = scene.seen_from(moved(0.02, 0.01, 0, 0, 0.02, 0));
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return align(reference, frame, Pose::Identity(), {});
  };
  const Alignment one = with(1), many = with(4);
  EXPECT_EQ(one.reference_from_frame.matrix(), many.reference_from_frame.matrix());
  EXPECT_EQ(one.information, many.information);
}

/// A wall straight ahead without texture says how far it is and how it is turned, no more.
TEST(Alignment, LeavesWhatABlankWallDoesNotTellToThePrediction) {
  Frame wall;
  wall.depth_camera = wall.color_camera = {160, 120, 140.f, 140.f, 79.5f, 59.5f};
  wall.depth = DepthImage(160, 120, 1.5f);
  wall.color = RgbImage(160, 120, {128, 128, 128});
  const Reference reference = make_reference(make_pyramid(wall), {}, Pose::Identity());
  wall.depth.fill(1.48f);  // the camera went 2 cm towards it
  const Alignment found =
      align(reference, make_pyramid(wall), moved(0.03, -0.02, 0, 0, 0, 0.02), {});
  EXPECT_EQ(found.degenerate, 3);
  const Vector6d motion = motion_of(found.reference_from_frame);
  EXPECT_NEAR(motion[2], 0.02, 0.001);
  EXPECT_NEAR(motion[0], 0.03, 0.001);
  EXPECT_NEAR(motion[1], -0.02, 0.001);
  EXPECT_NEAR(motion[5], 0.02, 0.001);
}

TEST(Alignment, TellsAWrongPlaceByItsQuality) {
  const Scene scene;
  const Pose away = moved(0.8, 0, 0.3, 0, 1.2, 0);
  const Alignment found = align(scene.reference(), scene.seen_from(away), Pose::Identity(), {});
  EXPECT_LT(std::min(found.quality.agreement, found.quality.correlation), 0.5);
}

/// A view from beside the reference: points leave the image at its edge and behind things.
struct Beside {
  Beside() : reference(scene.reference()), frame(scene.seen_from(motion)) {
    scale.geometric = 2, scale.gain = 1.1f, scale.bias = -3;
  }

  Scene scene;
  Pose motion = moved(0.1, 0, 0.1, 0, 0.2, 0), guess = moved(0.11, 0, 0.09, 0, 0.21, 0);
  Reference reference;
  TrackPyramid frame;
  ResidualScale scale;
};

TEST(Residuals, OfEachPointAreThoseOfThePlainWalk) {
  const Beside view;
  const Eigen::Isometry3f forth = view.guess.cast<float>(),
                          back = view.guess.inverse().cast<float>();
  std::size_t near = 0, unseen = 0;
  for (std::size_t level = 0; level < view.frame.size(); ++level) {
    const ReferenceLevel& reference = view.reference.levels[level];
    const std::vector<PointResidual> fast =
        point_residuals(reference, view.frame[level], view.guess, {}, 1.f);
    ASSERT_EQ(fast.size(), reference.points.size());
    for (std::size_t i = 0; i < fast.size(); ++i) {
      const PointResidual plain =
          plain_residual(reference.points[i], view.frame[level], forth, back, {}, 1.f);
      ASSERT_EQ(fast[i].seen, plain.seen);
      ASSERT_EQ(fast[i].measured, plain.measured);
      ASSERT_EQ(fast[i].near, plain.near);
      ASSERT_EQ(fast[i].textured, plain.textured);
      if (plain.textured) {
        EXPECT_NEAR(fast[i].intensity, plain.intensity, 0.01);
      }
      if (plain.measured) {
        EXPECT_NEAR(fast[i].distance_m, plain.distance_m, 1e-5);
        EXPECT_NEAR(fast[i].sigma_m, plain.sigma_m, 1e-6);
      }
      near += plain.near, unseen += !plain.seen;
    }
  }
  EXPECT_GT(near, 1000U);
  EXPECT_GT(unseen, 1000U);
}

TEST(Residuals, AddUpToThoseOfThePlainWalk) {
  const Beside view;
  for (std::size_t level = 0; level < view.frame.size(); ++level) {
    const ReferenceLevel& reference = view.reference.levels[level];
    const ResidualSums plain =
        plain_sum_residuals(reference, view.frame[level], view.guess, view.scale, {});
    const ResidualSums fast =
        sum_residuals(reference, view.frame[level], view.guess, view.scale, {}, true);
    EXPECT_EQ(plain.points, fast.points);
    EXPECT_EQ(plain.seen, fast.seen);
    EXPECT_EQ(plain.measured, fast.measured);
    EXPECT_EQ(plain.photometric_count, fast.photometric_count);
    EXPECT_NEAR(plain.agreeing, fast.agreeing, 1);  // a hair off the bound
    EXPECT_NEAR(plain.products, fast.products, 1e-4 * plain.products);
    EXPECT_LT((plain.h - fast.h).norm(), 1e-3 * plain.h.norm());
    EXPECT_LT((plain.b - fast.b).norm(), 1e-3 * plain.b.norm());
    const ResidualSums cost =
        sum_residuals(reference, view.frame[level], view.guess, view.scale, {}, false);
    EXPECT_NEAR(plain.cost, cost.cost, 1e-4 * plain.cost);
  }
}

constexpr float kModelSigma_m = 0.003f;

/// What a map shows that is `off` standard deviations behind a level's depth, and up to one more
/// this way and that.
float behind(float inverse_depth, float off, std::size_t pixel) {
  const float depth = 1 / inverse_depth, various = static_cast<float>(pixel % 5) / 2 - 1;
  const float sigma = std::hypot(DepthNoiseConfig{}.sigma_m(depth), kModelSigma_m);
  return 1 / (depth + (off + various) * sigma);
}

Image<float> model_of(const TrackLevel& level, float off) {
  Image<float> model = level.inverse_depth;
  for (std::size_t i = 0; i < model.size(); ++i)
    if (model[i] > 0) model[i] = behind(model[i], off, i);
  return model;
}

/// A map and a frame of the same place. A part of the columns is changed in one or the other.
class Contradictions : public ::testing::Test {
 protected:
  void settle() {
    before_ = model_;
    settle_contradictions({}, kModelSigma_m, model_, level_);
  }
  bool as_before(int from) const {
    for (int y = 0; y < model_.height(); ++y)
      for (int x = from; x < model_.width(); ++x)
        if (model_.at(x, y) != before_.at(x, y) || level_.inverse_depth.at(x, y) == 0) return false;
    return true;
  }
  static bool is_gone(const Image<float>& image) {
    for (int y = 0; y < image.height(); ++y)
      if (std::any_of(image.row(y), image.row(y) + kChanged, [](float v) { return v != 0; }))
        return false;
    return true;
  }
  void map_is(float off) {
    const Image<float> wrong = model_of(level_, off);
    for (int y = 0; y < model_.height(); ++y) std::copy_n(wrong.row(y), kChanged, model_.row(y));
  }

  static constexpr int kChanged = 20;
  const Scene scene_;
  TrackLevel level_ = make_pyramid(scene_.camera.take(scene_.start))[kSurfaceLevel];
  Image<float> model_ = model_of(level_, 0), before_;
};

/// The far side of a thin thing, which comes out on this one.
TEST_F(Contradictions, WhatTheFrameSeesThroughGoes) {
  map_is(-6);
  settle();
  EXPECT_TRUE(is_gone(model_));
  EXPECT_FALSE(is_gone(level_.inverse_depth));
  EXPECT_TRUE(as_before(kChanged));
}

TEST_F(Contradictions, AMapThatHasTheSameSurfaceTooFarGoes) {
  map_is(6);
  settle();
  EXPECT_TRUE(is_gone(model_));
  EXPECT_FALSE(is_gone(level_.inverse_depth));
  EXPECT_TRUE(as_before(kChanged));
}

/// Somebody who walks by must not be what the next frame is held against, nor the wall behind with
/// the looks of somebody.
TEST_F(Contradictions, WhatSomethingHidesGoesWithIt) {
  for (int y = 0; y < model_.height(); ++y)
    for (int x = 0; x < kChanged; ++x) level_.inverse_depth.at(x, y) *= 2;
  settle();
  EXPECT_TRUE(is_gone(model_));
  EXPECT_TRUE(is_gone(level_.inverse_depth));
  EXPECT_TRUE(as_before(kChanged));
}

TEST_F(Contradictions, AMapThatIsOffAsAWholeStays) {
  model_ = model_of(level_, -6);
  settle();
  EXPECT_TRUE(as_before(0));
}

/// However alike the two are elsewhere.
TEST_F(Contradictions, WhatTheNoiseOfASensorExplainsStays) {
  model_ = level_.inverse_depth;
  map_is(-1);
  settle();
  EXPECT_TRUE(as_before(0));
}

TEST_F(Contradictions, WhatTheFrameSaysNothingOfStays) {
  model_ = model_of(level_, -50);
  level_.inverse_depth.fill(0);
  settle();
  EXPECT_TRUE(std::equal(model_.begin(), model_.end(), before_.begin()));
}

TEST(NormalEquations, SmallMotionsAreTakenBack) {
  Vector6d motion;
  motion << 0.1, -0.2, 0.3, 0.3, 0.2, -0.1;
  EXPECT_LT((motion_of(small_motion(motion)) - motion).norm(), 1e-12);
  EXPECT_EQ(motion_of(Pose::Identity()), Vector6d::Zero());
}

}  // namespace
}  // namespace ovimap
