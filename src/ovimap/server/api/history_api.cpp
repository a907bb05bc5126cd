// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/history_api.h"

#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "ovimap/io/map_tables/map_file_history.h"
#include "ovimap/server/http/request_body.h"

namespace ovimap {

namespace {

using nlohmann::json;

json known(const std::optional<double>& date) {
  return date ? json(*date) : json();
}

/// To a tenth of a millimetre.
json number(double value) {
  constexpr double kSteps = 1e4;
  return std::isfinite(value) ? json(std::round(value * kSteps) / kSteps) : json();
}

json point(const Eigen::Vector3f& p) {
  return {number(p.x()), number(p.y()), number(p.z())};
}

json box_or_null(const Eigen::AlignedBox3f& box) {
  if (box.isEmpty()) return nullptr;
  return {{"min", point(box.min())}, {"max", point(box.max())}};
}

/// What each object, also such as are gone, clearly is; empty where search is not ready.
std::map<InstanceId, std::string> words_of_objects(const ServedMap& map, const MapSnapshot& now) {
  std::map<InstanceId, std::string> words;
  if (!now.engine || now.record->history.events.empty()) return words;
  const auto past = map.with_gone_objects(now);
  for (std::size_t i = 0; i < past.names.size(); ++i)
    words[past.history->search.index.object(i).id] = past.names[i].word;
  return words;
}

json visits_json(const MapRecord& record, const HistoryDates& dates) {
  std::vector<MapVisit> visits = record.history.visits;
  if (visits.empty()) visits.push_back({record.source, 0, 0});
  json list = json::array();
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const std::int64_t end = i + 1 < visits.size() ? visits[i + 1].first_frame
                                                   : static_cast<std::int64_t>(record.frames.size());
    const int visit = static_cast<int>(i) + 1;
    list.push_back({{"visit", visit},
                    {"source", visits[i].source},
                    {"frames", end - visits[i].first_frame},
                    {"begin_s", known(dates.begin_of(visit))},
                    {"end_s", known(dates.end_of(visit))}});
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
  return fault(404, "the map keeps nothing of that event; GET /api/history lists those of which it does");
}

/// The largest picture among an object's looks of that time; null: none.
const StoredCrop* crop_of(const MapRecord& record, const PastObject& was) {
  const ObjectView* largest = nullptr;
  for (const ObjectView* view : appearance_of(record.semantics.looks, was.super_points).views)
    if (!view->crop.empty() && (!largest || view->visible_px > largest->visible_px)) largest = view;
  return largest ? &largest->crop : nullptr;
}

}  // namespace

HttpReply show_history(const ServedMap& map) {
  const auto now = map.snapshot();
  const MapRecord& record = *now->record;
  const HistoryDates dates(record.history, record.frames);
  const auto words = words_of_objects(map, *now);
  json events = json::array();
  for (std::size_t i = 0; i < record.history.events.size(); ++i) {
    const ObjectEvent& event = record.history.events[i];
    const auto word = words.find(event.instance);
    events.push_back({{"id", i + 1},
                      {"instance", event.instance},
                      {"name", now->name_of(event.instance)},
                      {"label", word == words.end() ? "" : word->second},
                      {"event", event_name(event.kind)},
                      {"visit", event.visit},
                      {"time_s", known(dates.date_of(i))},
                      {"before", box_or_null(event.before)},
                      {"after", box_or_null(event.after)},
                      {"may_be", event.may_be == 0 ? json() : json(event.may_be)},
                      {"surface", event.was != nullptr},
                      {"crop", event.was && crop_of(record, *event.was) != nullptr}});
  }
  const json history = {
      {"version", now->version}, {"visits", visits_json(record, dates)}, {"events", events}};
  return text_reply(200, "application/json",
                    history.dump(-1, ' ', false, json::error_handler_t::replace));
}

HttpReply show_past_surface(const ServedMap& map, const HttpRequest& request) {
  const auto now = map.snapshot();
  const ObjectEvent* event = event_of(*now, request);
  if (!event || !event->was) return nothing_kept();
  json points = json::array(), colors = json::array();
  for (const Eigen::Vector3f& p : event->was->surface)
    for (const float value : p) points.push_back(number(double{value}));
  for (const auto& color : event->was->colors)
    for (const std::uint8_t channel : color) colors.push_back(channel);
  return text_reply(200, "application/json",
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
