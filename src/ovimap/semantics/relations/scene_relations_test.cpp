// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/scene_relations.h"

#include <set>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

using Point = Eigen::Vector3f;

ObjectShape box_shape(const Point& low, const Point& high) {
  const Eigen::AlignedBox3f bounds(low, high);
  return shape_of_box(Eigen::Matrix3f::Identity(), bounds, bounds.center());
}

const std::vector<InstanceId> kIds = {3, 5, 8, 9};
const std::vector<ObjectShape> kRoom = {
    box_shape({0, 0, 0}, {1.6f, 0.8f, 0.75f}),            // 3: a table
    box_shape({0.3f, 0.3f, 0.76f}, {0.4f, 0.4f, 0.86f}),  // 5: a mug on it
    box_shape({0.4f, -0.7f, 0}, {0.8f, -0.3f, 0.9f}),     // 8: a chair beside it
    box_shape({9, 9, 0}, {9.5f, 9.5f, 1}),                // 9: far away
};

std::vector<std::string> said(const std::vector<ObjectRelation>& relations) {
  std::vector<std::string> result;
  for (const ObjectRelation& r : relations)
    result.push_back(concat(r.object, " ", static_cast<int>(r.relation), " ", r.anchor));
  return result;
}

std::string say(InstanceId a, Relation relation, InstanceId b) {
  return concat(a, " ", static_cast<int>(relation), " ", b);
}

TEST(SceneRelations, SayEachThingOnce) {
  const auto relations = find_relations(kIds, kRoom);
  const auto list = said(relations);
  const auto count = [&](const std::string& what) {
    return std::count(list.begin(), list.end(), what);
  };
  EXPECT_EQ(count(say(5, Relation::kOn, 3)), 1);
  EXPECT_EQ(count(say(8, Relation::kBeside, 3)), 1);
  EXPECT_EQ(count(say(3, Relation::kBeside, 8)), 0);  // follows from the reverse
  EXPECT_EQ(count(say(5, Relation::kNear, 3)), 0);    // it is on it
  EXPECT_EQ(count(say(3, Relation::kNear, 5)), 0);
  for (const ObjectRelation& relation : relations) {
    EXPECT_NE(relation.object, 9u);
    EXPECT_NE(relation.anchor, 9u);
    EXPECT_GE(relation.score, 0.5f);
    EXPECT_FALSE(relation.evidence.empty());
  }
}

TEST(SceneRelations, AreThoseOfEveryPairJudgedAlone) {
  // Leaving pairs out that are far apart must not change which are related.
  std::set<std::pair<InstanceId, InstanceId>> alone, found;
  for (std::size_t a = 0; a < kIds.size(); ++a)
    for (std::size_t b = 0; b < kIds.size(); ++b)
      for (const Relation relation : {Relation::kOn, Relation::kInside, Relation::kAbove})
        if (a != b && rate_relation(relation, kRoom[a], kRoom[b], kIds[b], {}, {}).score >= 0.5f)
          alone.emplace(kIds[a], kIds[b]);
  for (const ObjectRelation& r : find_relations(kIds, kRoom))
    if (r.relation != Relation::kBeside && r.relation != Relation::kNear) {
      EXPECT_TRUE(found.emplace(r.object, r.anchor).second);
    }
  EXPECT_EQ(found, alone);
  EXPECT_TRUE(find_relations({}, {}).empty());
}

}  // namespace
}  // namespace ovimap
