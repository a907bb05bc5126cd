// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/past/time_words.h"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <ctime>

#include "ovimap/base/error.h"
#include "ovimap/base/text/ascii.h"
#include "ovimap/semantics/query/query_words.h"

namespace ovimap {

namespace {

constexpr std::array<std::string_view, 7> kDays{"sunday",   "monday", "tuesday", "wednesday",
                                                "thursday", "friday", "saturday"};
constexpr int kDaysOfWeek = 7, kHoursOfDay = 24;
constexpr double kDay_s = 86400;

struct PartOfDay {
  std::string_view word;
  int begin_h, end_h;
};
constexpr std::array kPartsOfDay{PartOfDay{"morning", 5, 12}, PartOfDay{"afternoon", 12, 18},
                                 PartOfDay{"evening", 18, kHoursOfDay}};

struct Unit {
  std::string_view word;
  double seconds;
};
constexpr std::array kTimeUnits{Unit{"minute", 60}, Unit{"hour", 3600}, Unit{"day", kDay_s},
                                Unit{"week", kDaysOfWeek* kDay_s}};

std::tm local_time(double time_s) {
  const auto seconds = static_cast<std::time_t>(std::floor(time_s));
  std::tm local{};
  localtime_r(&seconds, &local);
  return local;
}

/// Of a calendar's fields, which may be beyond their ranges: day 0 is the last of the month before.
double seconds_of(std::tm local) {
  local.tm_isdst = -1;
  return static_cast<double>(std::mktime(&local));
}

/// An hour of the day that lies `days` before today.
double hour_of_day(double now_s, int days, int hour) {
  std::tm local = local_time(now_s);
  local.tm_mday -= days;
  local.tm_hour = hour;
  local.tm_min = local.tm_sec = 0;
  return seconds_of(local);
}

TimeAsked day_before(double now_s, int days) {
  return {0, hour_of_day(now_s, days, 0), hour_of_day(now_s, days, kHoursOfDay)};
}

/// Takes a number of `digits` digits and what must follow it off the front.
std::optional<int> take_number(std::string_view& text, std::size_t least, std::size_t most,
                               std::string_view mark) {
  unsigned number = 0;  // which takes no sign
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  const auto length = static_cast<std::size_t>(end - text.data());
  if (fault != std::errc() || length < least || length > most) return std::nullopt;
  if (text.substr(length, mark.size()) != mark) return std::nullopt;
  text.remove_prefix(length + mark.size());
  return static_cast<int>(number);
}

/// "9:30" or "09:30:15" into the hours of `local`; how long that lasts, in seconds.
std::optional<double> take_clock(std::string_view text, std::tm& local) {
  const auto hour = take_number(text, 1, 2, ":");
  const auto minute = take_number(text, 2, 2, "");
  if (!hour || !minute || *hour > kHoursOfDay || *minute > 59) return std::nullopt;
  local.tm_hour = *hour;
  local.tm_min = *minute;
  local.tm_sec = 0;
  if (text.empty()) return 60;
  if (text.front() != ':') return std::nullopt;
  text.remove_prefix(1);
  const auto second = take_number(text, 2, 2, "");
  if (!second || *second > 60 || !text.empty()) return std::nullopt;
  local.tm_sec = *second;
  return 1;
}

/// "2026-03-14", "2026-03-14T09:30", "2026-03-14 09:30".
std::optional<TimeAsked> parse_date(Words words) {
  std::string_view text = words[0];
  const auto year = take_number(text, 4, 4, "-");
  const auto month = year ? take_number(text, 2, 2, "-") : std::nullopt;
  const auto day = month ? take_number(text, 2, 2, "") : std::nullopt;
  if (!day || *month < 1 || *month > 12 || *day < 1 || *day > 31) return std::nullopt;
  std::tm local{};
  local.tm_year = *year - 1900;
  local.tm_mon = *month - 1;
  local.tm_mday = *day;
  if (local_time(seconds_of(local)).tm_mday != *day) return std::nullopt;  // the 31st of February
  const bool joined = !text.empty() && (text.front() == 'T' || text.front() == 't');
  if (joined) text.remove_prefix(1);
  if (joined != !text.empty() || words.size() > (joined ? 1U : 2U)) return std::nullopt;
  if (!joined && words.size() == 1) {
    std::tm next = local;
    ++next.tm_mday;
    return TimeAsked{0, seconds_of(local), seconds_of(next)};
  }
  const auto lasts_s = take_clock(joined ? text : std::string_view(words[1]), local);
  if (!lasts_s) return std::nullopt;
  return TimeAsked{0, seconds_of(local), seconds_of(local) + *lasts_s};
}

std::optional<TimeAsked> parse_visit(Words words) {
  if (words.size() != 2) return std::nullopt;
  const std::string first = lower_case(words[0]), second = lower_case(words[1]);
  if (second == "visit" && first == "first") return TimeAsked{1, 0, 0};
  if (second == "visit" && first == "last") return TimeAsked{TimeAsked::kLastVisit, 0, 0};
  std::string_view text = words[1];
  const auto number = first == "visit" ? take_number(text, 1, 6, "") : std::nullopt;
  if (!number || *number < 1 || !text.empty()) return std::nullopt;
  return TimeAsked{*number, 0, 0};
}

/// "an hour ago", "2 days ago": from then on a minute, an hour, a day.
std::optional<TimeAsked> parse_ago(Words words, double now_s) {
  if (words.size() != 3 || lower_case(words[2]) != "ago") return std::nullopt;
  const bool one = plays(words[0], WordRole::kArticle) || words[0] == "1";
  const int count = one ? 1 : number_of(words[0]);
  const std::string unit = lower_case(words[1]);
  for (const Unit& known : kTimeUnits) {
    if (count == 0 || !unit.starts_with(known.word) || unit.size() > known.word.size() + 1)
      continue;
    const double then_s = now_s - count * known.seconds;
    if (known.seconds < kDay_s) return TimeAsked{0, then_s, then_s + known.seconds};
    return day_before(now_s, static_cast<int>(std::lround(count * known.seconds / kDay_s)));
  }
  return std::nullopt;
}

/// The days before today that a word names; negative: none.
int days_back(Words words, double now_s) {
  const std::string first = lower_case(words[0]);
  if (words.size() == 1 && first == "today") return 0;
  if (words.size() == 1 && first == "yesterday") return 1;
  const bool last = words.size() == 2 && first == "last";
  const std::string day = lower_case(words.back());
  for (int i = 0; i < kDaysOfWeek; ++i) {
    if (day != kDays[static_cast<std::size_t>(i)] || words.size() > (last ? 2U : 1U)) continue;
    const int back = (local_time(now_s).tm_wday + kDaysOfWeek - i) % kDaysOfWeek;
    return last && back == 0 ? kDaysOfWeek : back;  // else the latest such day, today included
  }
  return -1;
}

/// "yesterday evening", "this morning", "Monday morning", "Monday 9:30".
std::optional<TimeAsked> parse_day(Words words, double now_s) {
  if (const int back = days_back(words, now_s); back >= 0) return day_before(now_s, back);
  if (words.size() < 2) return std::nullopt;
  const bool today = words.size() == 2 && lower_case(words[0]) == "this";
  const int back = today ? 0 : days_back(words.first(words.size() - 1), now_s);
  if (back < 0) return std::nullopt;
  for (const PartOfDay& part : kPartsOfDay)
    if (lower_case(words.back()) == part.word)
      return TimeAsked{0, hour_of_day(now_s, back, part.begin_h),
                       hour_of_day(now_s, back, part.end_h)};
  std::tm local = local_time(hour_of_day(now_s, back, 0));
  const auto lasts_s = take_clock(words.back(), local);
  if (!lasts_s) return std::nullopt;
  return TimeAsked{0, seconds_of(local), seconds_of(local) + *lasts_s};
}

std::optional<TimeAsked> parse_clock(Words words, double now_s) {
  if (words.size() != 1) return std::nullopt;
  if (lower_case(words[0]) == "now") return TimeAsked{0, now_s, now_s};
  std::tm local = local_time(now_s);
  const auto lasts_s = take_clock(words[0], local);
  if (!lasts_s) return std::nullopt;
  return TimeAsked{0, seconds_of(local), seconds_of(local) + *lasts_s};
}

}  // namespace

std::optional<TimeAsked> parse_time(std::span<const std::string> words, double now_s) {
  if (words.size() > 1 && lower_case(words[0]) == "the") words = words.subspan(1);
  if (words.empty()) return std::nullopt;
  if (const auto visit = parse_visit(words)) return visit;
  if (const auto date = parse_date(words)) return date;
  if (const auto ago = parse_ago(words, now_s)) return ago;
  if (const auto day = parse_day(words, now_s)) return day;
  return parse_clock(words, now_s);
}

TimeAsked time_of_text(std::string_view text, double now_s) {
  const std::vector<std::string> words = words_of(text);
  if (const auto time = parse_time(words, now_s)) return *time;
  throw Error(
      concat("'", text,
             "' is no time; give a visit ('visit 2'), a date (2026-03-14, 2026-03-14T09:30) "
             "or words such as 'Monday', 'yesterday evening' or '2 hours ago'"));
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string date_text(double time_s) {
  const std::tm local = local_time(time_s);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &local)};
}

}  // namespace ovimap
