// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/text_evidence.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/semantics/query/query_engine.h"
#include "ovimap/semantics/query/query_fixture.h"

namespace ovimap {
namespace {

Eigen::AlignedBox3f box_of(float length_m, float depth_m, float bottom_m, float top_m) {
  return {Eigen::Vector3f(0.f, 0.f, bottom_m), Eigen::Vector3f(length_m, depth_m, top_m)};
}

InstanceId first_for(const QueryEngine& engine, const std::string& text) {
  return engine.find({text, {}}).matches.front().id;
}

/// Two things that look the same, one the size of a cup on a table, one that of a wardrobe.
TEST(TextEvidence, SizeDecidesWherePicturesCannot) {
  WordEncoder encoder;
  const SearchIndex index = map_of({"cup wardrobe", "wardrobe cup", "lamp", "door", "floor"},
                                   {box_of(0.1f, 0.1f, 0.75f, 0.84f), box_of(1.2f, 0.6f, 0.f, 2.f),
                                    box_of(0.3f, 0.3f, 0.8f, 1.2f), box_of(0.8f, 0.1f, 0.f, 2.f),
                                    box_of(4.f, 4.f, -0.02f, 0.f)});
  const QueryEngine engine(index, &encoder);
  EXPECT_EQ(first_for(engine, "cup"), 1u);
  EXPECT_EQ(first_for(engine, "wardrobe"), 2u);
}

/// No picture tells a floor from a wall or a ceiling here; where they are does.
TEST(TextEvidence, SizeAndPlaceTellWhatARoomConsistsOf) {
  WordEncoder encoder;
  const SearchIndex index =
      map_of({"zeppelin", "zeppelin", "zeppelin", "mug", "lamp", "desk"},
             {box_of(4.f, 3.f, -0.02f, 0.02f), box_of(4.f, 0.1f, 0.f, 2.4f),
              box_of(4.f, 3.f, 2.5f, 2.54f), box_of(0.1f, 0.1f, 0.75f, 0.84f),
              box_of(0.3f, 0.3f, 0.8f, 1.2f), box_of(1.4f, 0.7f, 0.f, 0.72f)});
  const QueryEngine engine(index, &encoder);
  EXPECT_EQ(first_for(engine, "floor"), 1u);
  EXPECT_EQ(first_for(engine, "wall"), 2u);
  EXPECT_EQ(first_for(engine, "ceiling"), 3u);
  EXPECT_EQ(first_for(engine, "mug"), 4u);
}

TEST(TextEvidence, WhatIsRatherSomethingElseIsLeftBehind) {
  WordEncoder encoder;
  // Object 1 is a monitor, and more of a keyboard than object 2, which is nothing else.
  const SearchIndex index = map_of({"monitor monitor keyboard", "keyboard zeppelin hangar pilot",
                                    "mug", "door", "chair", "lamp"});
  QueryConfig config;
  config.evidence.size_weight = 0.f;
  config.evidence.competition = 0.f;
  EXPECT_EQ(first_for(QueryEngine(index, &encoder, config), "keyboard"), 1u);
  config.evidence.competition = 1.f;
  const QueryEngine engine(index, &encoder, config);
  const QueryAnswer monitor = engine.find({"monitor", {}}),
                    keyboard = engine.find({"keyboard", {}});
  EXPECT_EQ(monitor.matches[0].id, 1u);
  EXPECT_EQ(keyboard.matches[0].id, 2u);
  for (const QueryMatch& match : keyboard.matches) {
    if (match.id != 1u) continue;
    EXPECT_LT(*match.probability, *monitor.matches[0].probability);
  }
}

TEST(TextEvidence, WordsForTheSameThingDoNotCompete) {
  WordEncoder encoder;
  const SearchIndex index = map_of({"sofa couch seat", "mug", "door", "lamp", "table", "bed"});
  QueryConfig config;
  config.evidence.size_weight = 0.f;
  const QueryEngine engine(index, &encoder, config);
  const double sofa = *engine.find({"sofa", {}}).matches[0].probability;
  EXPECT_GT(sofa, 0.7);
  EXPECT_GT(*engine.find({"couch", {}}).matches[0].probability, 0.7);
  EXPECT_GT(*engine.find({"seat", {}}).matches[0].probability, 0.7);
  EXPECT_LT(*engine.find({"lamp", {}}).matches.back().probability, 0.1);
}

TEST(TextEvidence, LargeMapsAreSearchedByPicturesAlone) {
  WordEncoder encoder;
  const SearchIndex index = map_of({"mug", "door", "lamp"});
  QueryConfig config;
  config.evidence.max_objects = 2;
  const TextMatcher matcher(index, encoder, config, {});
  EXPECT_EQ(matcher.evidence(), nullptr);
  EXPECT_EQ(matcher.match({"mug"}, {}).log_odds.size(), 0);
}

}  // namespace
}  // namespace ovimap
