// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/consensus/entity_consensus.h"

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

/// What update() finds: the oldest root of the object of each root that it speaks of.
std::map<Label, Label> updated(EntityConsensus& consensus) {
  std::map<Label, Label> objects;
  for (const RegroupedObject& object : consensus.update()) {
    const Label any = object.roots.empty() ? object.resting : object.roots.front();
    const std::set<Label>& all = consensus.object_with(any);
    for (const Label root : all) objects[root] = *all.begin();
  }
  return objects;
}

TEST(EntityConsensus, MostFramesDecide) {
  const Frame joined = {{1, 7}, {2, 7}}, apart = {{1, 7}, {2, 3}};
  EXPECT_EQ(after({joined, apart}).settle().at(2), 1u);
  EXPECT_EQ(after({joined, apart, apart}).settle().at(2), 2u) << "weighed alike: no joining";
  EXPECT_EQ(after({joined, apart}, 1.f).settle().at(2), 2u);
}

TEST(EntityConsensus, AMaskThatOnceSpansTwoObjectsDoesNoHarm) {
  std::vector<Frame> frames(6, {{1, 1}, {2, 1}, {3, 2}, {4, 2}});
  frames.push_back({{1, 1}, {2, 1}, {3, 1}, {4, 1}});
  const std::map<Label, Label> objects = after(frames).settle();
  EXPECT_EQ(objects, (std::map<Label, Label>{{1, 1}, {2, 1}, {3, 3}, {4, 3}}));
}

TEST(EntityConsensus, APartStaysWithItsObjectThoughItIsNeverSeenWithAllOfIt) {
  const std::map<Label, Label> objects =
      after({{{1, 1}, {2, 1}}, {{2, 1}, {3, 1}}, {{3, 1}, {4, 1}}}).settle();
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
  const std::map<Label, Label> objects = after(frames).settle();
  std::shuffle(frames.begin(), frames.end(), random);
  EXPECT_EQ(after(frames).settle(), objects);
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
    EXPECT_EQ(after(frames).settle(), plain_objects(frames, 0.5)) << "round " << round;
  }
}

std::vector<Frame> random_frames(std::mt19937& random, int count) {
  std::vector<Frame> frames(static_cast<std::size_t>(count));
  for (Frame& frame : frames)
    for (Label root = 1; root <= 30; ++root)
      if (random() % 4 == 0) frame[root] = static_cast<std::uint16_t>(root / 4 + random() % 2 + 1);
  return frames;
}

TEST(EntityConsensus, SettlesAlikeHoweverOftenItWasUpdated) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    EntityConsensus often;
    for (const Frame& frame : random_frames(random, 40)) {
      often.observe(frame);
      often.update();
    }
    EntityConsensus once;
    once.restore(often.sightings(), often.frames(), {});
    ASSERT_EQ(often.settle(), once.settle()) << "round " << round;
  }
}

TEST(EntityConsensus, KeepsHowMasksAreRated) {
  EntityConsensus consensus;
  const std::vector<float> ratings{0.2f, 1.f};
  consensus.observe({{1, 1}, {2, 2}, {3, 3}}, ratings);
  EXPECT_EQ(consensus.sightings().at(1)[0].rating, 51);
  EXPECT_FALSE(consensus.sightings().at(2)[0].is_rated());
  EXPECT_FALSE(consensus.sightings().at(3)[0].is_rated()) << "the source says nothing of it";
}

TEST(EntityConsensus, LooksAtObjectsInSightAlone) {
  EntityConsensus consensus = after({{{1, 1}, {2, 1}, {3, 2}, {4, 2}}});
  EXPECT_EQ(updated(consensus), (std::map<Label, Label>{{1, 1}, {2, 1}, {3, 3}, {4, 3}}));
  EXPECT_TRUE(updated(consensus).empty()) << "nothing came since";
  consensus.observe({{2, 5}, {5, 5}});
  EXPECT_EQ(updated(consensus), (std::map<Label, Label>{{1, 1}, {2, 1}, {5, 1}}));
  consensus.observe({{1, 1}, {2, 2}});
  EXPECT_EQ(updated(consensus).at(2), 1u);
  for (int i = 0; i < 2; ++i) consensus.observe({{1, 1}, {2, 2}});
  EXPECT_EQ(updated(consensus), (std::map<Label, Label>{{1, 1}, {2, 2}, {5, 2}})) << "taken apart";
}

TEST(EntityConsensus, WhatRestsStaysTogetherUntilFramesSpeakAgainstIt) {
  EntityConsensus consensus({.apart_weight = 0.5f, .recent_sightings = 4});
  for (int i = 0; i < 3; ++i) consensus.observe({{1, 1}, {2, 1}, {3, 1}});
  updated(consensus);
  for (int i = 0; i < 9; ++i) {  // none of the frames that count shows them together any more
    consensus.observe({{2, 1}});
    EXPECT_EQ(consensus.update(), (std::vector<RegroupedObject>{{{2}, 1}}));
  }
  EXPECT_EQ(consensus.object_with(2), (std::set<Label>{1, 2, 3}));
  consensus.observe({{2, 1}, {3, 2}});
  updated(consensus);
  EXPECT_EQ(consensus.object_with(3), (std::set<Label>{1, 3})) << "by three frames against one";
  EXPECT_EQ(consensus.object_with(2), (std::set<Label>{2}));
  EXPECT_EQ(consensus.settle(), (std::map<Label, Label>{{1, 1}, {2, 1}, {3, 1}}))
      << "by all frames";
}

/// An endless floor, with ever new pieces of it and things on it.
TEST(EntityConsensus, AFrameCostsWhatItShows) {
  EntityConsensus consensus;
  for (Label i = 0; i < 500; ++i) {
    consensus.observe({{1, 1}, {10 + 2 * i, 1}, {11 + 2 * i, 2}});
    std::size_t asked = 0;
    for (const RegroupedObject& object : consensus.update()) asked += object.roots.size();
    ASSERT_EQ(asked, 3u) << "frame " << i;
  }
  EXPECT_EQ(consensus.object_with(1).size(), 501u);
}

TEST(EntityConsensus, UpdatesWhatIsAlwaysInSightAsItSettles) {
  std::mt19937 random(8);
  EntityConsensus consensus;
  for (int i = 0; i < 20; ++i) {
    Frame frame;
    for (Label root = 1; root <= 30; ++root)
      frame[root] = static_cast<std::uint16_t>(root / 4 + random() % 2 + 1);
    consensus.observe(frame);
    const std::map<Label, Label> objects = updated(consensus);
    ASSERT_EQ(objects, consensus.settle()) << "frame " << i;
  }
}

TEST(EntityConsensus, GoesOnWhereItStopped) {
  std::mt19937 random(5);
  const std::vector<Frame> frames = random_frames(random, 40);
  EntityConsensus whole, resumed;
  std::map<Label, Label> objects;
  for (int i = 0; i < 20; ++i) {
    whole.observe(frames[static_cast<std::size_t>(i)]);
    for (const auto& [root, object] : updated(whole)) objects[root] = object;
  }
  resumed.restore(whole.sightings(), whole.frames(), objects);
  for (int i = 20; i < 40; ++i) {
    for (EntityConsensus* consensus : {&whole, &resumed})
      consensus->observe(frames[static_cast<std::size_t>(i)]);
    ASSERT_EQ(updated(resumed), updated(whole)) << "frame " << i;
  }
  EXPECT_EQ(resumed.sightings(), whole.sightings());
}

}  // namespace
}  // namespace ovimap
