// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/past/time_words.h"

#include <gtest/gtest.h>

#include <ctime>

#include "ovimap/base/error_fixture.h"
#include "ovimap/semantics/query/query_words.h"

namespace ovimap {
namespace {

double local(int year, int month, int day, int hour = 0, int minute = 0, int second = 0) {
  std::tm time{};
  time.tm_year = year - 1900, time.tm_mon = month - 1, time.tm_mday = day;
  time.tm_hour = hour, time.tm_min = minute, time.tm_sec = second;
  time.tm_isdst = -1;
  return static_cast<double>(std::mktime(&time));
}

// A Wednesday.
const double kWednesday = local(2026, 3, 18, 15, 20);

std::optional<TimeAsked> read_time(const std::string& text) {
  return parse_time(words_of(text), kWednesday);
}

void expect_span(const std::string& text, double begin_s, double end_s) {
  const auto time = read_time(text);
  ASSERT_TRUE(time) << text;
  EXPECT_EQ(time->visit, 0) << text;
  EXPECT_EQ(time->begin_s, begin_s) << text;
  EXPECT_EQ(time->end_s, end_s) << text;
}

TEST(TimeWords, NamesVisits) {
  EXPECT_EQ(read_time("visit 2"), (TimeAsked{2, 0, 0}));
  EXPECT_EQ(read_time("the first visit"), (TimeAsked{1, 0, 0}));
  EXPECT_EQ(read_time("Last Visit"), (TimeAsked{TimeAsked::kLastVisit, 0, 0}));
}

TEST(TimeWords, NamesDatesAndHours) {
  expect_span("2026-03-14", local(2026, 3, 14), local(2026, 3, 15));
  expect_span("2025-12-31", local(2025, 12, 31), local(2026, 1, 1));
  for (const char* text : {"2026-03-14T09:30", "2026-03-14 09:30", "2026-03-14 9:30"})
    expect_span(text, local(2026, 3, 14, 9, 30), local(2026, 3, 14, 9, 31));
  expect_span("2026-03-14T09:30:15", local(2026, 3, 14, 9, 30, 15), local(2026, 3, 14, 9, 30, 16));
  expect_span("9:30", local(2026, 3, 18, 9, 30), local(2026, 3, 18, 9, 31));
  expect_span("now", kWednesday, kWednesday);
}

TEST(TimeWords, NamesDaysAsPeopleDo) {
  expect_span("today", local(2026, 3, 18), local(2026, 3, 19));
  expect_span("yesterday", local(2026, 3, 17), local(2026, 3, 18));
  expect_span("Monday", local(2026, 3, 16), local(2026, 3, 17));
  expect_span("thursday", local(2026, 3, 12), local(2026, 3, 13));
  expect_span("Wednesday", local(2026, 3, 18), local(2026, 3, 19));
  expect_span("last Wednesday", local(2026, 3, 11), local(2026, 3, 12));
  expect_span("yesterday evening", local(2026, 3, 17, 18), local(2026, 3, 18));
  expect_span("this morning", local(2026, 3, 18, 5), local(2026, 3, 18, 12));
  expect_span("last Monday 9:30", local(2026, 3, 16, 9, 30), local(2026, 3, 16, 9, 31));
  expect_span("two hours ago", kWednesday - 7200, kWednesday - 3600);
  expect_span("an hour ago", kWednesday - 3600, kWednesday);
  expect_span("3 days ago", local(2026, 3, 15), local(2026, 3, 16));
  expect_span("a week ago", local(2026, 3, 11), local(2026, 3, 12));
}

TEST(TimeWords, OtherWordsAreNoTimes) {
  for (const char* text : {"",
                           "the",
                           "mug",
                           "table",
                           "visit",
                           "visit 0",
                           "visit two",
                           "visit -1",
                           "room 2",
                           "2",
                           "2026",
                           "2026-13-01",
                           "2026-02-31",
                           "2026-03-14T",
                           "2026-03-14T25:00",
                           "2026-03-14 9:3",
                           "9:60",
                           "25:00",
                           "last",
                           "last mug",
                           "this",
                           "this mug",
                           "Monday mug",
                           "Monday Tuesday",
                           "days ago",
                           "two mugs ago",
                           "evening",
                           "2026-03-14x",
                           "2026-03-14 -1:30",
                           "visit 99999999999"})
    EXPECT_FALSE(read_time(text)) << text;
}

TEST(TimeWords, SaysWhatATimeIs) {
  EXPECT_EQ(time_of_text("visit 3", kWednesday).visit, 3);
  const std::string fault = error_of([] { time_of_text("some day", kWednesday); });
  EXPECT_NE(fault.find("'some day' is no time; give a visit"), std::string::npos);
}

TEST(TimeWords, DatesAreLocal) {
  EXPECT_EQ(date_text(kWednesday), "2026-03-18 15:20");
}

}  // namespace
}  // namespace ovimap
