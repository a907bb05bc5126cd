// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/entity_consensus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace ovimap {
namespace {

using Frame = std::map<Label, std::uint16_t>;  // entity by root

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
        frame[root] = static_cast<std::uint16_t>(root / 3 + (random() % 4 == 0) + 1);
  const std::map<Label, Label> objects = after(frames).objects();
  std::shuffle(frames.begin(), frames.end(), random);
  EXPECT_EQ(after(frames).objects(), objects);
  EXPECT_EQ(objects.size(), 12u);
}

/// The same by its definition, pair by pair and edge by edge.
std::map<Label, Label> plain_objects(const std::vector<Frame>& frames, double apart_weight) {
  std::map<Label, std::vector<Label>> members;
  for (const Frame& frame : frames)
    for (const auto& [root, entity] : frame) members[root] = {root};
  const auto weight = [&](Label a, Label b) {
    double sum = 0;
    for (const Label x : members[a])
      for (const Label y : members[b])
        for (const Frame& frame : frames)
          if (frame.contains(x) && frame.contains(y))
            sum += frame.at(x) == frame.at(y) ? 1 : -apart_weight;
    return sum;
  };
  for (;;) {
    double best = 0;
    Label keep = 0, drop = 0;
    for (const auto& [a, of_a] : members)
      for (const auto& [b, of_b] : members)
        if (a < b && weight(a, b) > best) best = weight(a, b), keep = a, drop = b;
    if (keep == 0) break;
    members[keep].insert(members[keep].end(), members[drop].begin(), members[drop].end());
    members.erase(drop);
  }
  std::map<Label, Label> objects;
  for (const auto& [object, roots] : members)
    for (const Label root : roots) objects[root] = object;
  return objects;
}

TEST(EntityConsensus, IsGreedyAdditiveEdgeContraction) {
  std::mt19937 random(11);
  for (int round = 0; round < 40; ++round) {
    std::vector<Frame> frames(12);
    for (Frame& frame : frames)
      for (Label root = 1; root <= 9; ++root)
        if (random() % 3 != 0)
          frame[root] = static_cast<std::uint16_t>((root + random() % 4) / 3 + 1);
    EXPECT_EQ(after(frames).objects(), plain_objects(frames, 0.5)) << "round " << round;
  }
}

TEST(EntityConsensus, IsTheSameWhetherAskedAfterEveryFrameOrOnce) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    EntityConsensus often;
    for (int i = 0; i < 40; ++i) {
      Frame frame;
      for (Label root = 1; root <= 30; ++root)
        if (random() % 4 == 0) frame[root] = static_cast<std::uint16_t>(root / 4 + random() % 2 + 1);
      often.observe(frame);
      EntityConsensus once;
      once.restore(often.sightings(), often.frames());
      ASSERT_EQ(often.objects(), once.objects()) << "round " << round << ", frame " << i;
    }
  }
}

TEST(EntityConsensus, GoesOnWhereItStopped) {
  const std::vector<Frame> begun = {{{1, 7}, {2, 7}}, {{1, 7}, {2, 3}}};
  EntityConsensus whole = after(begun), resumed;
  resumed.restore(whole.sightings(), whole.frames());
  for (EntityConsensus* consensus : {&whole, &resumed}) consensus->observe({{1, 7}, {2, 3}});
  EXPECT_EQ(resumed.sightings(), whole.sightings());
  EXPECT_EQ(resumed.objects(), whole.objects());
}

}  // namespace
}  // namespace ovimap
