// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/named_things.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/semantics/words/word_lists.h"

namespace ovimap {
namespace {

/// Three objects: a chair, a screen, and one that was not looked at.
class NamedThingsTest : public ::testing::Test {
 protected:
  NamedThingsTest() {
    seen_.words = {"chair", "television|monitor", "toilet"};
    seen_.log_ratios.resize(3, 3);
    seen_.log_ratios << 4.f, -2.f, -2.f,  //
        -2.f, 5.f, -1.f,                  //
        0.f, 0.f, 0.f;
  }
  Eigen::VectorXf of(const char* text) const {
    return NamedThings(concepts_, seen_).log_ratios(text);
  }

  Concepts concepts_{list_entries(builtin_word_list("concepts"))};
  SeenThings seen_;
};

TEST_F(NamedThingsTest, KnowsSynonymsAndNarrowerWords) {
  for (const char* text : {"chair", "armchair", "wooden kitchen chair", "office chairs"})
    EXPECT_EQ(of(text), Eigen::Vector3f(4, -2, 0)) << text;
  for (const char* text : {"monitor", "tv", "screen", "television set"})
    EXPECT_EQ(of(text), Eigen::Vector3f(-2, 5, 0)) << text;
}

TEST_F(NamedThingsTest, WiderWordsAreTheMeanOfWhatTheyStandFor) {
  const Eigen::VectorXf seat = of("seat"), furniture = of("furniture");
  ASSERT_EQ(seat.size(), 3);
  EXPECT_GT(seat[0], 1.f);
  EXPECT_LT(seat[0], 4.f) << "a seat may be a stool, of which nothing is known";
  EXPECT_LT(furniture[0], seat[0]) << "most furniture is no chair";
  EXPECT_GT(furniture[0], furniture[1]);
  EXPECT_FLOAT_EQ(seat[2], 0.f);
}

TEST_F(NamedThingsTest, SaysNothingOfOtherThings) {
  EXPECT_EQ(of("poster").size(), 0);
  EXPECT_EQ(of("something").size(), 0);
  EXPECT_EQ(of("").size(), 0);
  seen_ = {};
  EXPECT_EQ(of("chair").size(), 0);
}

TEST_F(NamedThingsTest, AStoolIsNoToilet) {
  EXPECT_EQ(of("stool").size(), 0);
  EXPECT_EQ(of("toilet").size(), 3);
}

TEST_F(NamedThingsTest, TwoNamesForOneThingCountLessThanTwice) {
  seen_.words = {"chair", "seat", "toilet"};
  seen_.log_ratios.col(1) = seen_.log_ratios.col(0);
  const Eigen::VectorXf chair = of("chair");
  EXPECT_GT(chair[0], 4.f);
  EXPECT_LT(chair[0], 8.f);
}

}  // namespace
}  // namespace ovimap
