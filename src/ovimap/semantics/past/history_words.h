// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "ovimap/semantics/past/time_words.h"

namespace ovimap {

/// A moment of a map's history.
struct MapMoment {
  int visit = 0;      ///< when that visit of the map ended; 0: at `time_s`
  double time_s = 0;  ///< seconds since 1970 (UTC); minus infinity: before everything

  bool operator==(const MapMoment&) const = default;
};

/// Before everything.
constexpr MapMoment kBeginning{0, -std::numeric_limits<double>::infinity()};

/// When a time began, or ended. `last_visit`: which one that is.
MapMoment beginning_of(const TimeAsked& time, int last_visit);
MapMoment end_of(const TimeAsked& time, int last_visit);
/// When what happened "since" then begins: with the first moment of a day, and with the end of a
/// visit.
MapMoment since_of(const TimeAsked& time, int last_visit);

enum class AskedChange { kAny, kMoved, kGone, kAppeared };

/// A question about a map's past: what is asked for, and when.
struct HistoryPhrase {
  std::string text;  ///< the rest of the question, in the grammar of query_grammar.h
  std::optional<AskedChange> change;       ///< only what changed so, "mugs that moved"
  bool place_before = false;               ///< "where was the mug": where it was before where it is
  std::optional<TimeAsked> since, before;  ///< of changes; `before` alone: the map as it was
  std::optional<TimeAsked> at;  ///< the map as it was; with `change`: what changed within that time

  bool operator==(const HistoryPhrase&) const = default;
};

/// Reads questions such as "what moved since Monday", "where was the mug", "chairs that are gone",
/// "mug on Monday", "red chair before visit 2" (docs/query.md has the grammar). Nothing for a text
/// that asks of the present; what stands between double quotes is never read so. `now_s`: as
/// parse_time takes it.
std::optional<HistoryPhrase> parse_history(std::string_view text, double now_s);

/// "moved", "is gone", "appeared", "changed".
const char* change_words(AskedChange change);

}  // namespace ovimap
