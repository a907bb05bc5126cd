// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/entity_consensus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace ovimap {
namespace {

using Frame = std::vector<EntityConsensus::Sighting>;

EntityConsensus after(const std::vector<Frame>& frames, float apart_weight = 0.5f) {
  EntityConsensus consensus({apart_weight});
  for (const Frame& frame : frames) consensus.observe(frame);
  return consensus;
}

TEST(EntityConsensus, MostFramesDecide) {
  const Frame joined = {{1, 7}, {2, 7}}, apart = {{1, 7}, {2, 3}};
  EXPECT_EQ(after({joined, apart}).objects().at(2), 1u);
  EXPECT_EQ(after({joined, apart, apart}).objects().at(2), 2u) << "weighed alike: no joining";
  EXPECT_EQ(after({joined, apart}, 1.f).objects().at(2), 2u);
}

TEST(EntityConsensus, AMaskThatOnceSpansTwoObjectsDoesNoHarm) {
  std::vector<Frame> frames(6, {{1, 1}, {2, 1}, {3, 2}, {4, 2}});
  frames.push_back({{1, 1}, {2, 1}, {3, 1}, {4, 1}});
  const std::map<Label, Label> objects = after(frames).objects();
  EXPECT_EQ(objects, (std::map<Label, Label>{{1, 1}, {2, 1}, {3, 3}, {4, 3}}));
}

TEST(EntityConsensus, APartStaysWithItsObjectThoughItIsNeverSeenWithAllOfIt) {
  const std::map<Label, Label> objects =
      after({{{1, 1}, {2, 1}}, {{2, 1}, {3, 1}}, {{3, 1}, {4, 1}}}).objects();
  for (const auto& [root, object] : objects) EXPECT_EQ(object, 1u) << root;
  EXPECT_EQ(objects.size(), 4u);
}

TEST(EntityConsensus, TheOrderOfFramesDoesNotMatter) {
  std::mt19937 random(4);
  std::vector<Frame> frames(60);
  for (Frame& frame : frames)
    for (Label root = 1; root <= 12; ++root)
      if (random() % 3 != 0)
        frame.push_back({root, static_cast<std::uint16_t>(root / 3 + (random() % 4 == 0) + 1)});
  const std::map<Label, Label> objects = after(frames).objects();
  std::shuffle(frames.begin(), frames.end(), random);
  EXPECT_EQ(after(frames).objects(), objects);
  EXPECT_EQ(objects.size(), 12u);
}

TEST(EntityConsensus, MergedSuperPointsKeepTheirEvidence) {
  EntityConsensus consensus = after({{{1, 1}, {3, 1}}, {{2, 1}, {3, 2}}, {{2, 1}, {4, 1}}});
  consensus.merge(1, 2);
  EXPECT_EQ(consensus.pairs(), (PairCounts{{{1, 3}, {1, 1}}, {{1, 4}, {1, 0}}}));
  EXPECT_EQ(consensus.objects().at(4), 1u);
}

}  // namespace
}  // namespace ovimap
