// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/query/query_text.h"

#include <set>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/semantics/query/query_fixture.h"
#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {
namespace {

using Texts = std::vector<std::string>;

TEST(CheckedQueryText, TakesAwayBlanks) {
  EXPECT_EQ(checked_query_text("  red \t\n chair ", 100), "red chair");
}

TEST(CheckedQueryText, RefusesNothingAndTooMuch) {
  EXPECT_THROW(checked_query_text("", 100), Error);
  EXPECT_THROW(checked_query_text(" \n\t ", 100), Error);
  EXPECT_EQ(checked_query_text(std::string(2000, 'x'), 2000).size(), 2000u);
  const std::string fault = error_of([] { checked_query_text(std::string(10000, 'x'), 2000); });
  EXPECT_NE(fault.find("10000 characters"), std::string::npos) << fault;
  EXPECT_NE(fault.find("2000"), std::string::npos) << fault;
  EXPECT_EQ(fault.find('\n'), std::string::npos);
}

TEST(CheckedQueryText, CountsCharactersNotBytes) {
  EXPECT_EQ(checked_query_text("café", 4), "café");
  EXPECT_THROW(checked_query_text("cafés", 4), Error);
}

TEST(SplitTerms, SplitsAtCommasOutsideQuotes) {
  EXPECT_EQ(split_terms("red chair, armchair"), (Texts{"red chair", "armchair"}));
  EXPECT_EQ(split_terms("\"salt, pepper\" , cup"), (Texts{"salt, pepper", "cup"}));
  EXPECT_EQ(split_terms("a,,b,"), (Texts{"a", "b"}));
  EXPECT_TRUE(split_terms(", ,").empty());
}

TEST(SplitPrompts, WantsASlotInEach) {
  EXPECT_EQ(split_prompts("a photo of a {}.|{}"), (Texts{"a photo of a {}.", "{}"}));
  EXPECT_THROW(split_prompts("a photo"), Error);
  EXPECT_THROW(split_prompts("{}|"), Error);
  EXPECT_THROW(split_prompts(""), Error);
}

TEST(ThingOfTerm, LeavesDeterminersOutAndPluralsOfKnownWords) {
  for (const char* term : {"chair", "chairs", "the chairs", "All the chairs", "every chair"})
    EXPECT_EQ(thing_of_term(term), "chair") << term;
  EXPECT_EQ(thing_of_term("some kitchen shelves"), "kitchen shelf");
  EXPECT_EQ(thing_of_term("Office Chairs"), "Office chair");
  EXPECT_EQ(thing_of_term("cookies"), "cookie");
  EXPECT_EQ(thing_of_term("boxes"), "box");
  for (const char* own : {"glasses", "scissors", "stairs", "glass of water", "the", "brass", "s"})
    EXPECT_EQ(thing_of_term(own), own);
  EXPECT_EQ(thing_of_term("frobniks"), "frobniks") << "nobody knows what that is";
}

TEST(ThingOfTerm, SaysWhetherAllAreMeant) {
  for (const char* all : {"chairs", "the mugs", "every chair", "all of it"})
    EXPECT_TRUE(asks_for_all(all)) << all;
  for (const char* one : {"chair", "the mug", "any mug", "glasses", "all"})
    EXPECT_FALSE(asks_for_all(one)) << one;
}

TEST(EncodePrompted, AveragesTemplates) {
  WordEncoder encoder;
  const Texts texts{"cup", "dog"};
  const Embeddings plain = encode_prompted(encoder, texts, Texts{"{}"});
  EXPECT_TRUE(plain.row(1).isApprox(encoder.encode_texts(texts).row(1), 1e-6f));
  const Embeddings both = encode_prompted(encoder, texts, Texts{"big {}", "small {}"});
  const Embeddings rows = encoder.encode_texts(Texts{"big dog", "small dog"});
  EXPECT_TRUE(both.row(1).isApprox((rows.row(0) + rows.row(1)).normalized(), 1e-5f));
}

TEST(WordLists, AreCompiledIn) {
  EXPECT_TRUE(builtin_word_list("nonsense").empty());
  const Texts vocabulary = list_entries(builtin_word_list("vocabulary"));
  EXPECT_GE(vocabulary.size(), 300u);
  EXPECT_EQ(std::set<std::string>(vocabulary.begin(), vocabulary.end()).size(), vocabulary.size());
  EXPECT_EQ(list_entries(builtin_word_list("replica51")).size(), 51u);
  EXPECT_EQ(list_entries(builtin_word_list("scannet200")).size(), 200u);
  EXPECT_EQ(list_entries(builtin_word_list("scannet20")).size(), 20u);
  EXPECT_EQ(list_entries("# no\n\n  a b \r\nc"), (Texts{"a b", "c"}));
}

}  // namespace
}  // namespace ovimap
