// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ovimap {

/// A time that a person named: a visit of a map, or a stretch of time.
struct TimeAsked {
  static constexpr int kLastVisit = -1;
  int visit = 0;                  ///< from 1, or kLastVisit; 0: `begin_s` and `end_s` are meant
  double begin_s = 0, end_s = 0;  ///< seconds since 1970 (UTC); equal for a moment

  bool operator==(const TimeAsked&) const = default;
};

/// Reads "visit 2", "last visit", "2026-03-14", "2026-03-14T09:30", "9:30", "Monday", "last
/// Monday", "today", "yesterday evening", "this morning", "2 days ago", in any case of letters;
/// docs/query.md has all. Nothing for other words. Days and hours are those of this machine's time
/// zone. `now_s`: seconds since 1970 (UTC).
std::optional<TimeAsked> parse_time(std::span<const std::string> words, double now_s);

/// The same of a text that must be a time. Throws Error.
TimeAsked time_of_text(std::string_view text, double now_s);

/// Seconds since 1970 (UTC) by this machine's clock.
double seconds_now();

/// "2026-03-14 09:30" in this machine's time zone.
std::string date_text(double time_s);

}  // namespace ovimap
