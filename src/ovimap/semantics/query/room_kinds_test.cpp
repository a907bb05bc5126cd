// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/room_kinds.h"

#include <gtest/gtest.h>

#include "ovimap/semantics/query/query_engine.h"
#include "ovimap/semantics/query/query_fixture.h"

namespace ovimap {
namespace {

std::size_t kind(const std::string& name) {
  return *wanted_room(name)->kind;
}

TEST(RoomKinds, EveryThingIsKnown) {
  for (const RoomKind& kind : room_kinds()) {
    EXPECT_FALSE(kind.names.empty());
    for (const std::string& thing : kind.things)
      EXPECT_FALSE(builtin_concepts().kinds_of(thing).empty()) << thing;
  }
}

TEST(RoomKinds, RoomsAreCalledByKindOrNumber) {
  EXPECT_EQ(kind("the Lounge"), kind("living room"));
  EXPECT_EQ(wanted_room("room 12")->number, 12);
  for (const char* none : {"mug", "room", "room twelve", "kitchen table", ""})
    EXPECT_FALSE(wanted_room(none)) << none;
}

TEST(RoomKinds, NamesThatPeopleGaveSayWhatARoomIs) {
  std::vector<SearchObject> objects(5);
  const char* names[] = {"old stove", "fridge", "bed", "sofa", "mug"};
  for (std::size_t i = 0; i < objects.size(); ++i) {
    objects[i].id = static_cast<InstanceId>(10 + i);
    objects[i].name = names[i];
  }
  const std::vector<int> room_of = {1, 1, 2, 0, 3};
  const std::vector<RoomFit> fits = fit_rooms(room_of, objects, nullptr);
  ASSERT_EQ(fits.size(), 3u);
  EXPECT_EQ(fits[0].kind(), kind("kitchen"));
  EXPECT_NEAR(fits[0].chances[kind("kitchen")], 2.f / 2.5f, 1e-5f);
  EXPECT_EQ(describe_room(1, fits[0], objects), "room 1, a kitchen by #10 #11");
  EXPECT_EQ(fits[1].kind(), kind("bedroom"));
  EXPECT_FALSE(fits[2].kind());
  EXPECT_EQ(describe_room(3, fits[2], objects), "room 3");
}

/// A kitchen and a bedroom with a mug each, and a mug in none.
class RoomQueryTest : public ::testing::Test {
 protected:
  RoomQueryTest() : index_(map_of({"stove", "mug", "bed", "mug", "mug", "refrigerator"})) {
    scene_ = scene_of_boxes(index_, Eigen::Vector3f::UnitZ());
    scene_.rooms =
        std::make_shared<const ObjectRooms>([] { return std::vector<int>{1, 1, 2, 2, 0, 1}; });
    QueryConfig config;
    config.evidence.size_weight = 0.f;
    engine_.emplace(index_, &encoder_, config, Embeddings(), scene_);
  }
  std::vector<InstanceId> found(const std::string& text) {
    const QueryAnswer answer = engine_->find({text, {}, false});
    std::vector<InstanceId> ids;
    if (answer.verdict == Verdict::kFound)
      for (const QueryMatch& match : answer.matches)
        if (match.probability > 0.3) ids.push_back(match.id);
    return ids;
  }

  WordEncoder encoder_;
  SearchIndex index_;
  QueryScene scene_;
  std::optional<QueryEngine> engine_;
};

TEST_F(RoomQueryTest, FindsThingsInRooms) {
  EXPECT_EQ(found("mug in the kitchen"), std::vector<InstanceId>{2});
  EXPECT_EQ(found("mug in the bedroom"), std::vector<InstanceId>{4});
  EXPECT_EQ(found("mug in room 2"), std::vector<InstanceId>{4});
}

TEST_F(RoomQueryTest, SaysThatThereIsNoSuchRoom) {
  const QueryAnswer answer = engine_->find({"mug in the bathroom", {}, false});
  EXPECT_EQ(answer.verdict, Verdict::kNotInMap);
  EXPECT_EQ(answer.reason, "no [bathroom] in the map");
}

}  // namespace
}  // namespace ovimap
