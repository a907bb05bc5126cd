// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/taught_things.h"

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/semantics/classes/object_names.h"
#include "ovimap/semantics/query/query_engine.h"
#include "ovimap/semantics/query/query_fixture.h"

namespace ovimap {
namespace {

const std::vector<std::string> kThings = {
    "zeppelin hangar", "mug", "door", "chair", "lamp", "desk", "window", "bed", "sofa", "keyboard"};

/// As the fixture's map, with a person's names for some positions.
SearchIndex named_map(const std::vector<std::pair<std::size_t, std::string>>& names) {
  const SearchIndex plain = map_of(kThings);
  std::vector<SearchObject> objects = plain.objects();
  for (const auto& [position, name] : names) objects[position].name = name;
  return SearchIndex(std::move(objects), plain.embeddings());
}

TaughtThings example(const std::string& name, const std::string& look) {
  TaughtThings things;
  things.names = {name};
  things.looks = WordEncoder::direction_of(look).transpose();
  return things;
}

TaughtThings objects_of(const SearchIndex& index) {
  TaughtThings own{{}, index.embeddings()};
  for (const SearchObject& object : index.objects()) own.names.push_back(object.name);
  return own;
}

InstanceId first_for(const SearchIndex& index, const std::string& text, const TaughtThings& taught,
                     const QueryConfig& config = {}) {
  WordEncoder encoder;
  QueryScene scene = scene_of_boxes(index, Eigen::Vector3f::UnitZ());
  scene.taught = taught;
  const QueryEngine engine(index, &encoder, config, {}, scene);
  return engine.find({text, {}}).matches.front().id;
}

std::vector<ObjectName> names_of(const SearchIndex& index, const TaughtThings& taught) {
  WordEncoder encoder;
  const TextMatcher matcher(index, encoder, {}, {}, {}, {}, {}, taught);
  return name_objects(*matcher.evidence());
}

TEST(TaughtNames, AnObjectAnswersToTheNameThatAPersonGaveIt) {
  const SearchIndex index = named_map({{0, "Anna's airship"}});
  EXPECT_EQ(first_for(index, "anna's airship", {}), 1u);
  WordEncoder encoder;
  const QueryEngine engine(index, &encoder);
  EXPECT_EQ(engine.find({"anna's airship", {}}).verdict, Verdict::kFound);
}

TEST(TaughtNames, WhatAPersonCalledAVaseIsNoMug) {
  // Position 1 looks like a mug; a person says that it is a vase.
  WordEncoder encoder;
  const SearchIndex plain = map_of(kThings), named = named_map({{1, "vase"}});
  EXPECT_EQ(QueryEngine(plain, &encoder).find({"mug", {}}).verdict, Verdict::kFound);
  EXPECT_EQ(QueryEngine(named, &encoder).find({"mug", {}}).verdict, Verdict::kNotInMap);
  EXPECT_EQ(first_for(named, "vase", {}), 2u);
}

TEST(TaughtNames, ExamplesOfOtherMapsAreFoundHere) {
  const SearchIndex index = map_of(kThings);
  const TaughtThings taught = example("vase", "zeppelin hangar");
  EXPECT_EQ(first_for(index, "vase", taught), 1u);
  EXPECT_EQ(names_of(index, taught)[0].word, "vase");
  EXPECT_NE(names_of(index, {})[0].word, "vase");
  EXPECT_EQ(names_of(index, taught)[3].word, "chair");
}

TEST(TaughtNames, CanBeSwitchedOff) {
  const SearchIndex index = named_map({{0, "vase"}});
  QueryConfig off;
  off.evidence.taught_weight = 0.f;
  WordEncoder encoder;
  const auto score = [&](const QueryConfig& config) {
    for (const QueryMatch& match : QueryEngine(index, &encoder, config).find({"vase", {}}).matches)
      if (match.id == 1u) return match.standard_score;
    return -100.f;
  };
  EXPECT_GT(score({}), score(off) + 2.f);
}

TEST(TaughtNames, AKindSpeaksForWhatIsAboveItAndNotBeside) {
  const SearchIndex index = map_of(kThings);
  const TaughtNames names(builtin_concepts(), objects_of(index),
                          example("Anna's vase", "zeppelin hangar"));
  EXPECT_GT(names.log_ratios("Anna's vase").size(), 0);
  EXPECT_GT(names.log_ratios("vase").size(), 0);
  EXPECT_GT(names.log_ratios("VASES").size(), 0);
  EXPECT_EQ(names.log_ratios("Tom's vase").size(), 0);
  EXPECT_EQ(names.log_ratios("mug").size(), 0);
  const TaughtNames chairs(builtin_concepts(), objects_of(index), example("chair", "chair"));
  EXPECT_GT(chairs.log_ratios("wooden chair").size(), 0);
  EXPECT_GT(chairs.log_ratios("seat").size(), 0);
  EXPECT_EQ(chairs.log_ratios("armchair").size(), 0);
}

TEST(TaughtNames, OfTheAlikeTheMostAlikeSpeaks) {
  const SearchIndex index = map_of(kThings);
  const TaughtNames names(builtin_concepts(), objects_of(index),
                          example("vase", "zeppelin hangar"));
  const Eigen::VectorXf ratios = names.log_ratios("vase");
  EXPECT_GT(ratios[0], 10.f);
  for (Eigen::Index i = 1; i < ratios.size(); ++i) EXPECT_LT(ratios[i], 4.f) << i;
  EXPECT_EQ(names.nearest()[0].name, "vase");
}

/// Of a few objects nobody can tell how alike different things are.
TEST(TaughtNames, SmallMapsKnowTheirOwnNamesAlone) {
  const SearchIndex index = map_of({"mug", "door"});
  const TaughtNames names(builtin_concepts(), objects_of(index), example("cup", "mug"));
  EXPECT_TRUE(names.log_ratios("cup").isZero(0.f));
}

TEST(TaughtNames, ObjectsWithoutALookAreLeftAlone) {
  std::vector<std::string> things = kThings;
  things[2].clear();
  const SearchIndex index = map_of(things);
  const TaughtNames names(builtin_concepts(), objects_of(index),
                          example("vase", "zeppelin hangar"));
  EXPECT_EQ(names.log_ratios("vase")[2], 0.f);
}

TEST(TaughtNames, RefusesLooksOfAnotherEncoder) {
  const SearchIndex index = map_of(kThings);
  TaughtThings taught;
  taught.names = {"vase"};
  taught.looks = Embeddings::Ones(1, 3);
  EXPECT_THROW(TaughtNames(builtin_concepts(), objects_of(index), taught), Error);
}

}  // namespace
}  // namespace ovimap
