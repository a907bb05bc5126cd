// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/consensus/judged_contraction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace ovimap {
namespace {

constexpr double kApartWeight = 0.5;
constexpr std::uint8_t kRating = 200;

std::vector<Label> roots_of(const EntitySightings& sightings) {
  std::vector<Label> roots;
  for (const auto& [root, seen] : sightings) roots.push_back(root);
  return roots;
}

/// What a judge says of two clusters by features that change when they grow.
float plain_odds(const PairFeatures& features) {
  const auto at = [&](PairFeature feature) { return features[static_cast<std::size_t>(feature)]; };
  return at(PairFeature::kJoinedShare) - 0.45f + 0.1f * at(PairFeature::kContact) -
         0.02f * at(PairFeature::kLargeSize) + 0.1f * at(PairFeature::kFitBoth);
}

class PlainJudge : public PairJudge {
 public:
  float log_odds(const PairFeatures& features, Label, Label) override {
    return plain_odds(features);
  }
};

/// The same by its definition: all pairs looked at anew before each union.
std::map<Label, Label> plain_objects(const EntitySightings& sightings,
                                     const SuperPointShapes& shapes) {
  struct Group {
    PointCluster cluster;
    std::vector<Label> members;
  };
  std::map<Label, Group> groups;
  std::map<std::pair<Label, Label>, SuperPointBorder> borders;
  for (const auto& [root, seen] : sightings) {
    Group& group = groups[root];
    group.cluster.shape = shapes.of.at(root);
    for (const EntitySighting& sighting : seen)
      group.cluster.shares.push_back({sighting, group.cluster.shape.vertices, 0});
    group.members = {root};
  }
  for (auto& [root, group] : groups)
    for (EntityShare& share : group.cluster.shares)
      for (const auto& [other, seen] : sightings)
        share.entity_vertices +=
            shapes.of.at(other).vertices * std::count(seen.begin(), seen.end(), share.sighting);
  const auto neighbours = [&](const Group& a, const Group& b, SuperPointBorder& border) {
    bool near = false;
    for (const Label x : a.members)
      for (const Label y : b.members) {
        const auto touching = shapes.borders.find(std::minmax(x, y));
        if (touching != shapes.borders.end()) border += touching->second, near = true;
        for (const EntitySighting& sighting : sightings.at(x))
          near = near || std::count(sightings.at(y).begin(), sightings.at(y).end(), sighting) > 0;
      }
    return near;
  };
  while (true) {
    float best = 0;
    std::pair<Label, Label> chosen;
    for (auto a = groups.begin(); a != groups.end(); ++a)
      for (auto b = std::next(a); b != groups.end(); ++b) {
        SuperPointBorder border;
        if (!neighbours(a->second, b->second, border)) continue;
        const float odds =
            plain_odds(pair_features(a->second.cluster, b->second.cluster,
                                     meetings_of(a->second.cluster, b->second.cluster), border, 1));
        if (odds > best) best = odds, chosen = {a->first, b->first};
      }
    if (best <= 0) break;
    Group& old = groups.at(chosen.first);
    Group& young = groups.at(chosen.second);
    old.cluster = united(old.cluster, young.cluster);
    old.members.insert(old.members.end(), young.members.begin(), young.members.end());
    groups.erase(chosen.second);
  }
  std::map<Label, Label> objects;
  for (const auto& [object, group] : groups)
    for (const Label root : group.members) objects[root] = object;
  return objects;
}

SuperPointShape shape_at(double x, std::int64_t vertices) {
  const auto n = static_cast<double>(vertices);
  const Eigen::Vector3f corner(static_cast<float>(x), 0, 0);
  return {.vertices = vertices,
          .position_sum = n * Eigen::Vector3d(x, 0, 0),
          .normal_sum = n * Eigen::Vector3d(0, 0, 1),
          .color_sum = n * Eigen::Vector3d(90, 90, 90),
          .box = {corner, corner + Eigen::Vector3f(0.1f, 0.1f, 0)}};
}

TEST(JudgedContraction, IsThePlainOneOnRandomSightings) {
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    constexpr Label kRoots = 14;
    EntitySightings sightings;
    SuperPointShapes shapes;
    for (Label root = 1; root <= kRoots; ++root) {
      shapes.of[root] = shape_at(0.1 * root, 20 + static_cast<std::int64_t>(random() % 500));
      sightings[root];
      for (std::uint32_t frame = 0; frame < 12; ++frame)
        if (random() % 3 != 0)
          sightings[root].push_back(
              {frame, static_cast<std::uint16_t>(1 + root / 4 + (random() % 4 == 0)), kRating});
      if (root > 1 && random() % 4 != 0)
        shapes.borders[{root - 1, root}] = {static_cast<std::int64_t>(1 + random() % 40), 0, 0};
    }
    PlainJudge judge;
    EXPECT_EQ(contract_by_judge(roots_of(sightings), sightings, true, shapes, kApartWeight, judge),
              plain_objects(sightings, shapes))
        << "round " << round;
  }
}

