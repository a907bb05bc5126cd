// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_grammar.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

std::string reading(std::string_view text) {
  return describe(parse_query(text));
}

TEST(QueryGrammar, ReadsRelations) {
  EXPECT_EQ(reading("mug on the table"), "[mug] on [table]");
  EXPECT_EQ(reading("the chair nearest to the television"), "[chair] nearest to [television]");
  EXPECT_EQ(reading("chair closest to a window"), "[chair] nearest to [window]");
  EXPECT_EQ(reading("a plant next to the sofa"), "[plant] beside [sofa]");
  EXPECT_EQ(reading("book on top of the shelf"), "[book] on [shelf]");
  EXPECT_EQ(reading("lamp to the left of the bed"), "[lamp] left of [bed]");
  EXPECT_EQ(reading("lamp on the right side of the bed"), "[lamp] right of [bed]");
  EXPECT_EQ(reading("stool in front of the desk"), "[stool] in front of [desk]");
  EXPECT_EQ(reading("bin behind the door"), "[bin] behind [door]");
  EXPECT_EQ(reading("picture above the sofa"), "[picture] above [sofa]");
  EXPECT_EQ(reading("rug underneath the table"), "[rug] under [table]");
  EXPECT_EQ(reading("cup in the sink"), "[cup] inside [sink]");
  EXPECT_EQ(reading("chair furthest from the door"), "[chair] farthest from [door]");
  EXPECT_EQ(reading("keys close to the door"), "[keys] near [door]");
}

TEST(QueryGrammar, ReadsSuperlatives) {
  EXPECT_EQ(reading("largest cabinet"), "largest [cabinet]");
  EXPECT_EQ(reading("the biggest white cabinet"), "largest white [cabinet]");
  EXPECT_EQ(reading("smallest mug on the largest table"), "smallest [mug] on largest [table]");
  EXPECT_EQ(reading("tallest thing"), "tallest [thing]");
  EXPECT_TRUE(parse_query("tallest thing").anything);
  EXPECT_FALSE(parse_query("tallest chair").anything);
}

TEST(QueryGrammar, ReadsColors) {
  EXPECT_EQ(reading("red chair"), "red [chair]");
  EXPECT_EQ(reading("the dark blue mug on the white table"), "dark blue [mug] on white [table]");
  EXPECT_EQ(reading("pale green bright blue mug"), "light green [bright blue mug]");
  EXPECT_EQ(reading("bright blue mug"), "blue [mug]");
  EXPECT_EQ(reading("gray office chair"), "grey [office chair]");
  for (const char* text :
       {"red", "dark red", "orange", "red chair, armchair", "\"white wine\" glass"})
    EXPECT_TRUE(parse_query(text).free_text()) << text;
  EXPECT_TRUE(parse_query("red chair", {.colors = false}).free_text());  // a map without colours
}

TEST(QueryGrammar, ReadsPartsOfObjects) {
  EXPECT_EQ(reading("drawer of the cabinet"), "[drawer] of [cabinet]");
  EXPECT_EQ(reading("largest drawer of the white cabinet near the door"),
            "largest [drawer] of white [cabinet] near [door]");
  EXPECT_EQ(reading("red cushion of the sofa"), "[red cushion] of [sofa]");
  EXPECT_EQ(reading("mug on the shelf of the cabinet"), "[mug] on [shelf] of [cabinet]");
  EXPECT_TRUE(parse_query("parts of the chair").anything);
  for (const char* text : {"bottle of milk", "a cup of tea", "middle of the room"})
    EXPECT_TRUE(parse_query(text).free_text()) << text;
  EXPECT_TRUE(parse_query("drawer of the cabinet", {.parts = false}).free_text());
}

TEST(QueryGrammar, ReadsSizes) {
  EXPECT_EQ(reading("table longer than 1.5 m"), "[table] more than 1.5 m long");
  EXPECT_EQ(reading("a red box that is shorter than 40cm"), "red [box] less than 0.4 m high");
  EXPECT_EQ(reading("cabinet taller than 2 metres near the door"),
            "[cabinet] more than 2 m high near [door]");
  for (const char* text :
       {"table longer than a sofa", "longer than 2 m", "box taller than 3 miles"})
    EXPECT_TRUE(parse_query(text).free_text()) << text;
}

