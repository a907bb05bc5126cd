// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/watch_api.h"

#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "ovimap/semantics/past/time_words.h"
#include "ovimap/semantics/query/query_text.h"
#include "ovimap/server/http/access.h"
#include "ovimap/server/http/request_body.h"

namespace ovimap {

namespace {

using nlohmann::json;

constexpr std::size_t kMostQueries = 1000;
constexpr double kHold_s = 3;  // a map that is being made has a new state every second or so
constexpr double kLongestHold_s = 3600;

/// To a thousandth: more digits are noise.
json rounded(double value) {
  return std::isfinite(value) ? json(std::round(value * 1e3) / 1e3) : json();
}

json rounded(const Eigen::Vector3f& p) {
  return {rounded(p.x()), rounded(p.y()), rounded(p.z())};
}

json object_json(const StandingObject& object) {
  const bool placed = !object.box.isEmpty();
  return {{"id", object.id},
          {"title", object.title},
          {"named", object.named},
          {"center", placed ? rounded(object.box.center()) : json()},
          {"size", placed ? rounded(object.box.sizes()) : json()}};
}

const char* kind_name(StandingEvent::Kind kind) {
  constexpr std::array kNames = {"found", "gone", "fault"};
  return kNames[static_cast<std::size_t>(kind)];
}

json event_json(const StandingEvent& event, const std::string& map) {
  json said = {{"event", kind_name(event.kind)},
               {"map", map},
               {"query", event.query},
               {"time_s", rounded(seconds_now())}};
  if (event.object) said["object"] = object_json(*event.object);
  if (event.kind == StandingEvent::Kind::kFound && event.object->probability)
    said["probability"] = rounded(*event.object->probability);
  if (!event.fault.empty()) said["fault"] = event.fault;
  return said;
}

class WatchStream : public ReplyStream {
 public:
  WatchStream(std::shared_ptr<StandingWatch> watch, const ServedMap& map)
      : watch_(std::move(watch)), map_(map) {}
  ~WatchStream() override { watch_->call({}); }

  std::string next() override {
    if (!greeted_) {
      greeted_ = true;
      return concat("retry: 2000\nid: ", watch_->mark(),
                    "\nevent: hello\ndata: {\"queries\":", watch_->queries().size(), "}\n\n");
    }
    const auto event = watch_->next();
    if (!event) return {};
    const json data = event_json(*event, map_.path().stem().string());
    return concat("id: ", watch_->mark(), "\nevent: ", kind_name(event->kind),
                  "\ndata: ", data.dump(-1, ' ', false, json::error_handler_t::replace), "\n\n");
  }
  std::string sign_of_life() const override { return ": quiet\n\n"; }
  bool ended() const override { return map_.events().closed(); }
  void watch(std::function<void()> wake) override { watch_->call(std::move(wake)); }

 private:
  const std::shared_ptr<StandingWatch> watch_;
  const ServedMap& map_;
  bool greeted_ = false;
};

double checked_hold(double hold_s) {
  if (hold_s >= 0 && hold_s <= kLongestHold_s) return hold_s;
  throw BadRequest(400, concat("'hold_s' is a number of seconds from 0 to ", kLongestHold_s));
}

double hold_of(const std::string& text) {
  double hold_s = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hold_s);
  return checked_hold(error == std::errc() && end == text.data() + text.size() ? hold_s : -1);
}

HttpReply watch_stream(const ServedMap& map, StandingQueries& standing, const HttpRequest& request,
                       std::vector<std::string> queries, double hold_s) {
  if (queries.size() > kMostQueries)
    throw BadRequest(400, concat(queries.size(), " queries are more than the ", kMostQueries,
                                 " that one request may have"));
  for (const std::string& query : queries) checked_query_text(query, map.max_query_chars());
  const auto hold = std::chrono::duration_cast<StandingWatch::Clock::duration>(
      std::chrono::duration<double>(hold_s));
  auto watch = standing.watch(std::move(queries), hold, request.header("last-event-id"),
                              client_of(request.remote_address));
  if (!watch)
    return fault(503, "too many standing queries are asked already; end some, or ask for fewer");
  HttpReply reply;
  reply.type = "text/event-stream";
  reply.headers["Cache-Control"] = "no-store";
  reply.stream = std::make_shared<WatchStream>(std::move(watch), map);
  return reply;
}

}  // namespace

HttpReply watch_of_address(const ServedMap& map, StandingQueries& standing,
                           const HttpRequest& request) {
  std::vector<std::string> queries;
  double hold_s = kHold_s;
  for (const auto& [name, value] : request.parameters) {
    if (name == "query")
      queries.push_back(value);
    else if (name == "hold_s")
      hold_s = hold_of(value);
    else
      throw BadRequest(
          400,
          concat("'", name, "' is no parameter of this request; it takes 'query' and 'hold_s'"));
  }
  if (queries.empty())
    throw BadRequest(400, "say what to watch for: ?query=mug&query=fire+extinguisher");
  return watch_stream(map, standing, request, std::move(queries), hold_s);
}

HttpReply watch_of_body(const ServedMap& map, StandingQueries& standing,
                        const HttpRequest& request) {
  const json body = body_of(request);
  check_keys(body, {"queries", "hold_s"});
  std::vector<std::string> queries = texts_field(body, "queries", kMostQueries);
  if (queries.empty()) throw BadRequest(400, "'queries' is missing: a list of what to watch for");
  double hold_s = kHold_s;
  if (body.contains("hold_s"))
    hold_s = checked_hold(body["hold_s"].is_number() ? body["hold_s"].get<double>() : -1);
  return watch_stream(map, standing, request, std::move(queries), hold_s);
}

}  // namespace ovimap
