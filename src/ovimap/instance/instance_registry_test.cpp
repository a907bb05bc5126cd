// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/instance_registry.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

struct Piece {
  Label label;
  std::uint16_t entity;
  int area_px;
  std::vector<Label> overlapped = {};
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
      associations.push_back({piece.label, false, piece.overlapped});
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
  EXPECT_EQ(registry.records().at(registry.instance_of(1)).views, 3);
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
  EXPECT_EQ(registry.records().size(), 1u);
  EXPECT_EQ(registry.records().at(older).last_frame, 1);
  for (int i = 0; i < 2; ++i) see(registry, {{1, 5, 500}, {2, 6, 400}});
  EXPECT_EQ(registry.instance_of(2), younger) << "most frames keep it apart: its own id is back";
  EXPECT_EQ(registry.resolve(younger), younger);
}

TEST_F(RegistryTest, MergedSuperPointsKeepTheOlderIdForGood) {
  InstanceConfig config;
  config.merging.merge_min_count = 1;
  InstanceRegistry registry(config);
  see(registry, {{2, 5, 500}});
  const InstanceId older = registry.instance_of(2);
  see(registry, {{1, 5, 500}});
  const InstanceId younger = registry.instance_of(1);
  for (int i = 0; i < 2; ++i) see(registry, {{1, 5, 2000, {1, 2}}});
  EXPECT_EQ(registry.instance_of(1), older);
  EXPECT_EQ(registry.resolve(younger), older);
  EXPECT_EQ(registry.records().size(), 1u);
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
  EXPECT_EQ(registry.records().size(), 1u);
}

TEST_F(RegistryTest, WithoutMasksEverySuperPointIsAnInstance) {
  InstanceRegistry registry;
  for (int i = 0; i < 30; ++i) see(registry, {{1, 0, 100}, {2, 0, 100}}, false);
  EXPECT_NE(registry.instance_of(1), 0u);
  EXPECT_NE(registry.instance_of(1), registry.instance_of(2));
}

TEST_F(RegistryTest, MergedSuperPointsKeepTheirVotes) {
  InstanceConfig config;
  config.merging.merge_min_count = 2;
  InstanceRegistry registry(config);
  for (int i = 0; i < 5; ++i) see(registry, {{2, 4, 100}});
  const InstanceId id = registry.instance_of(2);
  for (int i = 0; i < 3; ++i) see(registry, {{1, 0, 2000, {1, 2}}});
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
}

}  // namespace
}  // namespace ovimap
