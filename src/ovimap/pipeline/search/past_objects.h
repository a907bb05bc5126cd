// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "ovimap/pipeline/search/history_dates.h"

namespace ovimap {

/// An object as it was at a moment of the map's history.
struct PastState {
  InstanceSummary summary;
  std::vector<Eigen::Vector3f> surface;  ///< thinned; empty: the map did not keep it
  std::size_t event = 0;  ///< 1 + place of the event that ended this state; 0: it is so now
};
using PastStates = std::map<InstanceId, PastState>;

/// The objects as the map knew them then. An object of which no event tells is taken to have been
/// where it is; of what left its place in maps that did not keep it, its box alone is known.
/// `corrected`: as people made it. Throws MomentUnknown.
PastStates states_at(const MapRecord& corrected, const HistoryDates& dates,
                     const MapMoment& moment);

/// Where each object was before it came to where it is or went: objects that never moved are as
/// they are now.
PastStates states_before_last(const MapRecord& corrected);

/// What became of an object between two moments.
struct HistoryChange {
  InstanceId instance = 0;
  ObjectEventKind kind = ObjectEventKind::kAppeared;
  std::size_t first = 0, last = 0;  ///< places of the first and the last of its events in between
};

/// By instance. What came and went in between is left out. `since` may be before the map begins.
/// Throws MomentUnknown.
std::vector<HistoryChange> changes_between(const MapHistory& history, const HistoryDates& dates,
                                           const MapMoment& since, const MapMoment& until);

/// What became of objects between two moments that people name.
struct MapChanges {
  MapMoment since, until;
  std::vector<HistoryChange> changes;  ///< by instance
};

/// `since`, `until`: as time_of_text takes them, with `now_s`; empty: before the map begins, and
/// its last visit. Throws Error for what is no time, and MomentUnknown.
MapChanges changes_between(const MapHistory& history, const HistoryDates& dates,
                           const std::string& since, const std::string& until, double now_s);

/// "moved from (...) to (...), visit 2, 2026-03-14 09:30".
std::string change_text(const HistoryChange& change, const MapHistory& history,
                        const HistoryDates& dates);

}  // namespace ovimap
