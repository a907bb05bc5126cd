// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/map_api.h"

#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "ovimap/base/error.h"
#include "ovimap/server/chunk_encoding.h"
#include "ovimap/server/event_stream.h"
#include "ovimap/server/map_json.h"

namespace ovimap {

namespace {

using nlohmann::json;

/// The request itself is wrong; its text becomes a reply of that status.
struct BadRequest : std::runtime_error {
  BadRequest(int code, const std::string& sentence) : std::runtime_error(sentence), status(code) {}
  int status;
};

HttpReply json_reply(const json& value, int status = 200) {
  return text_reply(status, "application/json",
                    value.dump(-1, ' ', false, json::error_handler_t::replace));
}

template <class Number>
Number whole_number(const std::string& text, const std::string& what, int status) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size())
    throw BadRequest(status, concat(what, " must be a whole number, not '", text, "'"));
  return value;
}

template <class Number>
Number query_number(const HttpRequest& request, const std::string& name, Number otherwise) {
  const auto given = request.query.find(name);
  if (given == request.query.end()) return otherwise;
  return whole_number<Number>(given->second, "'" + name + "'", 400);
}

InstanceId instance_of(const HttpRequest& request) {
  return whole_number<InstanceId>(request.segments[0], "an object's id", 404);
}

json body_of(const HttpRequest& request) {
  if (!request.header("content-type").starts_with("application/json"))
    throw BadRequest(415, "send the body as Content-Type: application/json");
  json body = json::parse(request.body, nullptr, false);
  if (body.is_discarded()) throw BadRequest(400, "the body is no JSON; see /api/openapi.json");
  if (!body.is_object()) throw BadRequest(400, "the body must be a JSON object");
  return body;
}

void check_keys(const json& body, std::initializer_list<const char*> known) {
  for (const auto& [key, value] : body.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw BadRequest(400, concat("'", key,
                                   "' is no field of this request; see "
                                   "/api/openapi.json"));
  }
}

/// Whether JSON counts it as a whole number in [0, most]: 12.0 is one as well.
bool is_whole(const json& value, double most) {
  if (!value.is_number()) return false;
  const double number = value.get<double>();
  return number >= 0 && number <= most && number == std::floor(number);
}

/// Field `name` of a body. Throws BadRequest when its type is another.
template <class Value>
std::optional<Value> field(const json& body, const char* name) {
  if (!body.contains(name)) return std::nullopt;
  const json& value = body[name];
  bool fits = value.is_string();
  if constexpr (std::is_same_v<Value, bool>)
    fits = value.is_boolean();
  else if constexpr (std::is_integral_v<Value>)
    fits = is_whole(value, static_cast<double>(std::numeric_limits<Value>::max()));
  if (!fits)
    throw BadRequest(400, concat("'", name, "' is of the wrong type; see /api/openapi.json"));
  return value.get<Value>();
}

std::vector<std::string> texts_field(const json& body, const char* name) {
  if (!body.contains(name)) return {};
  const json& list = body[name];
  if (!list.is_array() ||
      !std::all_of(list.begin(), list.end(), [](const json& item) { return item.is_string(); }))
    throw BadRequest(400, concat("'", name, "' must be a list of texts"));
  if (list.size() > 100) throw BadRequest(400, concat("'", name, "' has more than 100 entries"));
  return list.get<std::vector<std::string>>();
}

HttpReply show_instance(const ServedMap& map, const HttpRequest& request) {
  const InstanceId id = instance_of(request);
  if (!map.snapshot()->index().find(id))
    return fault(404, concat("the map has no object ", id, "; GET /api/instances lists them"));
  return json_reply(instance_detail_json(map, id));
}

HttpReply show_crop(const ServedMap& map, const HttpRequest& request) {
  const InstanceId id = instance_of(request);
  const auto ordinal = whole_number<std::size_t>(request.segments[1], "a crop's number", 404);
  const auto now = map.snapshot();
  const auto& looks = now->record->semantics.appearances;
  const auto look = looks.find(id);
  if (look == looks.end() || ordinal >= look->second.views.size() ||
      look->second.views[ordinal].crop.empty())
    return fault(404, concat("object ", id, " has no crop ", ordinal,
                             "; 'crops' of the object lists those it has"));
  const Bytes& jpeg = look->second.views[ordinal].crop.image_jpeg;
  HttpReply reply = text_reply(200, "image/jpeg", std::string(jpeg.begin(), jpeg.end()));
  reply.headers["Cache-Control"] = "private, max-age=3600";
  return reply;
}

HttpReply answer_query(const ServedMap& map, const HttpRequest& request) {
  const json body = body_of(request);
  check_keys(body, {"text", "not", "like", "heat"});
  MapQuestion question;
  const auto text = field<std::string>(body, "text");
  question.like = field<InstanceId>(body, "like");
  question.query.not_texts = texts_field(body, "not");
  question.query.relevance = field<bool>(body, "heat").value_or(false);
  if (text.has_value() == question.like.has_value())
    throw BadRequest(400, "give either 'text' or 'like'");
  if (question.like && !question.query.not_texts.empty())
    throw BadRequest(400, "'not' goes with 'text' alone");
  question.query.text = text.value_or("");
  if (!question.like) return json_reply(answer_json(map.ask(question)));
  if (!map.snapshot()->index().find(*question.like))
    return fault(404, concat("the map has no object ", *question.like));
  try {
    return json_reply(answer_json(map.ask(question)));
  } catch (const Error& error) {  // the object is there, but nobody knows what it looks like
    return fault(409, error.what());
  }
}

