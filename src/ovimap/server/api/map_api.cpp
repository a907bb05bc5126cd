// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/map_api.h"

#include <charconv>
#include <mutex>

#include <nlohmann/json.hpp>

#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"
#include "ovimap/io/exports/glb.h"
#include "ovimap/io/pictures/place_picture.h"
#include "ovimap/pipeline/search/object_labels.h"
#include "ovimap/server/api/approach_api.h"
#include "ovimap/server/api/correction_json.h"
#include "ovimap/server/api/event_stream.h"
#include "ovimap/server/api/history_api.h"
#include "ovimap/server/api/map_json.h"
#include "ovimap/server/api/watch_api.h"
#include "ovimap/server/http/request_body.h"
#include "ovimap/server/surface/surface_measure.h"

namespace ovimap {

namespace {

using nlohmann::json;

constexpr std::size_t kMostNotTexts = 8;  // each is encoded

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

HttpReply show_instance(const ServedMap& map, const HttpRequest& request) {
  return json_reply(instance_detail_json(map, instance_of(request)));
}

HttpReply show_crop(const ServedMap& map, const HttpRequest& request) {
  const auto now = map.snapshot();
  const InstanceId id = now->current_id(instance_of(request));
  const auto ordinal = whole_number<std::size_t>(request.segments[1], "a crop's number", 404);
  const Appearance look = appearance_of(*now->record, id);
  if (ordinal >= look.views.size() || look.views[ordinal]->crop.empty())
    return fault(404, concat("object ", id, " has no crop ", ordinal,
                             "; 'crops' of the object lists those it has"));
  const Bytes& jpeg = look.views[ordinal]->crop.image_jpeg;
  HttpReply reply = text_reply(200, "image/jpeg", std::string(jpeg.begin(), jpeg.end()));
  reply.headers["Cache-Control"] = "private, no-cache";
  return reply;
}

/// Empty where it is not given.
std::string time_field(const json& body, const char* name) {
  const auto text = field<std::string>(body, name);
  if (text && text->empty()) throw BadRequest(400, concat("'", name, "' is empty; give a time"));
  return text.value_or("");
}

HttpReply answer_query(const ServedMap& map, const HttpRequest& request) {
  const json body = body_of(request);
  check_keys(body, {"text", "not", "like", "heat", "at", "since"});
  MapQuestion question;
  const auto text = field<std::string>(body, "text");
  question.like = field<InstanceId>(body, "like");
  question.query.not_texts = texts_field(body, "not", kMostNotTexts);
  question.query.relevance = field<bool>(body, "heat").value_or(false);
  const std::string at = time_field(body, "at"), since = time_field(body, "since");
  const bool timed = !at.empty() || !since.empty();
  if (text && text->empty()) throw BadRequest(400, "'text' is empty; say what to look for");
  if (question.like ? text.has_value() : !text.has_value() && !timed)
    throw BadRequest(400, "give either 'text' or 'like'");
  if (question.like && (timed || !question.query.not_texts.empty()))
    throw BadRequest(400, "'not', 'at' and 'since' go with 'text' alone");
  question.query.text = text.value_or("");
  if (!question.like) question.past = map.past_of(question.query.text, at, since);
  if (!question.like) return json_reply(answer_json(map.ask(question)));
  const auto now = map.snapshot();
  question.like = now->index().object(position_of(*now, *question.like)).id;
  try {
    return json_reply(answer_json(map.ask(question)));
  } catch (const Error& error) {  // the object is there, but nobody knows what it looks like
    return fault(409, error.what());
  }
}

HttpReply show_place(const ServedMap& map, const HttpRequest& request) {
  constexpr int kQuality = 85;
  constexpr float kAround_m = 5.f;  // a room is seen whole, a building is not
  const auto now = map.snapshot();
  const SearchObject& object = now->index().object(position_of(*now, instance_of(request)));
  Bytes jpeg;
  try {
    Eigen::AlignedBox3f around = object.box;
    around.extend(around.min() - Eigen::Vector3f::Constant(kAround_m));
    around.extend(around.max() + Eigen::Vector3f::Constant(kAround_m));
    Mesh surface = labelled_surface(*map.surface(), now->instance_of_label, now->hidden(), around);
    jpeg = encode_jpeg(place_picture(std::move(surface), object.id, now->record->up), kQuality);
  } catch (const Error& error) {  // the object is there, but nothing of it was meshed
    return fault(409, error.what());
  }
  HttpReply reply = text_reply(200, "image/jpeg", std::string(jpeg.begin(), jpeg.end()));
  reply.headers["Cache-Control"] = "private, no-cache";
  return reply;
}

int level_of(const std::string& text, int status) {
  const int level = whole_number<int>(text, "'level'", status);
  if (level < 0 || level >= ServedSurface::kLevels)
    throw BadRequest(status, "'level' is 0 (all triangles), 1 (few) or 2 (very few)");
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
  HttpReply reply;
  reply.type = "application/octet-stream";
  reply.body =
      map.surface()->encoded(level, index, query_number<std::uint64_t>(request, "since", 0));
  if (!reply.body) return fault(404, "the map has no such chunk; GET /api/mesh lists those it has");
  return reply;
}

HttpReply correct(ServedMap& map, const HttpRequest& request) {
  const MapEdit edit = edit_of(body_of(request));
  for (const InstanceId id : edit.instances)
    if (const auto now = map.snapshot(); !now->knows(now->current_id(id)))
      return fault(404, concat("the map has no object ", id));
  try {
    const MapEdit kept = map.correct(edit);
    return json_reply({{"version", map.snapshot()->version}, {"edit", kept.id}});
  } catch (const Error& error) {  // the request is sound, but makes no sense in this map
    return fault(409, error.what());
  }
}

/// The last export, so that the same map is written once however often it is asked for.
struct KeptGlb {
  std::mutex mutex;
  std::uint64_t version = 0, mesh_version = 0;
  std::shared_ptr<const std::string> file;  ///< null: none yet
};

HttpReply export_glb(const ServedMap& map, KeptGlb& kept) {
  const std::lock_guard lock(kept.mutex);
  const auto surface = map.surface();
  const auto now = map.snapshot();
  if (!kept.file || kept.version != now->version || kept.mesh_version != surface->version()) {
    kept.file.reset();  // two never exist at once
    const auto hidden = now->hidden();
    const MapRecord& record = *now->record;
    const ObjectTitles titles{record.names, labels_of(now->index(), now->names)};
    kept.file = std::make_shared<std::string>(
        encode_glb(labelled_parts(*surface, now->instance_of_label, hidden),
                   {record.instances, record.parts, titles, record.up}));
    kept.version = now->version;
    kept.mesh_version = surface->version();
  }
  HttpReply reply;
  reply.type = "model/gltf-binary";
  reply.body = kept.file;
  return reply;
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
    } catch (const MomentUnknown& unknown) {  // the request is sound, but of another map
      return fault(409, unknown.what());
    } catch (const Error& error) {
      return fault(400, error.what());
    }
  };
}

}  // namespace

