// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_registry.h"

#include <random>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

struct Piece {
  Label label;
  std::uint16_t entity;
  int area_px;
  std::vector<Label> overlapped = {};
  std::vector<ShownLabel> also_shown = {};  ///< besides its own label
};

class RegistryTest : public ::testing::Test {
 protected:
  RegistryTest() {
    for (int i = 0; i < 9; ++i) forest_.create();
  }

  void see(InstanceRegistry& registry, const std::vector<Piece>& pieces, bool has_entities = true) {
    Segments segments;
    std::vector<SegmentAssociation> associations;
    for (const Piece& piece : pieces) {
      segments.segments.push_back({piece.entity, piece.area_px});
      associations.push_back({piece.label, false, piece.overlapped, piece.also_shown});
      associations.back().shown.push_back({piece.label, piece.area_px});
    }
    registry.observe(segments, associations, frame_++, has_entities, forest_);
  }

  LabelForest forest_;
  std::int64_t frame_ = 0;
};

TEST_F(RegistryTest, PiecesOfOneEntityBecomeOneInstance) {
  InstanceRegistry registry;
  for (int i = 0; i < 3; ++i) see(registry, {{1, 7, 500}, {2, 7, 100}, {3, 8, 200}, {4, 0, 900}});
  EXPECT_NE(registry.instance_of(1), 0u);
  EXPECT_EQ(registry.instance_of(1), registry.instance_of(2));
  EXPECT_NE(registry.instance_of(3), registry.instance_of(1));
  EXPECT_EQ(registry.instance_of(4), 0u) << "background";
  EXPECT_EQ(registry.record(registry.instance_of(1)).views, 3);
}

TEST_F(RegistryTest, TheSameInstanceIsRecognisedWhateverTheEntityIsCalled) {
  InstanceRegistry registry;
  see(registry, {{1, 7, 500}});
  const InstanceId id = registry.instance_of(1);
  see(registry, {{1, 3, 500}, {2, 7, 300}});
  EXPECT_EQ(registry.instance_of(1), id);
  EXPECT_NE(registry.instance_of(2), id);
}

TEST_F(RegistryTest, VotesNeverGiveTwoEntitiesOfAFrameOneInstance) {
  InstanceConfig config;
  config.instances = InstanceReading::kEntityVotes;
  InstanceRegistry registry(config);
  see(registry, {{1, 5, 500}, {2, 5, 400}});
  see(registry, {{1, 5, 500}, {2, 6, 400}});
  see(registry, {{1, 5, 500}, {2, 6, 400}});
  EXPECT_NE(registry.instance_of(1), registry.instance_of(2));
}

TEST_F(RegistryTest, PiecesThatShareASuperPointCountOnce) {
  InstanceRegistry registry;
  see(registry, {{1, 7, 500}, {1, 7, 300}, {1, 0, 200}});
  EXPECT_EQ(registry.super_points().at(1).frames_seen, 1);
  EXPECT_EQ(registry.super_points().at(1).votes.at(registry.instance_of(1)), 1);
}

TEST_F(RegistryTest, RareVotesAreNoInstance) {
  InstanceRegistry registry;
  see(registry, {{1, 7, 500}});
  for (int i = 0; i < 11; ++i) see(registry, {{1, 0, 500}});
  EXPECT_EQ(registry.instance_of(1), 0u) << "one vote against eleven frames without";
}

TEST_F(RegistryTest, AnObjectGoesByItsOldestIdAndItsPartsAreAliasesWhileTheyBelongToIt) {
  InstanceRegistry registry;
  see(registry, {{1, 5, 500}, {2, 6, 400}});
  const InstanceId older = registry.instance_of(1), younger = registry.instance_of(2);
  EXPECT_NE(older, younger);
  see(registry, {{1, 5, 500}, {2, 5, 400}});
  EXPECT_EQ(registry.instance_of(2), older);
  EXPECT_EQ(registry.resolve(younger), older);
  EXPECT_EQ(registry.instances().size(), 1u);
  EXPECT_EQ(registry.record(older).last_frame, 1);
  for (int i = 0; i < 2; ++i) see(registry, {{1, 5, 500}, {2, 6, 400}});
  EXPECT_EQ(registry.instance_of(2), younger) << "most frames keep it apart: its own id is back";
  EXPECT_EQ(registry.resolve(younger), younger);
}