int level_of(const std::string& text, int status) {
  const int level = whole_number<int>(text, "'level'", status);
  if (level < 0 || level >= MeshStore::kLevels)
    throw BadRequest(status, "'level' is 0 (all triangles) or 1 (few)");
  return level;
}

HttpReply list_chunks(const ServedMap& map, const HttpRequest& request) {
  const auto level = request.query.find("level");
  return json_reply(mesh_json(map, level == request.query.end() ? 0 : level_of(level->second, 400),
                              query_number<std::uint64_t>(request, "since", 0)));
}

HttpReply show_chunk(const ServedMap& map, const HttpRequest& request) {
  const int level = level_of(request.segments[0], 404);
  Eigen::Vector3i index;
  for (int i = 0; i < 3; ++i)
    index[i] = whole_number<int>(request.segments[static_cast<std::size_t>(i) + 1],
                                 "a chunk's coordinate", 404);
  const auto chunk = map.mesh().find(level, index);
  if (!chunk) return fault(404, "the map has no such chunk; GET /api/mesh lists those it has");
  return text_reply(200, "application/octet-stream",
                    encode_chunk(*chunk, map.mesh().grid(), level,
                                 query_number<std::uint64_t>(request, "since", 0)));
}

/// The correction that a body asks for; each kind has fields of its own.
Correction correction_of(const json& body) {
  const auto known = correction_kind(field<std::string>(body, "kind").value_or(""));
  const auto instance = field<InstanceId>(body, "instance");
  if (!known) throw BadRequest(400, "'kind' is one of rename, merge, hide, lock, delete");
  if (!instance) throw BadRequest(400, "'instance' is missing: the id of an object");
  const CorrectionKind kind = *known;
  Correction correction{kind, *instance, {}, 0, true};
  switch (kind) {
    case CorrectionKind::kRename:
      check_keys(body, {"kind", "instance", "name"});
      if (!body.contains("name"))
        throw BadRequest(400, "'name' is missing; an empty one takes the name away");
      correction.name = *field<std::string>(body, "name");
      check_name(correction.name);
      break;
    case CorrectionKind::kMerge:
      check_keys(body, {"kind", "instance", "into"});
      correction.into = field<InstanceId>(body, "into").value_or(0);
      if (correction.into == 0)
        throw BadRequest(400, "'into' is missing: the id of the object that stays");
      break;
    case CorrectionKind::kHide:
    case CorrectionKind::kLock:
      check_keys(body, {"kind", "instance", "on"});
      correction.on = field<bool>(body, "on").value_or(true);
      break;
    case CorrectionKind::kDelete:
      check_keys(body, {"kind", "instance"});
      break;
  }
  return correction;
}

HttpReply correct(ServedMap& map, const HttpRequest& request) {
  const Correction correction = correction_of(body_of(request));
  const auto kinds = map.correctable();
  if (std::find(kinds.begin(), kinds.end(), correction.kind) == kinds.end())
    return fault(409, concat("this map cannot keep a '", correction_name(correction.kind),
                             "' yet; GET /api/map lists under 'corrections' what it keeps"));
  if (!map.snapshot()->index().find(correction.instance))
    return fault(404, concat("the map has no object ", correction.instance));
  try {
    map.correct(correction);
  } catch (const Error& error) {  // the request is sound; the file is not as it should be
    return fault(409, error.what());
  }
  return json_reply({{"version", map.snapshot()->version}});
}

HttpReply no_glb() {
  return fault(501, "this version cannot write GLB; use `ovimap export MAP OUT.ply`");
}

/// Turns what a handler throws into replies.
HttpHandler guarded(HttpHandler handler) {
  return [handler = std::move(handler)](const HttpRequest& request) {
    try {
      return handler(request);
    } catch (const SearchUnavailable& why) {
      return fault(409, concat("this map cannot be searched: ", why.what()));
    } catch (const BadRequest& bad) {
      return fault(bad.status, bad.what());
    } catch (const Error& error) {
      return fault(400, error.what());
    }
  };
}

}  // namespace

Router map_api(ServedMap& map) {
  Router router;
  const auto get = [&](const char* pattern, HttpHandler handler) {
    router.add("GET", pattern, guarded(std::move(handler)));
  };
  const auto post = [&](const char* pattern, HttpHandler handler) {
    router.add("POST", pattern, guarded(std::move(handler)));
  };
  using Request = const HttpRequest&;
  get("/api/openapi.json",
      [](Request) { return text_reply(200, "application/json", openapi_json()); });
  get("/api/map", [&map](Request) { return json_reply(map_json(map)); });
  get("/api/instances", [&map](Request) { return json_reply(instances_json(map)); });
  get("/api/instances/{id}", [&map](Request r) { return show_instance(map, r); });
  get("/api/instances/{id}/crops/{ordinal}", [&map](Request r) { return show_crop(map, r); });
  get("/api/mesh", [&map](Request r) { return list_chunks(map, r); });
  get("/api/mesh/{level}/{x}/{y}/{z}", [&map](Request r) { return show_chunk(map, r); });
  get("/api/cameras", [&map](Request) { return json_reply(cameras_json(map)); });
  get("/api/events", [&map](Request r) { return event_stream(map.events(), r); });
  get("/api/export.glb", [](Request) { return no_glb(); });
  post("/api/query", [&map](Request r) { return answer_query(map, r); });
  post("/api/corrections", [&map](Request r) { return correct(map, r); });
  return router;
}

}  // namespace ovimap
