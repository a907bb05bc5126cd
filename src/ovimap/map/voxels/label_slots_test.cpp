// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/map/voxels/label_slots.h"

#include <map>
#include <random>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

void vote(VoxelBlock& block, Label label, int times = 1) {
  for (int i = 0; i < times; ++i) add_support(block, 0, palette_position(block, label), 1);
}

TEST(LabelSlots, StrongestLabelWinsAndTiesStayWithTheHolder) {
  VoxelBlock block({0, 0, 0});
  const LabelForest forest;
  vote(block, 5, 2);
  vote(block, 9, 2);
  EXPECT_EQ(voxel_label(block, 0, forest), 5u);
  vote(block, 9);
  EXPECT_EQ(voxel_label(block, 0, forest), 9u);
  EXPECT_EQ(voxel_labels(block, 0, forest)[1].support, 2u);
}

TEST(LabelSlots, ALabelWithMoreThanAFifthOfTheVotesIsNeverLost) {
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    VoxelBlock block({0, 0, 0});
    std::map<Label, int> votes;
    const int total = 400;
    for (int i = 0; i < total; ++i) {
      const Label label = random() % 100 < 27 ? 1 : 2 + random() % 60;
      ++votes[label];
      vote(block, label);
    }
    if (votes[1] * (kLabelSlots + 1) <= total) continue;
    const VoxelLabels held = voxel_labels(block, 0, LabelForest());
    EXPECT_TRUE(
        std::any_of(held.begin(), held.end(), [](const LabelSupport& h) { return h.label == 1; }));
    for (const LabelSupport& h : held) EXPECT_LE(static_cast<int>(h.support), votes[h.label]);
  }
}

TEST(LabelSlots, FewLabelsAreCountedExactly) {
  std::mt19937 random(6);
  VoxelBlock block({0, 0, 0});
  std::map<Label, std::uint32_t> votes;
  for (int i = 0; i < 300; ++i) {
    const Label label = 1 + random() % kLabelSlots;
    ++votes[label];
    vote(block, label);
  }
  for (const LabelSupport& held : voxel_labels(block, 0, LabelForest()))
    EXPECT_EQ(held.support, votes[held.label]);
}

TEST(LabelSlots, ABlockHasAsManyAsAVoxelNeeds) {
  VoxelBlock block({0, 0, 0});
  LabelForest forest;
  const Label first = forest.create(), second = forest.create();
  EXPECT_EQ(voxel_label(block, 0, forest), kNoLabel);
  vote(block, first, 3);
  EXPECT_EQ(block.slots.size(), 1u);
  vote(block, second);
  EXPECT_EQ(block.slots.size(), 2u);
  EXPECT_EQ(voxel_label(block, 1, forest), kNoLabel) << "of another voxel nothing is known";
  forest.merge(first, second);
  resolve_labels(block, forest);
  EXPECT_EQ(block.slots.size(), 1u) << "what was two labels is one";
  EXPECT_EQ(voxel_labels(block, 0, forest)[0].support, 4u);
}

TEST(LabelSlots, MergedLabelsAddUpBeforeAndAfterTheyAreWritten) {
  VoxelBlock block({0, 0, 0});
  LabelForest forest;
  for (int i = 0; i < 9; ++i) forest.create();
  vote(block, 5, 4);
  vote(block, 8, 3);
  vote(block, 9, 3);
  forest.merge(8, 9);
  EXPECT_EQ(voxel_label(block, 0, forest), 8u);
  EXPECT_EQ(voxel_labels(block, 0, forest)[0].support, 6u);
  resolve_labels(block, forest);
  EXPECT_EQ(block.forest_epoch, forest.epoch());
  EXPECT_EQ(voxel_label(block, 0, forest), 8u);
  EXPECT_EQ(voxel_labels(block, 0, forest)[0].support, 6u);
  EXPECT_EQ(block.palette.size(), 3u) << "none, 5 and 8";
}

TEST(LabelSlots, HeavyVotesKeepWhatHasMoreThanAFifth) {
  std::mt19937 random(6);
  for (int round = 0; round < 200; ++round) {
    VoxelBlock block({0, 0, 0});
    std::map<Label, int> weights;
    int total = 0;
    for (int i = 0; i < 300; ++i) {
      const Label label = random() % 100 < 27 ? 1 : 2 + random() % 60;
      const auto votes = static_cast<std::uint16_t>(1 + random() % 9);
      weights[label] += votes, total += votes;
      add_support(block, 0, palette_position(block, label), votes);
    }
    if (weights[1] * (kLabelSlots + 1) <= total) continue;
    const VoxelLabels kept = voxel_labels(block, 0, LabelForest());
    EXPECT_TRUE(std::any_of(kept.begin(), kept.end(),
                            [](const LabelSupport& slot) { return slot.label == 1; }));
    for (std::size_t s = 1; s < kLabelSlots; ++s) EXPECT_LE(kept[s].support, kept[s - 1].support);
  }
}

TEST(LabelSlots, OneHeavyVoteOvertakesManyLight) {
  VoxelBlock block({0, 0, 0});
  vote(block, 5, 4);
  add_support(block, 0, palette_position(block, 9), 5);
  EXPECT_EQ(voxel_label(block, 0, LabelForest()), 9u);
  EXPECT_EQ(voxel_labels(block, 0, LabelForest())[1].support, 4u);
}

TEST(LabelSlots, APaletteFullOfLiveLabelsLosesVotesAndNeverWrites) {
  VoxelBlock block({0, 0, 0});
  for (Label label = 1; label <= 255; ++label)
    add_support(block, static_cast<int>(label), palette_position(block, label), 1);
  EXPECT_EQ(palette_position(block, 300), 0);
  EXPECT_EQ(palette_position(block, 17), 17);
}

TEST(LabelSlots, AFullPaletteForgetsDeadLabels) {
  VoxelBlock block({0, 0, 0});
  for (Label label = 1; label <= 255; ++label) palette_position(block, label);
  EXPECT_EQ(palette_position(block, 300), 1) << "nothing held the others";
}

}  // namespace
}  // namespace ovimap
