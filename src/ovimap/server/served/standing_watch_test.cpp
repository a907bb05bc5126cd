// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/served/standing_watch.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

using std::chrono::seconds;

StandingVerdict found(InstanceId id) {
  StandingObject object;
  object.id = id;
  object.title = "mug";
  return {object, ""};
}
const StandingVerdict kAbsent;

/// A watch for a mug and a fire extinguisher whose verdicts the test decides, by a clock of its
/// own.
class StandingWatchTest : public testing::Test {
 protected:
  /// The map says so, and time goes by; what is told then, in short.
  std::string after(int passed_s, const StandingVerdict& mug, const StandingVerdict& extinguisher,
                    bool live = true) {
    watch_.take({&mug, &extinguisher}, now_);
    watch_.settle(live, now_);
    now_ += seconds(passed_s);
    watch_.settle(live, now_);
    return told(watch_);
  }
  static std::string told(StandingWatch& watch) {
    constexpr std::array kNames = {"found ", "gone ", "fault "};
    std::string text;
    while (const auto event = watch.next()) {
      text += kNames[static_cast<std::size_t>(event->kind)] + event->query;
      if (event->object) text += " " + std::to_string(event->object->id);
      text += event->fault + ";";
    }
    return text;
  }

  StandingWatch watch_{{"mug", "extinguisher"}, seconds(3), nullptr};
  StandingWatch::Clock::time_point now_;
};

TEST_F(StandingWatchTest, IsToldOnceWhenFoundAndOnceWhenGone) {
  EXPECT_EQ(after(9, kAbsent, kAbsent), "");
  EXPECT_EQ(after(9, kAbsent, found(7)), "found extinguisher 7;");
  EXPECT_EQ(after(9, kAbsent, found(5)), "") << "an object that merges into another is the same";
  EXPECT_EQ(after(9, kAbsent, kAbsent), "gone extinguisher 5;");
  EXPECT_EQ(after(9, found(3), found(7)), "found mug 3;found extinguisher 7;");
}

TEST_F(StandingWatchTest, WhatDoesNotLastIsNotTold) {
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(after(1, found(7), kAbsent) + after(1, kAbsent, kAbsent), "");
  EXPECT_EQ(after(3, found(7), kAbsent), "found mug 7;");
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(after(1, kAbsent, kAbsent) + after(1, found(7), kAbsent), "");
}

TEST_F(StandingWatchTest, AFinishedMapIsToldOfAtOnce) {
  EXPECT_EQ(after(0, found(7), kAbsent, false), "found mug 7;");
  EXPECT_EQ(after(0, kAbsent, kAbsent, false), "gone mug 7;");
}

TEST_F(StandingWatchTest, AQueryThatCannotBeAskedLeavesTheOthersAlone) {
  const StandingVerdict broken{std::nullopt, "names nothing"};
  EXPECT_EQ(after(9, found(7), broken), "found mug 7;fault extinguishernames nothing;");
  EXPECT_EQ(after(9, found(7), broken), "");
  EXPECT_EQ(after(9, broken, found(1)), "fault mugnames nothing;found extinguisher 1;");
  EXPECT_EQ(after(9, found(7), found(1)), "") << "what was told stays told";
}

TEST_F(StandingWatchTest, AMapThatCannotBeSearchedIsToldOfOnce) {
  watch_.take_fault("no encoder");
  watch_.take_fault("no encoder");
  EXPECT_EQ(told(watch_), "fault no encoder;");
  watch_.take_fault("");
  EXPECT_EQ(told(watch_), "");
  watch_.take_fault("no encoder");
  EXPECT_EQ(told(watch_), "fault no encoder;");
}

TEST_F(StandingWatchTest, AClientThatComesBackIsToldWhatItMissed) {
  EXPECT_EQ(watch_.mark(), "0");
  EXPECT_EQ(after(9, found(7), kAbsent), "found mug 7;");
  EXPECT_EQ(watch_.mark(), "8");
  const auto back = [&](const std::string& mark, const StandingVerdict& mug,
                        const StandingVerdict& extinguisher) {
    StandingWatch again({"mug", "extinguisher"}, seconds(3), nullptr);
    again.go_on(mark);
    EXPECT_EQ(told(again), "") << "nothing is known yet";
    again.take({&mug, &extinguisher}, now_);
    again.settle(false, now_);
    return told(again);
  };
  EXPECT_EQ(back("8", found(7), kAbsent), "");
  EXPECT_EQ(back("8", found(7), found(1)), "found extinguisher 1;");
  EXPECT_EQ(back("8", kAbsent, kAbsent), "gone mug;");
  for (const char* nonsense : {"", "80", "x", "\x80"})
    EXPECT_EQ(back(nonsense, found(7), kAbsent), "found mug 7;") << nonsense;
}

TEST_F(StandingWatchTest, ASlowClientLearnsHowThingsAre) {
  int woken = 0;
  watch_.call([&] { ++woken; });
  for (int i = 0; i < 10; ++i) {
    for (const StandingVerdict& mug : {kAbsent, found(7)}) {
      watch_.take({&mug, &kAbsent}, now_);
      watch_.settle(false, now_);
    }
  }
  EXPECT_GT(woken, 0);
  EXPECT_EQ(told(watch_), "found mug 7;") << "nothing piles up";
}

}  // namespace
}  // namespace ovimap