TEST_F(RegistryTest, APartThatLeavesTakesItsOwnRecordAlong) {
  InstanceRegistry registry;
  see(registry, {{1, 5, 500}});
  see(registry, {{1, 5, 500}, {2, 5, 400}});  // in one entity: one object
  see(registry, {{2, 5, 400}});
  const InstanceId older = registry.instance_of(1);
  ASSERT_EQ(registry.instance_of(2), older);
  EXPECT_EQ(registry.super_points_of(older), (std::vector<Label>{1, 2}));
  EXPECT_EQ(registry.record(older).views, 3);
  EXPECT_TRUE(registry.seen_in(older, 3)) << "by both its super-points, by neither alone";
  EXPECT_FALSE(registry.seen_in(older, 4));
  EXPECT_TRUE(registry.seen_in(older, 0));
  EXPECT_EQ(registry.record(older).last_frame, 2);
  for (int i = 0; i < 3; ++i) see(registry, {{2, 6, 400}, {1, 5, 500}});  // apart after all
  const InstanceId younger = registry.instance_of(2);
  ASSERT_NE(younger, older);
  EXPECT_EQ(registry.super_points_of(older), (std::vector<Label>{1}));
  EXPECT_EQ(registry.record(older).views, 5) << "not those of the part that left";
  EXPECT_EQ(registry.record(younger).views, 5);
  EXPECT_EQ(registry.record(younger).first_frame, 1) << "seen as a part of the other";
  EXPECT_EQ(registry.record(older).first_frame, 0);
}

TEST_F(RegistryTest, WithoutMasksASegmentJoinsSuperPointsUntilFramesTellThemApart) {
  InstanceRegistry registry;
  see(registry, {{1, 0, 500}}, false);
  see(registry, {{2, 0, 500}}, false);
  EXPECT_NE(registry.instance_of(1), registry.instance_of(2));
  for (int i = 0; i < 20; ++i) see(registry, {{1, 0, 2000, {1, 2}, {{2, 900}}}}, false);
  EXPECT_EQ(registry.instance_of(1), registry.instance_of(2));
  EXPECT_EQ(forest_.root(2), 2u) << "nothing is merged for good";
  for (int i = 0; i < 50; ++i) see(registry, {{1, 0, 900}, {2, 0, 900}}, false);
  EXPECT_NE(registry.instance_of(1), registry.instance_of(2));
}

TEST_F(RegistryTest, KnowsTheMembersOfEveryInstance) {
  for (const auto reading : {InstanceReading::kConsensus, InstanceReading::kEntityVotes,
                             InstanceReading::kSuperPoints}) {
    InstanceConfig config;
    config.instances = reading;
    config.merging.merge_min_count = 3;
    InstanceRegistry registry(config);
    LabelForest forest;
    for (int i = 0; i < 12; ++i) forest.create();
    std::mt19937 random(5);
    for (std::int64_t frame = 0; frame < 120; ++frame) {
      Segments segments;
      std::vector<SegmentAssociation> associations;
      for (int i = 0; i < 5; ++i) {
        const Label a = forest.root(1 + static_cast<Label>(random() % 12)),
                    b = forest.root(1 + static_cast<Label>(random() % 12));
        segments.segments.push_back({static_cast<std::uint16_t>(random() % 4), 100});
        associations.push_back({a, false, {}, {{a, 100}}});
        if (a != b && random() % 8 == 0)
          associations.back().overlapped = {std::min(a, b), std::max(a, b)};
      }
      registry.observe(segments, associations, frame, frame % 5 != 0, forest);
      std::map<InstanceId, std::vector<Label>> members;
      for (const auto& [root, point] : registry.super_points())
        if (const InstanceId id = registry.instance_of(root); id != 0) members[id].push_back(root);
      ASSERT_EQ(registry.instances(), members) << "frame " << frame;
    }
  }
}

/// However objects come together and apart while frames come, each goes by the oldest id of its
/// super-points, and by those of no others.
TEST_F(RegistryTest, ObjectsGoByTheirOldestIdAllTheTime) {
  std::mt19937 random(6);
  LabelForest forest;
  for (int i = 0; i < 40; ++i) forest.create();
  InstanceRegistry registry;
  for (std::int64_t frame = 0; frame < 300; ++frame) {
    const Label first = 1 + static_cast<Label>(random() % 32);
    Segments segments;
    std::vector<SegmentAssociation> associations;
    for (Label label = first; label < first + 8; ++label) {
      segments.segments.push_back({static_cast<std::uint16_t>(label / 4 + random() % 2 + 1), 100});
      associations.push_back({label, false, {}, {{label, 100}}});
    }
    registry.observe(segments, associations, frame, true, forest);
    for (const auto& [id, labels] : registry.instances()) {
      InstanceId oldest = registry.super_points().at(labels.front()).votes.begin()->first;
      for (const Label label : labels) {
        const InstanceId own = registry.super_points().at(label).votes.begin()->first;
        ASSERT_EQ(registry.resolve(own), id) << "frame " << frame;
        oldest = std::min(oldest, own);
      }
      ASSERT_EQ(oldest, id) << "frame " << frame;
    }
    for (const auto& [alias, id] : registry.aliases())
      ASSERT_FALSE(registry.aliases().contains(id)) << "frame " << frame;
  }
}

