// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/concepts.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"
#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {
namespace {

class ConceptsTest : public ::testing::Test {
 protected:
  bool both(const char* a, const char* b) const {
    return table_.compatible(table_.kinds_of(a), table_.kinds_of(b));
  }
  Concepts table_{list_entries(builtin_word_list("concepts"))};
};

TEST_F(ConceptsTest, KnowsSynonymsAndKinds) {
  for (const auto& [a, b] : {std::pair{"sofa", "couch"},
                             {"armchair", "chair"},
                             {"seat", "stool"},
                             {"tv", "television"},
                             {"desk", "furniture"},
                             {"mug", "container"},
                             {"trash can", "waste bin"},
                             {"monitor", "computer screen"}})
    EXPECT_TRUE(both(a, b)) << a << ", " << b;
  for (const auto& [a, b] : {std::pair{"monitor", "keyboard"},
                             {"mouse", "laptop"},
                             {"armchair", "sofa"},
                             {"chair", "table"},
                             {"mug", "plate"}})
    EXPECT_FALSE(both(a, b)) << a << ", " << b;
}

TEST_F(ConceptsTest, FindsTheThingInAPhrase) {
  const auto chair = table_.kinds_of("chair");
  ASSERT_FALSE(chair.empty());
  EXPECT_EQ(table_.kinds_of("Wooden kitchen chairs"), chair);
  EXPECT_EQ(table_.kinds_of("chair with four legs"), chair);
  EXPECT_EQ(table_.kinds_of("bottle of milk"), table_.kinds_of("bottle"));
  EXPECT_TRUE(table_.kinds_of("something to sit on").empty());
  EXPECT_TRUE(table_.kinds_of("").empty());
  EXPECT_FALSE(table_.compatible(chair, {}));
}

TEST_F(ConceptsTest, HasEveryHouseholdWordOnce) {
  std::vector<std::string> words;
  for (const auto& [word, kind] : table_.household()) {
    words.push_back(word);
    EXPECT_TRUE(table_.is_kind_of(kind, kind));
  }
  std::sort(words.begin(), words.end());
  EXPECT_TRUE(std::adjacent_find(words.begin(), words.end()) == words.end());
  EXPECT_GT(words.size(), 200u);
}

TEST(Concepts, RefusesWhatIsNoTable) {
  EXPECT_THROW(Concepts({"chair"}), Error);
  EXPECT_THROW(Concepts({"chair;1", "seat;"}), Error);
}

TEST_F(ConceptsTest, KnowsWholeTextsAndNotTheirEnds) {
  for (const char* text : {"mug", "Mugs", "trash can"}) EXPECT_TRUE(table_.knows(text)) << text;
  for (const char* text : {"Anna's mug", "", "zeppelin hangar"})
    EXPECT_FALSE(table_.knows(text)) << text;
}

}  // namespace
}  // namespace ovimap
