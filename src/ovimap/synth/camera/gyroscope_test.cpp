// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/camera/gyroscope.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/synth/buildings/room_builder.h"

namespace ovimap {
namespace {

class GyroscopeTest : public testing::Test {
 protected:
  static Walk whipped_walk() {
    const SynthRoom room = build_room(room_spec("bare"));
    WalkConfig config;
    config.whip_rad_s = 2.1f;
    config.seconds = 8;
    return plan_walk(room, RayScene(room.objects), {64, 48, 48, 48, 31.5f, 23.5f}, config);
  }
  std::vector<TurnRate> samples(float noise, float offset) const {
    return gyroscope_samples(walk_, {200, noise, offset}, 5);
  }

  const Walk walk_ = whipped_walk();
};

TEST_F(GyroscopeTest, WithoutErrorsItsTurnsAddUpToTheWalk) {
  const OrientationTimeline timeline(samples(0, 0));
  const Eigen::Quaterniond first(walk_.at(0).linear());
  for (const double t : {0.7, 1.5, 4.4, 7.9}) {
    const Eigen::Quaterniond turned = first.conjugate() * Eigen::Quaterniond(walk_.at(t).linear());
    EXPECT_LT(timeline.at(t)->angularDistance(turned), 1e-3) << t;
  }
}

TEST_F(GyroscopeTest, ErrsAsItsDataSheetSays) {
  constexpr float kNoise = 0.000244f;
  const auto truth = samples(0, 0), noisy = samples(kNoise, 0), both = samples(kNoise, 0.0175f);
  ASSERT_EQ(truth.size(), noisy.size());
  double squares = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    squares += (noisy[i].rad_per_s - truth[i].rad_per_s).squaredNorm();
    sum += both[i].rad_per_s - noisy[i].rad_per_s;
  }
  const auto count = static_cast<double>(truth.size());
  EXPECT_NEAR(std::sqrt(squares / (3 * count)), double{kNoise} * 10, double{kNoise});
  EXPECT_GT((sum / count).norm(), 0.002);  // of some 0.03: the seed's
  EXPECT_LT((sum / count).norm(), 0.07);
  EXPECT_TRUE((both[0].rad_per_s - noisy[0].rad_per_s).isApprox(sum / count, 1e-6));
}

TEST_F(GyroscopeTest, ACameraMayHaveNone) {
  EXPECT_TRUE(gyroscope_samples(walk_, {}, 5).empty());
}

}  // namespace
}  // namespace ovimap