/// Says the same of all.
class SureJudge : public PairJudge {
 public:
  explicit SureJudge(float odds) : odds_(odds) {}
  float log_odds(const PairFeatures&, Label, Label) override { return odds_; }

 private:
  float odds_;
};

TEST(JudgedContraction, UnratedMasksThatAllSayTheSameAreBelieved) {
  SuperPointShapes shapes;
  for (const Label root : {1u, 2u}) shapes.of[root] = shape_at(0.1 * root, 100);
  shapes.borders[{1, 2}] = {10, 0, 0};
  const auto are_one = [&](int joined, int apart, std::uint8_t rating, float odds,
                           bool masked = true) {
    EntitySightings sightings;
    for (int i = 0; i < joined + apart; ++i) {
      const auto frame = static_cast<std::uint32_t>(i);
      sightings[1].push_back({frame, 1, rating});
      sightings[2].push_back({frame, static_cast<std::uint16_t>(i < joined ? 1 : 2), rating});
    }
    SureJudge judge(odds);
    return contract_by_judge(roots_of(sightings), sightings, masked, shapes, kApartWeight, judge)
               .at(2) == 1;
  };
  EXPECT_TRUE(are_one(3, 0, kHighestRating, -1));
  EXPECT_FALSE(are_one(2, 0, kHighestRating, -1)) << "too few";
  EXPECT_FALSE(are_one(9, 1, kHighestRating, -1)) << "not all";
  EXPECT_FALSE(are_one(3, 0, kRating, -1)) << "of a network";
  EXPECT_FALSE(are_one(0, 3, kHighestRating, 1));
  EXPECT_TRUE(are_one(0, 2, kHighestRating, 1));
  EXPECT_TRUE(are_one(0, 3, kRating, 1));
  EXPECT_TRUE(are_one(0, 3, kHighestRating, 1, false)) << "regions of depth are parts of things";
}

TEST(JudgedContraction, WhatHasNoSurfaceIsToldByMasksAlone) {
  const EntitySightings sightings = {
      {1, {{0, 1}, {1, 1}}}, {2, {{0, 1}, {1, 2}}}, {3, {{0, 2}, {1, 3}}}};
  SureJudge refusing(-1);
  const std::map<Label, Label> objects =
      contract_by_judge(roots_of(sightings), sightings, true, {}, kApartWeight, refusing);
  EXPECT_EQ(objects, (std::map<Label, Label>{{1, 1}, {2, 1}, {3, 3}}));
}

TEST(JudgedContraction, AUnionIsToldToTheJudge) {
  const EntitySightings sightings = {{1, {{0, 1}}}, {2, {{0, 1}}}, {5, {{0, 2}}}};
  SuperPointShapes shapes;
  for (const Label root : {1u, 2u, 5u}) shapes.of[root] = shape_at(0.1 * root, 100);
  struct Listening : PlainJudge {
    void united(Label old, Label young) override { unions.emplace_back(old, young); }
    std::vector<std::pair<Label, Label>> unions;
  } judge;
  contract_by_judge(roots_of(sightings), sightings, true, shapes, kApartWeight, judge);
  EXPECT_EQ(judge.unions, (std::vector<std::pair<Label, Label>>{{1, 2}}));
}

}  // namespace
}  // namespace ovimap
