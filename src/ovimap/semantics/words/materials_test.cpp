// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/materials.h"

#include <gtest/gtest.h>

#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {
namespace {

using WordList = std::vector<std::string>;

class MaterialsTest : public ::testing::Test {
 protected:
  WordList materials(const char* text) const { return material_words(text, table_); }
  Concepts table_{list_entries(builtin_word_list("concepts"))};
};

TEST_F(MaterialsTest, StandBeforeAThing) {
  EXPECT_EQ(materials("wooden table"), WordList{"wooden"});
  EXPECT_EQ(materials("old Striped leather armchair"), (WordList{"striped", "leather"}));
  EXPECT_EQ(materials("table"), WordList{});
  EXPECT_EQ(materials("a chair with wooden legs"), WordList{});
  EXPECT_EQ(materials(""), WordList{});
}

TEST_F(MaterialsTest, AreNoneInNamesOfThings) {
  for (const char* name : {"glass", "wine glass", "wooden spoon", "plastic bag", "Wooden spoons"})
    EXPECT_EQ(materials(name), WordList{}) << name;
  EXPECT_EQ(materials("metal wine glass"), WordList{"metal"});
  EXPECT_EQ(materials("glass of water"), WordList{});
}

}  // namespace
}  // namespace ovimap