TEST(QueryGrammar, ReadsWriting) {
  EXPECT_EQ(reading("text:\"emergency exit\""), "[anything] with the text \"emergency exit\"");
  EXPECT_EQ(reading("TEXT:exit"), "[anything] with the text \"exit\"");
  EXPECT_EQ(reading("red box with the lid text:C++ on the shelf"),
            "red [box with the lid] with the text \"C++\" on [shelf]");
  EXPECT_EQ(reading("two books text:\"on tables\""), "2 [book] with the text \"on tables\"");
  EXPECT_EQ(reading("text:exit sign"), "[sign] with the text \"exit\"");
  EXPECT_EQ(parse_query("mug on the text:news").anchors.at(0).writing, "news");
  for (const char* text : {"text:", "text: exit", "a text", "sign text:exit here"})
    EXPECT_TRUE(parse_query(text).free_text()) << text;
}

TEST(QueryGrammar, ReadsNumbers) {
  EXPECT_EQ(reading("the two mugs"), "2 [mug]");
  EXPECT_EQ(reading("3 red boxes on the shelf"), "3 red [box] on [shelf]");
  EXPECT_EQ(reading("how many chairs"), "how many [chair]");
  EXPECT_EQ(reading("How many shelves are there"), "how many [shelf]");
  EXPECT_EQ(reading("how many books are on the table"), "how many [book] on [table]");
  for (const char* text : {"two", "one chair", "how many", "1 chair", "99999 chairs"})
    EXPECT_TRUE(parse_query(text).free_text()) << text;
}

TEST(QueryGrammar, NestsToTheRight) {
  EXPECT_EQ(reading("mug on the table near the window"), "[mug] on [table] near [window]");
  const QueryPhrase phrase = parse_query("mug on the table near the window");
  ASSERT_EQ(phrase.anchors.size(), 1u);
  EXPECT_EQ(phrase.anchors[0].things, "table");
  EXPECT_EQ(phrase.anchors[0].anchors.at(0).things, "window");
}

TEST(QueryGrammar, ReadsBetween) {
  EXPECT_EQ(reading("box between the sofa and the television"),
            "[box] between [sofa] and [television]");
  EXPECT_EQ(reading("box between the two chairs"), "[box] between two of [chairs]");
  EXPECT_EQ(reading("box in between chairs"), "[box] between two of [chairs]");
  EXPECT_EQ(reading("box between the sofa and the chair near the window"),
            "[box] between [sofa] and [chair] near [window]");
}

TEST(QueryGrammar, ReadsNegationAndDropsFillers) {
  EXPECT_EQ(reading("mug not on the table"), "[mug] not on [table]");
  EXPECT_EQ(reading("the mug that is not on the table"), "[mug] not on [table]");
  EXPECT_EQ(reading("mug standing on the table"), "[mug] on [table]");
  EXPECT_EQ(reading("picture which is hanging above the bed"), "[picture] above [bed]");
}

TEST(QueryGrammar, FallsThroughToFreeText) {
  for (const char* text :
       {"game controller on", "on", "on the table", "near", "the on", "largest", "chair",
        "a chair with four legs", "salt and pepper", "between", "box between", "inside",
        "built-in wardrobe", "", "the", "largest the"}) {
    EXPECT_TRUE(parse_query(text).free_text()) << text;
    EXPECT_EQ(parse_query(text).things, text);
  }
}

TEST(QueryGrammar, TakesALaterRelationWhenTheFirstHasNoOperand) {
  EXPECT_EQ(reading("television on on the wall"), "[television on] on [wall]");
  EXPECT_EQ(reading("on switch on the wall"), "[on switch] on [wall]");
}

TEST(QueryGrammar, QuotesProtect) {
  EXPECT_TRUE(parse_query("\"cat on a hot tin roof\"").free_text());
  EXPECT_EQ(reading("\"cat on a roof\" on the wall"), "[\"cat on a roof\"] on [wall]");
}

TEST(QueryGrammar, KeepsCommasAndCase) {
  EXPECT_EQ(reading("Mug, IKEA cup ON The table"), "[Mug, IKEA cup] on [table]");
}

TEST(QueryGrammar, SurvivesAnything) {
  std::string text;
  for (int i = 0; i < 300; ++i) text += "on in between and not the ";
  EXPECT_FALSE(describe(parse_query(text)).empty());
  std::string nested = "cup";
  for (int i = 0; i < 60; ++i) nested += " between plates";
  EXPECT_TRUE(parse_query(nested).free_text());
  const QueryPhrase inches = parse_query("24\" monitor on the desk");
  EXPECT_EQ(inches.things, "24\" monitor");
  EXPECT_EQ(inches.relation, Relation::kOn);
  for (const char* place : {"picture on the left", "chair in the corner", "bin in front"})
    EXPECT_TRUE(parse_query(place).free_text()) << place;
}

}  // namespace
}  // namespace ovimap
