// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/association.h"

#include <gtest/gtest.h>

#include <random>

#include "ovimap/instance/plain_association.h"
#include "ovimap/map/voxels/label_slots.h"

namespace ovimap {
namespace {

/// A map of one row of voxels, and an image whose pixel x looks at voxel x: associations by hand.
class AssociateTest : public ::testing::Test {
 protected:
  static constexpr int kWidth = 400;

  AssociateTest() : surface_(kWidth, 1) {
    config_.merge_min_points = 100;
    for (int i = 0; i < 5; ++i) map_.labels().create();
    for (int x = 0; x < kWidth; ++x)
      surface_.at(x, 0) = VoxelRef::of(map_.find_or_create({x / 8, 0, 0}), x % 8);
  }

  void hold(int begin, int end, Label label, int support = 1) {
    for (int x = begin; x < end; ++x) {
      VoxelBlock& block = map_.writable_block(surface_.at(x, 0).block());
      for (int i = 0; i < support; ++i)
        add_support(block, surface_.at(x, 0).voxel(), palette_position(block, label), 1);
    }
  }

  static Segments cut(std::initializer_list<std::pair<int, int>> spans) {
    Segments segments{IdImage(kWidth, 1), {}};
    for (const auto& [begin, end] : spans) {
      segments.segments.push_back({0, end - begin});
      for (int x = begin; x < end; ++x)
        segments.ids.at(x, 0) = static_cast<std::uint16_t>(segments.segments.size());
    }
    return segments;
  }