Router map_api(ServedMap& map, FrameApi& frames, StandingQueries& standing) {
  Router router;
  const auto add = [&](const char* method, const char* pattern, BodyType body, RouteCost cost,
                       HttpHandler handler) {
    router.add({method, pattern, body, cost, guarded(std::move(handler))});
  };
  const auto get = [&](const char* pattern, HttpHandler handler) {
    add("GET", pattern, BodyType::kNone, RouteCost::kLittle, std::move(handler));
  };
  const auto get_large = [&](const char* pattern, HttpHandler handler) {
    add("GET", pattern, BodyType::kNone, RouteCost::kLarge, std::move(handler));
  };
  const auto work = [&](const char* pattern, HttpHandler handler) {
    add("POST", pattern, BodyType::kJson, RouteCost::kWork, std::move(handler));
  };
  using Request = const HttpRequest&;
  get("/api/openapi.json",
      [](Request) { return text_reply(200, "application/json", openapi_json()); });
  get("/api/map", [&map](Request) { return json_reply(map_json(map)); });
  get("/api/instances", [&map](Request) { return json_reply(instances_json(map)); });
  get("/api/instances/{id}", [&map](Request r) { return show_instance(map, r); });
  get_large("/api/instances/{id}/crops/{ordinal}", [&map](Request r) { return show_crop(map, r); });
  add("GET", "/api/instances/{id}/place", BodyType::kNone, RouteCost::kWork,
      [&map](Request r) { return show_place(map, r); });
  add("GET", "/api/relations", BodyType::kNone, RouteCost::kWork,
      [&map](Request) { return json_reply(relations_json(map)); });
  add("GET", "/api/rooms", BodyType::kNone, RouteCost::kWork,
      [&map](Request) { return show_rooms(map); });
  add("GET", "/api/history", BodyType::kNone, RouteCost::kWork,
      [&map](Request) { return show_history(map); });
  add("GET", "/api/changes", BodyType::kNone, RouteCost::kWork,
      [&map](Request r) { return show_changes(map, r); });
  get_large("/api/history/{event}/surface",
            [&map](Request r) { return show_past_surface(map, r); });
  get_large("/api/history/{event}/crop", [&map](Request r) { return show_past_crop(map, r); });
  add("GET", "/api/gaps", BodyType::kNone, RouteCost::kWork,
      [&map](Request) { return show_gaps(map); });
  get("/api/mesh", [&map](Request r) { return list_chunks(map, r); });
  get_large("/api/mesh/{level}/{x}/{y}/{z}", [&map](Request r) { return show_chunk(map, r); });
  get("/api/cameras", [&map](Request) { return json_reply(cameras_json(map)); });
  get("/api/events", [&map](Request r) {
    return event_stream(map.events(), r, query_number(r, "after", map.events().last()));
  });
  add("GET", "/api/watch", BodyType::kNone, RouteCost::kWork,
      [&map, &standing](Request r) { return watch_of_address(map, standing, r); });
  work("/api/watch", [&map, &standing](Request r) { return watch_of_body(map, standing, r); });
  get("/api/labels", [&map](Request) { return json_reply(labels_json(map)); });
  get("/api/corrections", [&map](Request) { return json_reply(corrections_json(map)); });
  add("GET", "/api/export.glb", BodyType::kNone, RouteCost::kWork,
      [&map, kept = std::make_shared<KeptGlb>()](Request) { return export_glb(map, *kept); });
  work("/api/query", [&map](Request r) { return answer_query(map, r); });
  work("/api/approach", [&map](Request r) { return answer_approach(map, r); });
  work("/api/corrections", [&map](Request r) { return correct(map, r); });
  work("/api/camera", [&frames](Request r) { return frames.camera(r); });
  add("POST", "/api/frames", BodyType::kFrame, RouteCost::kFrame,
      [&frames](Request r) { return frames.frame(r); });
  work("/api/poses", [&frames](Request r) { return frames.poses(r); });
  add("POST", "/api/finish", BodyType::kNone, RouteCost::kWork,
      [&frames](Request) { return frames.finish(); });
  return router;
}

}  // namespace ovimap
