// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/visit_history.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/map/surface/mesh_extraction.h"
#include "ovimap/pipeline/mapping/furnished_fixture.h"
#include "ovimap/pipeline/mapping/tile_keeper.h"

namespace ovimap {
namespace {

const Furniture kChest = furniture(-0.9f, 0.9f, {0.6f, 0.4f, 0.5f}, {190, 120, 40});
const Furniture kRedBox = furniture(0.6f, 0.3f, {0.3f, 0.2f, 0.3f}, {220, 20, 20});
const Furniture kRedBoxAway = furniture(-0.7f, -0.7f, {0.2f, 0.3f, 0.3f}, {220, 20, 20});
const Furniture kBlueBox = furniture(0.2f, -0.9f, {0.35f, 0.25f, 0.4f}, {20, 30, 220});
const Furniture kGreenBox = furniture(1.0f, -0.5f, {0.3f, 0.4f, 0.25f}, {20, 200, 30});

FurnishedRoom room_with(std::vector<Furniture> things) {
  FurnishedRoom room;
  room.things = std::move(things);
  room.frames = 32;
  return room;
}

MapDocument continued(const FurnishedRoom& evening, const FurnishedRoom& morning,
                      bool embedded = true) {
  const MapDocument before = map_of(evening, MapDocument(), embedded);
  MapDocument after = map_of(morning, map_of(evening, MapDocument(), embedded), embedded);
  tell_visit(before, after);
  return after;
}

InstanceId at(const MapRecord& map, const Furniture& thing) {
  const Eigen::Vector3f center = thing.box.center();
  return object_at(map, Pose::Identity(), center.x(), center.y(), thing.box.max().z() * 0.7f);
}

const ObjectEvent* event_of(const MapRecord& map, InstanceId id) {
  for (const ObjectEvent& event : map.history.events)
    if (event.instance == id) return &event;
  return nullptr;
}

/// Vertices of the map's mesh well within a box.
std::size_t vertices_in(const MapDocument& map, const Furniture& thing) {
  const Eigen::AlignedBox3f box(thing.box.min().array() - 0.03f, thing.box.max().array() + 0.03f);
  std::size_t count = 0;
  for (const Eigen::Vector3f& vertex : extract_mesh(map.map).vertices)
    count += vertex.z() > 0.04f && box.contains(vertex);
  return count;
}

TEST(VisitHistory, TellsWhatMovedWentAndCameAndKeepsIds) {
  const FurnishedRoom evening = room_with({kChest, kRedBox, kBlueBox}),
                      morning = room_with({kChest, kRedBoxAway, kGreenBox});
  const MapDocument before = map_of(evening), after = continued(evening, morning);
  const InstanceId red = at(before, kRedBox), blue = at(before, kBlueBox);

  const ObjectEvent* moved = event_of(after, red);
  ASSERT_NE(moved, nullptr);
  EXPECT_EQ(moved->kind, ObjectEventKind::kMoved);
  EXPECT_EQ(moved->visit, 2);
  EXPECT_GE(moved->frame, 32);
  EXPECT_NEAR(moved->before.center().x(), 0.6f, 0.05f);
  EXPECT_NEAR(moved->after.center().x(), -0.7f, 0.05f);
  EXPECT_EQ(at(after, kRedBoxAway), red) << "it keeps its id";

  const ObjectEvent* gone = event_of(after, blue);
  ASSERT_NE(gone, nullptr);
  EXPECT_EQ(gone->kind, ObjectEventKind::kGone);
  EXPECT_TRUE(gone->after.isEmpty());
  for (const InstanceSummary& instance : after.instances)
    EXPECT_FALSE(instance.id == blue && instance.points > 100) << instance.points;

  const ObjectEvent* appeared = event_of(after, at(after, kGreenBox));
  ASSERT_NE(appeared, nullptr);
  EXPECT_EQ(appeared->kind, ObjectEventKind::kAppeared);
  EXPECT_EQ(appeared->may_be, 0u);
  EXPECT_EQ(after.history.events.size(), 3u);
  EXPECT_EQ(at(after, kChest), at(before, kChest));
}

TEST(VisitHistory, WhatWasSaidOfAThingMeanwhileStaysWithIt) {
  const FurnishedRoom evening = room_with({kChest, kRedBox}),
                      morning = room_with({kChest, kRedBoxAway});
  MapDocument before = map_of(evening);
  MapEdit earlier, meanwhile, of_both;
  earlier.instances = {at(before, kChest)};
  before.edits = {earlier};
  MapDocument after = map_of(morning, map_of(evening));
  const InstanceId found = at(after, kRedBoxAway), red = at(before, kRedBox);
  ASSERT_NE(found, red) << "while the visit lasts it is a new thing";
  meanwhile.instances = {found};
  of_both.action = EditAction::kMerge;
  of_both.instances = {found, red};
  after.edits = {earlier, meanwhile, of_both};
  tell_visit(before, after);
  ASSERT_EQ(at(after, kRedBoxAway), red);
  EXPECT_EQ(after.edits[0], earlier);
  EXPECT_EQ(after.edits[1].instances, std::vector<InstanceId>{red});
  EXPECT_EQ(after.edits[2].instances, (std::vector<InstanceId>{found, red})) << "names both";
}

TEST(VisitHistory, WhatComesToAnotherThingsPlaceIsNotThatThing) {
  // The blue box comes to where the red one was, and a little aside.
  const Furniture there = furniture(0.75f, 0.4f, {0.35f, 0.25f, 0.4f}, {20, 30, 220});
  const FurnishedRoom evening = room_with({kChest, kRedBox, kBlueBox}),
                      morning = room_with({kChest, there});
  const MapDocument before = map_of(evening), after = continued(evening, morning, false);
  const InstanceId red = at(before, kRedBox), blue = at(before, kBlueBox);
  const ObjectEvent* moved = event_of(after, blue);
  ASSERT_NE(moved, nullptr);
  EXPECT_EQ(moved->kind, ObjectEventKind::kMoved);
  EXPECT_NEAR(moved->after.center().x(), 0.75f, 0.06f);
  EXPECT_EQ(at(after, there), blue) << "it keeps its id";
  const ObjectEvent* of_red = event_of(after, red);
  EXPECT_TRUE(of_red == nullptr || of_red->kind == ObjectEventKind::kGone) << "it has not shifted";
}

TEST(VisitHistory, WhatLeftItsPlaceIsKeptAsItWas) {
  const FurnishedRoom evening = room_with({kChest, kRedBox, kBlueBox}),
                      morning = room_with({kChest, kRedBoxAway, kGreenBox});
  const MapDocument before = map_of(evening), after = continued(evening, morning);
  for (const auto& [thing, shown] : {std::pair(kRedBox, 0), std::pair(kBlueBox, 2)}) {
    const ObjectEvent* event = event_of(after, at(before, thing));
    ASSERT_NE(event, nullptr);
    ASSERT_NE(event->was, nullptr);
    EXPECT_LT((event->was->centroid - thing.box.center()).head<2>().norm(), 0.06f);
    ASSERT_GT(event->was->surface.size(), 50u);
    std::size_t colored = 0;
    for (const auto& color : event->was->colors)
      colored += color[static_cast<std::size_t>(shown)] > 150;
    EXPECT_GT(colored, event->was->colors.size() / 2) << "in its own colour";
    const Appearance look = appearance_of(after.semantics.looks, event->was->super_points);
    EXPECT_FALSE(look.views.empty()) << "its looks stay in the map";
  }
  EXPECT_EQ(event_of(after, at(after, kGreenBox))->was, nullptr) << "it was not there";
}

TEST(VisitHistory, WhatLeftLeavesNoSurface) {
  const FurnishedRoom evening = room_with({kChest, kRedBox, kBlueBox}),
                      morning = room_with({kChest, kRedBoxAway, kGreenBox});
  const MapDocument before = map_of(evening), after = map_of(morning, map_of(evening));
  for (const Furniture& thing : {kRedBox, kBlueBox}) {
    EXPECT_GT(vertices_in(before, thing), 300u);
    EXPECT_LT(vertices_in(after, thing), vertices_in(before, thing) / 50);
  }
  EXPECT_GT(vertices_in(after, kChest), vertices_in(before, kChest) * 97 / 100);
}

TEST(VisitHistory, OfScatteredRemainsNothingIsTold) {
  const FurnishedRoom evening = room_with({kChest, kRedBox, kBlueBox}),
                      morning = room_with({kChest, kRedBox});
  MapDocument before = map_of(evening), after = map_of(morning, map_of(evening));
  const InstanceId blue = at(before, kBlueBox);
  std::vector<Eigen::Vector3f> some;
  for (std::size_t i = 0; i < before.surfaces[blue].size(); i += 40)
    some.push_back(before.surfaces[blue][i]);
  before.surfaces[blue] = some;
  std::ranges::find(before.instances, blue, &InstanceSummary::id)->points = some.size();
  tell_visit(before, after);
  EXPECT_TRUE(after.history.events.empty());
  EXPECT_EQ(find_instance(after.instances, blue), nullptr) << "they go all the same";
}

TEST(VisitHistory, TellsTheSameOfMapsWhoseVoxelsLieInFiles) {
  const FurnishedRoom evening = room_with({kChest, kRedBox, kBlueBox}),
                      morning = room_with({kChest, kRedBoxAway, kGreenBox});
  const MapDocument before = map_of(evening);
  MapDocument after = map_of(morning, map_of(evening));
  const fixture::TemporaryFolder folder;
  const auto stored = [&](const MapDocument& map, const std::string& name) {
    save_map(folder.path() / name, map);
    const auto tiles = std::make_shared<TileKeeper>(folder.path() / (name + ".partial"),
                                                    TileKeeper::Start::kAnew, MemoryConfig{1});
    return load_map_in(tiles, folder.path() / name);
  };
  const MapDocument before_stored = stored(before, "before.ovimap");
  MapDocument after_stored = stored(after, "after.ovimap");
  EXPECT_EQ(before_stored.map.blocks_in_memory(), 0u);
  tell_visit(before, after);
  tell_visit(before_stored, after_stored, {},
             std::make_shared<TileKeeper>(folder.path() / "seen", TileKeeper::Start::kAnew,
                                          MemoryConfig{1}));
  EXPECT_EQ(after_stored.map.content_hash(), after.map.content_hash());
  ASSERT_EQ(after.history.events.size(), 3u);
  ASSERT_EQ(after_stored.history.events.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const ObjectEvent &told = after.history.events[i], &bounded = after_stored.history.events[i];
    EXPECT_EQ(std::tie(bounded.instance, bounded.kind, bounded.visit, bounded.frame),
              std::tie(told.instance, told.kind, told.visit, told.frame));
    ASSERT_EQ(bounded.was == nullptr, told.was == nullptr);
    if (told.was) {
      EXPECT_EQ(bounded.was->colors, told.was->colors);
    }
  }
  EXPECT_LT(before_stored.map.blocks_in_memory(), before.map.block_count());
  EXPECT_EQ(after_stored.map.content_hash(), after.map.content_hash());
}

TEST(VisitHistory, ARoomThatStaysHasNoEvents) {
  const FurnishedRoom room = room_with({kChest, kRedBox, kBlueBox});
  const MapDocument after = continued(room, room);
  EXPECT_TRUE(after.history.events.empty());
  EXPECT_EQ(after.history.visits.size(), 2u);
}

TEST(VisitHistory, WithoutEmbeddingsShapeAndColourTell) {
  const FurnishedRoom evening = room_with({kChest, kRedBox, kBlueBox}),
                      morning = room_with({kChest, kRedBoxAway, kGreenBox});
  const MapDocument before = map_of(evening, MapDocument(), false),
                    after = continued(evening, morning, false);
  const ObjectEvent* moved = event_of(after, at(before, kRedBox));
  ASSERT_NE(moved, nullptr);
  EXPECT_EQ(moved->kind, ObjectEventKind::kMoved);
  EXPECT_EQ(at(after, kRedBoxAway), at(before, kRedBox));
}

TEST(VisitHistory, WhatCameToWhereNobodyHadLookedMovedWhenSomethingGoneFitsIt) {
  const FurnishedRoom evening = room_with({kChest, kRedBox, kBlueBox}),
                      morning = room_with({kChest, kRedBoxAway, kGreenBox, kBlueBox});
  MapDocument before = map_of(evening, MapDocument(), false),
              after = map_of(morning, map_of(evening, MapDocument(), false), false);
  const InstanceId red = at(before, kRedBox);
  before.frames.clear();  // nobody bears witness of what was empty
  tell_visit(before, after);
  const ObjectEvent* moved = event_of(after, red);
  ASSERT_NE(moved, nullptr);
  EXPECT_EQ(moved->kind, ObjectEventKind::kMoved);
  EXPECT_EQ(at(after, kRedBoxAway), red);
  EXPECT_EQ(event_of(after, at(after, kGreenBox)), nullptr) << "nothing that is gone fits it";
}

TEST(VisitHistory, OfTwoAlikeNeitherIsTakenForTheOther) {
  const Furniture twin = furniture(1.0f, -0.5f, {0.3f, 0.2f, 0.3f}, {220, 20, 20}),
                  twin_away = furniture(-0.1f, -1.0f, {0.3f, 0.2f, 0.3f}, {220, 20, 20});
  const FurnishedRoom evening = room_with({kChest, kRedBox, twin}),
                      morning = room_with({kChest, kRedBoxAway, twin_away});
  const MapDocument before = map_of(evening, MapDocument(), false),
                    after = continued(evening, morning, false);
  int doubtful = 0;
  for (const ObjectEvent& event : after.history.events) {
    EXPECT_NE(event.kind, ObjectEventKind::kMoved);
    if (event.kind != ObjectEventKind::kAppeared) continue;
    doubtful += event.may_be != 0;
    EXPECT_TRUE(event.may_be == 0 || event.may_be == at(before, kRedBox) ||
                event.may_be == at(before, twin))
        << event.may_be;
  }
  EXPECT_GE(doubtful, 1);
}

TEST(VisitHistory, AVisitBeginsAfterTheFramesThatAreThere) {
  MapRecord begun;
  begun.source = "evening";
  begun.frames.resize(3);
  begun.frames.back().index = 7;
  MapHeader header;
  header.source = "morning";
  header.history.visits = {{"morning", 0, 0, 1.7e9}};
  begin_visit(begun, header);
  EXPECT_EQ(header.history.visits,
            (std::vector<MapVisit>{{"evening", 0, 0}, {"morning", 3, 8, 1.7e9}}));
}

TEST(VisitHistory, InstancesTradeIdsEverywhere) {
  MapRecord record;
  record.instances.resize(2);
  record.instances[0].id = 2, record.instances[0].points = 20;
  record.instances[1].id = 5, record.instances[1].points = 50;
  record.surfaces = {{2, {Eigen::Vector3f(2, 2, 2)}}};
  record.registry.super_points[7].votes = {{2, 3}, {4, 1}};
  record.registry.super_points[8].votes = {{5, 6}};
  record.registry.aliases = {{3, 2}, {4, 3}, {6, 5}};
  swap_instances(record, 2, 5);
  EXPECT_EQ(record.instances[0].id, 2u);
  EXPECT_EQ(record.instances[0].points, 50u);
  EXPECT_EQ(record.instances[1].id, 3u) << "its aliases are older than 5";
  EXPECT_TRUE(record.surfaces.contains(3));
  EXPECT_EQ(record.registry.super_points[7].votes, (std::map<InstanceId, int>{{4, 1}, {5, 3}}));
  EXPECT_EQ(record.registry.super_points[8].votes, (std::map<InstanceId, int>{{2, 6}}));
  EXPECT_EQ(record.registry.aliases, (std::map<InstanceId, InstanceId>{{4, 3}, {5, 3}, {6, 2}}));
}

TEST(VisitHistory, WhatTakesAnothersPlaceGoesByNoneOfItsIds) {
  MapRecord record;
  record.registry.last_id = 80;
  record.instances.resize(1);
  record.instances[0].id = 24;
  record.registry.super_points[7].votes = {{24, 3}};
  record.registry.super_points[8].votes = {{33, 5}};  // of what was there before as well
  record.registry.super_points[9].votes = {{70, 6}};
  record.registry.aliases = {{33, 24}, {70, 24}};
  take_place(record, 61, 24);
  EXPECT_EQ(record.instances[0].id, 61u);
  EXPECT_EQ(record.registry.super_points[7].votes, (std::map<InstanceId, int>{{61, 3}}));
  EXPECT_EQ(record.registry.super_points[8].votes, (std::map<InstanceId, int>{{81, 5}}));
  EXPECT_EQ(record.registry.super_points[9].votes, (std::map<InstanceId, int>{{70, 6}}));
  EXPECT_EQ(record.registry.aliases,
            (std::map<InstanceId, InstanceId>{{33, 24}, {70, 61}, {81, 61}}));
  EXPECT_EQ(record.registry.last_id, 81u);
}

}  // namespace
}  // namespace ovimap
