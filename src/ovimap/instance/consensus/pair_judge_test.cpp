// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/consensus/pair_judge.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovimap {
namespace {

constexpr float kAgreement = 0.9f;
constexpr std::int64_t kEntityVertices = 300;

/// A plane piece, 40 cm wide from `left`, at z = 0, of `vertices`.
SuperPointShape piece(float left, std::int64_t vertices, double grey) {
  const auto n = static_cast<double>(vertices);
  return {.vertices = vertices,
          .position_sum = n * Eigen::Vector3d(left + 0.2, 0.2, 0),
          .normal_sum = n * Eigen::Vector3d(0, 0, 1),
          .color_sum = n * Eigen::Vector3d(grey, grey, grey),
          .box = {Eigen::Vector3f(left, 0, 0), Eigen::Vector3f(left + 0.4f, 0.4f, 0)}};
}

PointCluster cluster(SuperPointShape shape, std::vector<EntitySighting> sightings,
                     std::int64_t entity_vertices = kEntityVertices) {
  PointCluster made{{}, shape};
  for (const EntitySighting& sighting : sightings)
    made.shares.push_back({sighting, shape.vertices, entity_vertices});
  return made;
}

float at(const PairFeatures& features, PairFeature feature) {
  return features[static_cast<std::size_t>(feature)];
}

TEST(PairJudge, MeetingsAreSharedOutByWhatAFrameShows) {
  const PointCluster a = cluster(piece(0, 100, 50), {{0, 1}, {1, 1}, {2, 5}});
  PointCluster b = cluster(piece(0.4f, 50, 50), {{0, 1}, {1, 2}, {3, 1}});
  b.shares.insert(b.shares.begin() + 1,
                  {{0, 9}, 150, 150});  // three quarters of it in another entity
  const Meetings met = meetings_of(a, b);
  EXPECT_DOUBLE_EQ(met.joined, 0.25);
  EXPECT_DOUBLE_EQ(met.apart, 0.75 + 1);
  EXPECT_DOUBLE_EQ(met.fit_a, 2 * 100. / 300);
  EXPECT_DOUBLE_EQ(met.fit_b, 0.75 + 50. / 300)
      << "three quarters in an entity of its own, then little";
  EXPECT_DOUBLE_EQ(met.fit_both, 150. / 300 + 100. / 350);
}

TEST(PairJudge, UnitedClustersAddUp) {
  const PointCluster a = cluster(piece(0, 100, 50), {{0, 1}, {2, 5}});
  const PointCluster b = cluster(piece(0.4f, 50, 80), {{0, 1}, {1, 2}});
  const PointCluster both = united(a, b);
  ASSERT_EQ(both.shares.size(), 3u);
  EXPECT_EQ(both.shares[0].vertices, 150);
  EXPECT_EQ(both.shares[1].vertices, 50);
  EXPECT_EQ(both.shape.vertices, 150);
  EXPECT_FLOAT_EQ(both.shape.box.max().x(), 0.8f);
}

PairFeatures features_of(const PointCluster& a, const PointCluster& b,
                         const SuperPointBorder& border) {
  return pair_features(a, b, meetings_of(a, b), border, kAgreement);
}

TEST(PairJudge, FeaturesDoNotDependOnTheOrder) {
  const PointCluster a = cluster(piece(0, 100, 50), {{0, 1}, {2, 5}});
  const PointCluster b = cluster(piece(0.4f, 50, 80), {{0, 1}, {1, 2}, {2, 6}});
  const SuperPointBorder border{.edges = 10, .fold = -1, .color_step = 640};
  const PairFeatures features = features_of(a, b, border);
  EXPECT_EQ(features, features_of(b, a, border));
  EXPECT_FLOAT_EQ(at(features, PairFeature::kJoined), std::log(2.f));
  EXPECT_FLOAT_EQ(at(features, PairFeature::kJoinedShare), 0.5f);
  EXPECT_FLOAT_EQ(at(features, PairFeature::kSmallSize), std::log(50.f));
  EXPECT_FLOAT_EQ(at(features, PairFeature::kFold), -0.1f);
  EXPECT_FLOAT_EQ(at(features, PairFeature::kStep), 1.f);
  EXPECT_FLOAT_EQ(at(features, PairFeature::kColor), 90.f / 64);
  EXPECT_FLOAT_EQ(at(features, PairFeature::kAlign), 1.f);
  EXPECT_NEAR(at(features, PairFeature::kLargeOffset), 0, 1e-6);
  EXPECT_FLOAT_EQ(at(features, PairFeature::kGap), 0);
  for (const float value : features) EXPECT_TRUE(std::isfinite(value));
}

TEST(PairJudge, TellsPiecesOfAPlaneFromAThingOnIt) {
  std::vector<EntitySighting> one, same, other;
  for (std::uint32_t frame = 0; frame < 12; ++frame) {
    one.push_back({frame, 1});
    same.push_back({frame, 1});
    other.push_back({frame, 2});
  }
  const SuperPointBorder seam{.edges = 80, .fold = 0, .color_step = 80};
  EXPECT_GT(log_odds_of_one(features_of(cluster(piece(0, 1600, 90), one, 3200),
                                        cluster(piece(0.4f, 1600, 90), same, 3200), seam)),
            1);
  SuperPointShape mug = piece(0.1f, 300, 220);
  mug.normal_sum *= 0.2;
  mug.box = {Eigen::Vector3f(0.1f, 0.1f, 0), Eigen::Vector3f(0.18f, 0.18f, 0.1f)};
  const SuperPointBorder foot{.edges = 60, .fold = -40, .color_step = 60 * 300};
  EXPECT_LT(log_odds_of_one(features_of(cluster(piece(0, 1600, 90), one, 1600),
                                        cluster(mug, other, 300), foot)),
            -1);
}

}  // namespace
}  // namespace ovimap
