// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/history_dates.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ovimap {

namespace {

constexpr double kFirstDate_s = 978'307'200;  // the year 2001

std::string place_text(const Eigen::AlignedBox3f& box) {
  const Eigen::Vector3f center = box.center();
  char text[64];
  std::snprintf(text, sizeof text, "(%.2f, %.2f, %.2f)", double{center.x()}, double{center.y()},
                double{center.z()});
  return text;
}

}  // namespace

bool is_date(double timestamp_s) {
  return timestamp_s >= kFirstDate_s && std::isfinite(timestamp_s);
}

HistoryDates::HistoryDates(const MapHistory& history, std::span<const FrameLogEntry> frames) {
  std::vector<MapVisit> visits = history.visits;
  if (visits.empty()) visits.emplace_back();
  const auto count = static_cast<std::int64_t>(frames.size());
  const auto time_of = [&](std::int64_t frame) {
    return frames[static_cast<std::size_t>(frame)].timestamp_s;
  };
  const auto date_in = [&](const MapVisit& visit, std::int64_t frame) -> std::optional<double> {
    if (frame < visit.first_frame || frame >= count) return visit.recorded_s;
    if (visit.recorded_s) {
      const double since_s = time_of(frame) - time_of(visit.first_frame);
      return *visit.recorded_s + (std::isfinite(since_s) ? std::max(since_s, 0.) : 0.);
    }
    return is_date(time_of(frame)) ? std::optional(time_of(frame)) : std::nullopt;
  };
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const std::int64_t end = i + 1 < visits.size() ? visits[i + 1].first_frame : count;
    begins_.push_back(date_in(visits[i], visits[i].first_frame));
    ends_.push_back(date_in(visits[i], end - 1));
    for (std::int64_t frame = visits[i].first_frame; frame < std::min(end, count); ++frame)
      frames_.push_back({frames[static_cast<std::size_t>(frame)].index,
                         {static_cast<int>(i) + 1, date_in(visits[i], frame)}});
  }
  for (const ObjectEvent& event : history.events)
    events_.push_back(date_in(visits[index(event.visit)], event.frame));
}

std::optional<Sighting> HistoryDates::sighting(std::int64_t frame) const {
  const auto found = std::lower_bound(
      frames_.begin(), frames_.end(), frame,
      [](const DatedFrame& dated, std::int64_t index) { return dated.index < index; });
  if (found == frames_.end() || found->index != frame) return std::nullopt;
  return found->seen;
}

void HistoryDates::require_known(const MapMoment& moment) const {
  if (moment.visit > visits())
    throw MomentUnknown(concat("the map has no visit ", moment.visit, "; it has ", visits(),
                               ", which `ovimap info --history` lists"));
  const bool dated = std::any_of(begins_.begin(), begins_.end(),
                                 [](const auto& date) { return date.has_value(); });
  if (moment.visit == 0 && !std::isinf(moment.time_s) && !dated)
    throw MomentUnknown(
        "nobody told the map when its recordings were made, so no date can be asked for; name a "
        "visit ('visit 1'), or map with --recorded TIME");
}

void HistoryDates::require(const MapMoment& moment) const {
  require_known(moment);
  if (moment.visit == 0 && begins_.front() && moment.time_s < *begins_.front())
    throw MomentUnknown(concat("the map begins on ", date_text(*begins_.front()),
                               "; nothing is known of ", date_text(moment.time_s)));
}

bool HistoryDates::happened(const MapHistory& history, std::size_t event,
                            const MapMoment& moment) const {
  if (moment.visit > 0) return history.events[event].visit <= moment.visit;
  const std::optional<double> date = events_[event];
  if (!date) return false;  // of a visit without a date, after those that have one
  return *date < moment.time_s;
}

std::string HistoryDates::visit_text(int visit) const {
  const auto begin = begin_of(visit);
  return concat("visit ", visit, begin ? ", " + date_text(*begin) : std::string());
}

std::string HistoryDates::text_of(const MapMoment& moment) const {
  if (moment.visit > 0) return concat("visit ", moment.visit);
  return std::isinf(moment.time_s) ? "the beginning" : date_text(moment.time_s);
}

std::optional<Sighting> last_seen(const MapRecord& record, const HistoryDates& dates,
                                  std::span<const Label> super_points) {
  const InstanceRecord known = record_of(record.registry.super_points, super_points);
  return known.views > 0 ? dates.sighting(known.last_frame) : std::nullopt;
}

std::string event_text(const ObjectEvent& event) {
  switch (event.kind) {
    case ObjectEventKind::kGone:
      return concat("gone from ", place_text(event.before));
    case ObjectEventKind::kMoved:
      return concat("moved from ", place_text(event.before), " to ", place_text(event.after));
    case ObjectEventKind::kAppeared:
      return concat("appeared at ", place_text(event.after),
                    event.may_be == 0 ? std::string() : concat(", may be #", event.may_be));
  }
  return {};
}

}  // namespace ovimap