TEST_F(RegistryTest, AnEntityJoinsAllSuperPointsThatItShowsUntilFramesTellThemApart) {
  InstanceRegistry registry;
  see(registry, {{1, 5, 500}});  // two ends of a wall, each from where the other is out of sight
  see(registry, {{2, 5, 500}});
  EXPECT_NE(registry.instance_of(1), registry.instance_of(2));
  for (int i = 0; i < 20; ++i) see(registry, {{1, 5, 2000, {1, 2}, {{2, 900}}}});
  EXPECT_EQ(registry.instance_of(1), registry.instance_of(2));
  EXPECT_EQ(forest_.root(2), 2u) << "nothing is merged for good";
  for (int i = 0; i < 50; ++i) see(registry, {{1, 5, 900}, {2, 6, 900}});
  EXPECT_NE(registry.instance_of(1), registry.instance_of(2));
}

TEST_F(RegistryTest, AnEntityThatCoversLessThanHalfOfASuperPointSaysNothingOfIt) {
  InstanceRegistry registry;
  see(registry, {{1, 5, 500}, {2, 6, 300}});
  for (int i = 0; i < 5; ++i) see(registry, {{1, 5, 500, {}, {{2, 400}}}, {2, 6, 600}});
  EXPECT_NE(registry.instance_of(1), registry.instance_of(2));
}

TEST_F(RegistryTest, SuperPointReadingKeepsTheOlderIdAfterAMerge) {
  InstanceConfig config;
  config.instances = InstanceReading::kSuperPoints;
  config.merging.merge_min_count = 2;
  InstanceRegistry registry(config);
  see(registry, {{1, 1, 100}, {2, 2, 100}});
  const InstanceId older = registry.instance_of(1), younger = registry.instance_of(2);
  for (int i = 0; i < 3; ++i) see(registry, {{1, 1, 2000, {1, 2}}});
  EXPECT_EQ(forest_.root(2), 1u);
  EXPECT_EQ(registry.instance_of(1), older);
  EXPECT_EQ(registry.resolve(younger), older);
  EXPECT_EQ(registry.instance_table(forest_)[2], older);
  EXPECT_EQ(registry.instances().size(), 1u);
}

TEST_F(RegistryTest, WithoutMasksEverySuperPointIsAnInstance) {
  InstanceRegistry registry;
  for (int i = 0; i < 30; ++i) see(registry, {{1, 0, 100}, {2, 0, 100}}, false);
  EXPECT_NE(registry.instance_of(1), 0u);
  EXPECT_NE(registry.instance_of(1), registry.instance_of(2));
}

TEST_F(RegistryTest, MergedSuperPointsKeepTheirVotes) {
  InstanceConfig config;
  config.instances = InstanceReading::kEntityVotes;
  config.merging.merge_min_count = 2;
  InstanceRegistry registry(config);
  for (int i = 0; i < 5; ++i) see(registry, {{2, 4, 100}});
  const InstanceId id = registry.instance_of(2);
  for (int i = 0; i < 3; ++i) see(registry, {{1, 0, 2000, {1, 2}}}, false);
  EXPECT_EQ(registry.instance_of(1), id) << "the dropped super-point's votes moved to the survivor";
}

TEST_F(RegistryTest, RestoresItsState) {
  InstanceRegistry registry;
  see(registry, {{1, 7, 500}, {2, 8, 300}});
  see(registry, {{1, 7, 500}, {2, 7, 300}});
  InstanceRegistry copy;
  copy.restore(registry.state());
  EXPECT_EQ(copy.instance_table(forest_), registry.instance_table(forest_));
  see(registry, {{1, 7, 500}, {3, 9, 100}});
  --frame_;
  see(copy, {{1, 7, 500}, {3, 9, 100}});
  EXPECT_EQ(copy.instance_table(forest_), registry.instance_table(forest_));
  EXPECT_EQ(copy.aliases(), registry.aliases());
  EXPECT_EQ(copy.instances(), registry.instances());
  EXPECT_EQ(copy.record(1).views, registry.record(1).views);
}

}  // namespace
}  // namespace ovimap
