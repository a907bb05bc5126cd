// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/past/history_words.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovimap {
namespace {

constexpr double kNow = 1'773'840'000;  // in March 2026

HistoryPhrase read(const std::string& text) {
  const auto phrase = parse_history(text, kNow);
  EXPECT_TRUE(phrase) << text;
  return phrase.value_or(HistoryPhrase{});
}

TEST(HistoryWords, WhatChanged) {
  const HistoryPhrase moved = read("what moved since visit 1");
  EXPECT_EQ(moved.text, "anything");
  EXPECT_EQ(moved.change, AskedChange::kMoved);
  EXPECT_EQ(moved.since, (TimeAsked{1, 0, 0}));
  EXPECT_FALSE(moved.at || moved.before || moved.place_before);
  for (const char* text : {"what is gone", "what has been removed?", "what went missing",
                           "which things are gone", "things that have disappeared"})
    EXPECT_EQ(read(text).change, AskedChange::kGone) << text;
  EXPECT_EQ(read("what is new").change, AskedChange::kAppeared);
  EXPECT_EQ(read("what changed yesterday").change, AskedChange::kAny);
  EXPECT_TRUE(read("what changed yesterday").at);
  EXPECT_EQ(read("which red chairs moved since Monday").text, "red chairs");
  EXPECT_EQ(read("mugs on the table that moved").text, "mugs on the table");
  const HistoryPhrase within = read("what moved since visit 1 before visit 3");
  EXPECT_EQ(within.since->visit, 1);
  EXPECT_EQ(within.before->visit, 3);
}

TEST(HistoryWords, WhatWasWhere) {
  const HistoryPhrase where = read("where was the mug?");
  EXPECT_TRUE(where.place_before);
  EXPECT_EQ(where.text, "mug");
  EXPECT_FALSE(where.change);
  const HistoryPhrase then = read("where was the mug on the table on visit 1");
  EXPECT_FALSE(then.place_before) << "visit 1 says when";
  EXPECT_EQ(then.at, (TimeAsked{1, 0, 0}));
  EXPECT_EQ(then.text, "mug on the table");
  EXPECT_EQ(read("red mug at 2026-03-14").text, "red mug");
  EXPECT_EQ(read("mug two days ago").text, "mug");
  EXPECT_TRUE(read("mug before visit 2").before);
  EXPECT_EQ(read("mug since visit 2").change, AskedChange::kAny);
  EXPECT_EQ(read("where was the mug since visit 2").at, (TimeAsked{2, 0, 0}));
}

TEST(HistoryWords, OtherTextsAskOfThePresent) {
  for (const char* text :
       {"", "mug", "mug on the table", "chair in room 2", "what is on the table", "moved", "new",
        "new chair", "what", "where was", "where is the mug", "a calendar of Monday",
        "alarm clock at night", "chair before the window", "\"what moved since Monday\"",
        "\"mug yesterday\"", "sunday", "mug on Monday on Tuesday on the table"})
    EXPECT_FALSE(parse_history(text, kNow)) << text;
}

TEST(HistoryWords, MomentsOfTimes) {
  const TimeAsked day{0, 100, 200}, second{2, 0, 0}, last{TimeAsked::kLastVisit, 0, 0};
  EXPECT_EQ(beginning_of(day, 3), (MapMoment{0, 100}));
  EXPECT_EQ(end_of(day, 3), (MapMoment{0, 200}));
  EXPECT_EQ(since_of(day, 3), (MapMoment{0, 100}));
  EXPECT_EQ(beginning_of(second, 3), (MapMoment{1, 0}));
  EXPECT_EQ(end_of(second, 3), (MapMoment{2, 0}));
  EXPECT_EQ(since_of(second, 3), (MapMoment{2, 0}));
  EXPECT_EQ(end_of(last, 3), (MapMoment{3, 0}));
  EXPECT_TRUE(std::isinf(beginning_of({1, 0, 0}, 3).time_s));
}

}  // namespace
}  // namespace ovimap