  VoxelMap map_;
  Image<VoxelRef> surface_;
  AssociationConfig config_;
};

TEST_F(AssociateTest, TakesTheLabelWithMostVotes) {
  hold(0, 60, 3);
  hold(60, 100, 4);
  const auto result = associate(cut({{0, 100}}), surface_, map_, config_);
  EXPECT_EQ(result[0].label, 3u);
  EXPECT_FALSE(result[0].founded);
}

TEST_F(AssociateTest, EqualsThePlainCount) {
  std::mt19937 random(5);
  const auto some = [&random](int limit) { return static_cast<int>(random() % limit); };
  config_.association = AssociationRule::kArgmax;
  for (int round = 0; round < 50; ++round) {
    const int begin = some(kWidth);
    hold(begin, std::min(kWidth, begin + some(80)), static_cast<Label>(1 + some(5)), 1 + some(3));
    if (round == 25) map_.labels().merge(2, 4);
    const Segments segments = cut({{0, 90}, {90, 100 + some(100)}, {230, 260}, {300, kWidth}});
    const std::vector<Label> expected =
        plain::argmax_labels(segments, surface_, map_, config_.assoc_min_votes);
    const auto result = associate(segments, surface_, map_, config_);
    for (std::size_t i = 0; i < result.size(); ++i) {
      EXPECT_EQ(result[i].founded, expected[i] == kNoLabel);
      if (!result[i].founded) {
        EXPECT_EQ(result[i].label, expected[i]) << "round " << round;
      }
    }
  }
}

TEST_F(AssociateTest, FoundsALabelWithoutEnoughVotes) {
  hold(0, 20, 3);  // 20 votes are not more than 20
  const auto result = associate(cut({{0, 100}, {100, 200}}), surface_, map_, config_);
  EXPECT_EQ(result[0].label, 6u);
  EXPECT_EQ(result[1].label, 7u);
  EXPECT_TRUE(result[0].founded);
}

TEST_F(AssociateTest, AFewStrayPointsMakeNoLargeSegmentASuperPoints) {
  hold(0, 25, 3);
  for (const auto rule :
       {AssociationRule::kMixed, AssociationRule::kOneToOne, AssociationRule::kArgmax}) {
    config_.association = rule;
    config_.assoc_min_share = 0.05f;
    EXPECT_EQ(associate(cut({{0, 400}}), surface_, map_, config_)[0].label, 3u);
    config_.assoc_min_share = 0.1f;
    const auto result = associate(cut({{0, 400}}), surface_, map_, config_);
    EXPECT_TRUE(result[0].founded) << "25 points are not more than a tenth of 400";
    EXPECT_EQ(result[0].shown.size(), 1u) << "nor does it show that super-point";
  }
}

TEST_F(AssociateTest, OneToOneGivesTheLoserItsNextLabel) {
  config_.association = AssociationRule::kOneToOne;
  hold(0, 200, 2, 3);
  hold(150, 200, 5, 1);  // second choice of the right part
  const auto result = associate(cut({{0, 150}, {150, 200}}), surface_, map_, config_);
  EXPECT_EQ(result[0].label, 2u);
  EXPECT_EQ(result[1].label, 5u);
}

TEST_F(AssociateTest, MixedGivesTheLoserNoLabelOfLittleSupport) {
  hold(0, 200, 2, 4);
  hold(150, 200, 5, 1);  // a quarter of the first one's
  Segments segments = cut({{0, 150}, {150, 200}});
  segments.segments[1].entity = 1;
  EXPECT_TRUE(associate(segments, surface_, map_, config_)[1].founded);
  hold(150, 200, 5, 1);
  EXPECT_EQ(associate(segments, surface_, map_, config_)[1].label, 5u) << "half of it";
}

TEST_F(AssociateTest, MixedTakesNoSuperPointThatADoubtfulMaskMayHoldByMistake) {
  hold(0, 120, 2);
  Segments segments = cut({{0, 300}});
  segments.segments[0].entity = 1;
  EXPECT_EQ(associate(segments, surface_, map_, config_)[0].label, 2u) << "a mask that is true";
  segments.ratings = {0.65f};
  EXPECT_EQ(associate(segments, surface_, map_, config_)[0].label, 2u) << "0.4 of it, for 0.35";
  segments.ratings = {0.55f};
  const SegmentAssociation doubtful = associate(segments, surface_, map_, config_)[0];
  EXPECT_TRUE(doubtful.founded) << "0.4 of it, for 0.45";
  EXPECT_EQ(doubtful.shown.size(), 2u) << "that it shows both is told all the same";
  config_.association = AssociationRule::kOneToOne;
  EXPECT_EQ(associate(segments, surface_, map_, config_)[0].label, 2u) << "the paper's rule";
}

TEST_F(AssociateTest, MixedSharesALabelAmongSegmentsOfOneEntity) {
  hold(0, 300, 2);
  Segments segments = cut({{0, 150}, {150, 200}, {200, 300}});
  segments.segments[0].entity = segments.segments[1].entity = 1;
  segments.segments[2].entity = 2;
  const auto result = associate(segments, surface_, map_, config_);
  EXPECT_EQ(result[0].label, 2u);
  EXPECT_EQ(result[1].label, 2u);
  EXPECT_TRUE(result[2].founded) << "another entity's";
}

TEST_F(AssociateTest, MixedSharesALabelOnlyAmongSegmentsWithoutAnEntity) {
  hold(0, 300, 2);
  Segments segments = cut({{0, 150}, {150, 200}, {200, 300}});
  EXPECT_EQ(associate(segments, surface_, map_, config_)[2].label, 2u) << "no entities: shared";
  segments.segments[2].entity = 1;
  const auto result = associate(segments, surface_, map_, config_);
  EXPECT_EQ(result[0].label, 2u);
  EXPECT_EQ(result[1].label, 2u);
  EXPECT_TRUE(result[2].founded) << "an entity needs a super-point that is not another's";
}

TEST_F(AssociateTest, ArgmaxMayShareALabel) {
  config_.association = AssociationRule::kArgmax;
  hold(0, 200, 2);
  const auto result = associate(cut({{0, 150}, {150, 200}}), surface_, map_, config_);
  EXPECT_EQ(result[0].label, 2u);
  EXPECT_EQ(result[1].label, 2u);
}

TEST_F(AssociateTest, ReportsLabelsThatALargeSegmentSpans) {
  hold(0, 100, 1);
  hold(100, 160, 2);
  hold(160, 170, 3);
  const auto result = associate(cut({{0, 200}, {200, 260}}), surface_, map_, config_);
  EXPECT_EQ(result[0].overlapped, (std::vector<Label>{1, 2})) << "label 3 holds only 5 %";
  EXPECT_TRUE(result[1].overlapped.empty());
}

TEST_F(AssociateTest, TellsWhatOfOtherSuperPointsASegmentShows) {
  hold(0, 90, 1);
  hold(90, 130, 2);
  hold(130, 145, 3);
  const auto result = associate(cut({{0, 200}, {200, 260}}), surface_, map_, config_);
  EXPECT_EQ(result[0].shown, (std::vector<ShownLabel>{{1, 200}, {2, 40}}))
      << "15 points of label 3 are too few";
  EXPECT_EQ(result[1].shown, (std::vector<ShownLabel>{{6, 60}}));
}

TEST_F(AssociateTest, VotesCountForMergedLabels) {
  hold(0, 30, 4);
  hold(30, 60, 5);
  hold(60, 100, 2);
  map_.labels().merge(4, 5);
  EXPECT_EQ(associate(cut({{0, 100}}), surface_, map_, config_)[0].label, 4u);
}

}  // namespace
}  // namespace ovimap
