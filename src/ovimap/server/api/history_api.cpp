// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/history_api.h"

#include <charconv>

#include <nlohmann/json.hpp>

#include "ovimap/io/exports/json_values.h"
#include "ovimap/io/map_tables/map_file_history.h"
#include "ovimap/server/http/request_body.h"

namespace ovimap {

namespace {

using nlohmann::json;

json box_or_null(const Eigen::AlignedBox3f& box) {
  if (box.isEmpty()) return nullptr;
  return {{"min", rounded_point(box.min())}, {"max", rounded_point(box.max())}};
}

json visits_json(const MapRecord& record, const HistoryDates& dates) {
  std::vector<MapVisit> visits = record.history.visits;
  if (visits.empty()) visits.push_back({record.source, 0, 0});
  json list = json::array();
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const std::int64_t end = i + 1 < visits.size()
                                 ? visits[i + 1].first_frame
                                 : static_cast<std::int64_t>(record.frames.size());
    const int visit = static_cast<int>(i) + 1;
    list.push_back({{"visit", visit},
                    {"source", visits[i].source},
                    {"frames", end - visits[i].first_frame},
                    {"begin_s", json_or_null(dates.begin_of(visit))},
                    {"end_s", json_or_null(dates.end_of(visit))}});
  }
  return list;
}

/// The event that a request names, by its number from 1; null: there is none.
const ObjectEvent* event_of(const MapSnapshot& now, const HttpRequest& request) {
  const std::string& text = request.segments[0];
  std::size_t id = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (text.empty() || fault != std::errc() || end != text.data() + text.size())
    throw BadRequest(404, concat("an event's id must be a whole number, not '", text, "'"));
  const auto& events = now.record->history.events;
  return id >= 1 && id <= events.size() ? &events[id - 1] : nullptr;
}

HttpReply nothing_kept() {
  return fault(
      404, "the map keeps nothing of that event; GET /api/history lists those of which it does");
}

/// The largest picture among an object's looks of that time; null: none.
const StoredCrop* crop_of(const MapRecord& record, const PastObject& was) {
  const ObjectView* largest = nullptr;
  for (const ObjectView* view : appearance_of(record.semantics.looks, was.super_points).views)
    if (!view->crop.empty() && (!largest || view->visible_px > largest->visible_px)) largest = view;
  return largest ? &largest->crop : nullptr;
}

/// What became of objects, in words and boxes; events and what changed between times alike.
class ChangesInJson {
 public:
  ChangesInJson(const ServedMap& map, const MapSnapshot& now)
      : now_(now), dates_(now.record->history, now.record->frames) {
    if (!now.record->history.events.empty()) words_ = map.words_with_gone(now);
  }

  const HistoryDates& dates() const { return dates_; }

  json of(const HistoryChange& change) const {
    const auto& events = now_.record->history.events;
    const ObjectEvent &first = events[change.first], &last = events[change.last];
    const auto word = words_.find(change.instance);
    return {{"instance", change.instance},
            {"name", now_.name_of(change.instance)},
            {"label", word == words_.end() ? "" : word->second},
            {"event", event_name(change.kind)},
            {"visit", last.visit},
            {"time_s", json_or_null(dates_.date_of(change.last))},
            {"before", box_or_null(first.before)},
            {"after", box_or_null(last.after)},
            {"may_be", first.may_be == 0 ? json() : json(first.may_be)}};
  }

 private:
  const MapSnapshot& now_;
  HistoryDates dates_;
  WordsOfObjects words_;
};

HttpReply in_json(const json& value) {
  return text_reply(200, "application/json",
                    value.dump(-1, ' ', false, json::error_handler_t::replace));
}

/// Of an address, as people name times; empty: not said.
std::string time_of(const HttpRequest& request, const char* name) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) return {};
  if (found->second.empty()) throw BadRequest(400, concat("'", name, "' is empty; leave it out"));
  return found->second;
}

}  // namespace

HttpReply show_history(const ServedMap& map) {
  const auto now = map.snapshot();
  const MapRecord& record = *now->record;
  const ChangesInJson told(map, *now);
  json events = json::array();
  for (std::size_t i = 0; i < record.history.events.size(); ++i) {
    const ObjectEvent& event = record.history.events[i];
    json entry = told.of({event.instance, event.kind, i, i});
    entry["id"] = i + 1;
    entry["surface"] = event.was != nullptr;
    entry["crop"] = event.was && crop_of(record, *event.was) != nullptr;
    events.push_back(std::move(entry));
  }
  return in_json({{"version", now->version},
                  {"visits", visits_json(record, told.dates())},
                  {"events", std::move(events)}});
}

HttpReply show_changes(const ServedMap& map, const HttpRequest& request) {
  const auto now = map.prepared_snapshot();
  const MapHistory& history = now->record->history;
  const ChangesInJson told(map, *now);
  const HistoryDates& dates = told.dates();
  const MapChanges between = changes_between(history, dates, time_of(request, "since"),
                                             time_of(request, "until"), seconds_now());
  json changes = json::array();
  for (const HistoryChange& change : between.changes) {
    json entry = told.of(change);
    entry["text"] = change_text(change, history, dates);
    changes.push_back(std::move(entry));
  }
  return in_json({{"version", now->version},
                  {"since", dates.text_of(between.since)},
                  {"until", dates.text_of(between.until)},
                  {"visits", visits_json(*now->record, dates)},
                  {"changes", std::move(changes)}});
}

HttpReply show_past_surface(const ServedMap& map, const HttpRequest& request) {
  const auto now = map.snapshot();
  const ObjectEvent* event = event_of(*now, request);
  if (!event || !event->was) return nothing_kept();
  json points = json::array(), colors = json::array();
  for (const Eigen::Vector3f& p : event->was->surface)
    for (const float value : p) points.push_back(rounded_json(double{value}));
  for (const auto& color : event->was->colors)
    for (const std::uint8_t channel : color) colors.push_back(channel);
  return text_reply(
      200, "application/json",
      json{{"instance", event->instance}, {"points", points}, {"colors", colors}}.dump());
}

HttpReply show_past_crop(const ServedMap& map, const HttpRequest& request) {
  const auto now = map.snapshot();
  const ObjectEvent* event = event_of(*now, request);
  const StoredCrop* crop = event && event->was ? crop_of(*now->record, *event->was) : nullptr;
  if (!crop) return nothing_kept();
  HttpReply reply =
      text_reply(200, "image/jpeg", std::string(crop->image_jpeg.begin(), crop->image_jpeg.end()));
  reply.headers["Cache-Control"] = "private, no-cache";
  return reply;
}

}  // namespace ovimap
