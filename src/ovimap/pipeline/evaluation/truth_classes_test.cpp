// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/evaluation/truth_classes.h"

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"

namespace ovimap {
namespace {

void expect_words(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words)
    EXPECT_NE(text.find(word), std::string::npos) << word << ": " << text;
}

const TruthClasses kDen{"den", {4, 4, 7, 0, -1, 9}, {{4, "sofa"}, {7, "teapot"}, {9, "mug"}}};

TEST(TruthClasses, TheirNamesMakeASet) {
  const TruthClasses other{"attic", {1, 2}, {{1, "mug"}, {2, "bed"}}};
  const LabelSet set = label_set_of({kDen, other});
  EXPECT_EQ(set.name, "truth");
  ASSERT_EQ(set.labels.size(), 4u);
  EXPECT_EQ(set.labels[0].name, "bed");
  EXPECT_EQ(set.labels[1].name, "mug");
  EXPECT_EQ(number_classes(kDen, set).numbers, (std::vector<std::int32_t>{3, 3, 4, 0, 0, 2}));
  EXPECT_EQ(number_classes(other, set).numbers, (std::vector<std::int32_t>{2, 1}));
  EXPECT_TRUE(number_classes(other, set).unknown.empty());
  expect_words(error_of([] {
                 label_set_of({kDen, {"cellar", {1}, {}}});
               }),
               {"cellar", "--classes"});
}

TEST(TruthClasses, GoIntoASetByName) {
  const LabelSet set = read_label_set("scannet200");
  const NumberedClasses numbered = number_classes(kDen, set);
  EXPECT_EQ(set.labels[static_cast<std::size_t>(numbered.numbers[0] - 1)].name, "couch");
  EXPECT_EQ(numbered.numbers[2], 0);
  EXPECT_EQ(set.labels[static_cast<std::size_t>(numbered.numbers[5] - 1)].name, "cup");
  EXPECT_EQ(numbered.unknown, std::vector<std::string>{"teapot"});
  EXPECT_DOUBLE_EQ(numbered.unknown_share, 0.25);
}

TEST(TruthClasses, WithoutNamesIdsAreTheSetsOwn) {
  const LabelSet set = read_label_set("replica51");
  const TruthClasses truth{"office0", {93, 31, -2, 256, 0}, {}};
  EXPECT_EQ(number_classes(truth, set).numbers, (std::vector<std::int32_t>{1, 2, 0, 0, 0}));
}

TEST(TruthClasses, RefusesWhatNothingNames) {
  const LabelSet set = read_label_set("replica51");
  expect_words(error_of([&] {
                 number_classes({"office0", {93, 777}, {}}, set);
               }),
               {"office0", "777", "replica51"});
  expect_words(error_of([&] {
                 number_classes({"den", {4, 777}, kDen.names}, set);
               }),
               {"den", "777", "labels.json"});
  expect_words(error_of([&] {
                 number_classes({"den", {7}, kDen.names}, set);
               }),
               {"nothing", "den", "replica51", "--classes truth"});
  expect_words(error_of([&] { number_classes({"den", {0, -1}, kDen.names}, set); }), {"nothing"});
}

}  // namespace
}  // namespace ovimap
