// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ovimap/base/error.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/semantics/past/history_words.h"

namespace ovimap {

/// A moment that this map knows nothing of.
class MomentUnknown : public Error {
 public:
  using Error::Error;
};

/// When something was seen.
struct Sighting {
  int visit = 1;                 ///< from 1
  std::optional<double> time_s;  ///< since 1970 (UTC)
};

/// Whether a frame's time is a date, seconds since 1970; else it counts from the start of a
/// recording, or of a machine.
bool is_date(double timestamp_s);

/// When the visits of a map were and its events happened: as people said of a recording, else as
/// its frames say where their times are dates. Seconds since 1970 (UTC).
class HistoryDates {
 public:
  HistoryDates(const MapHistory& history, std::span<const FrameLogEntry> frames);

  /// A map of one recording has one visit.
  int visits() const { return static_cast<int>(begins_.size()); }
  /// When the first frame of visit 1, 2, ... was taken, and its last.
  std::optional<double> begin_of(int visit) const { return begins_[index(visit)]; }
  std::optional<double> end_of(int visit) const { return ends_[index(visit)]; }
  /// When the frame of an event of the history was taken.
  std::optional<double> date_of(std::size_t event) const { return events_[event]; }
  /// When a frame was taken, by its FrameLogEntry::index; none that the map does not have.
  std::optional<Sighting> sighting(std::int64_t frame) const;

  /// Whether an event of the history had been noticed by then.
  bool happened(const MapHistory& history, std::size_t event, const MapMoment& moment) const;
  /// Throws MomentUnknown for a visit that the map does not have, and for a date where it has none.
  void require_known(const MapMoment& moment) const;
  /// The same, and for a date before the map begins.
  void require(const MapMoment& moment) const;

  /// "visit 2, 2026-03-14 09:30", or "visit 2" where nobody knows when that was.
  std::string visit_text(int visit) const;
  /// "visit 2" or "2026-03-14 09:30".
  std::string text_of(const MapMoment& moment) const;

 private:
  static std::size_t index(int visit) { return static_cast<std::size_t>(visit - 1); }

  struct DatedFrame {
    std::int64_t index;
    Sighting seen;
  };

  std::vector<std::optional<double>> begins_, ends_, events_;
  std::vector<DatedFrame> frames_;  ///< by index
};

/// When the last frame was taken whose segments showed an object of these super-points; none: the
/// map does not know.
std::optional<Sighting> last_seen(const MapRecord& record, const HistoryDates& dates,
                                  std::span<const Label> super_points);

/// "moved from (1.00, 2.00, 0.50) to (0.20, 1.10, 0.50)": centres of boxes, metres in the world.
std::string event_text(const ObjectEvent& event);

}  // namespace ovimap
