// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/exports/instance_json.h"

#include <charconv>
#include <cmath>

#include "ovimap/io/exports/instance_json_value.h"
#include "ovimap/io/exports/json_values.h"
#include "ovimap/io/map_tables/map_file_history.h"
#include "ovimap/io/map_tables/map_file_record.h"
#include "ovimap/semantics/query/query_grammar.h"

namespace ovimap {

namespace {
using Json = nlohmann::ordered_json;
}

Json json_number(float value) {
  if (!std::isfinite(value)) return nullptr;
  char text[48];
  const char* end = std::to_chars(text, text + sizeof(text), value).ptr;
  double shortest = 0;
  std::from_chars(text, end, shortest);
  return shortest;
}

Json json_vector(const Eigen::Vector3f& v) {
  return Json::array({json_number(v.x()), json_number(v.y()), json_number(v.z())});
}

Json instance_json_value(const InstanceSummary& instance, const ObjectTitles& titles) {
  Json entry;
  entry["id"] = instance.id;
  entry["name"] = titles.name_of(instance.id);
  entry["label"] = titles.label_of(instance.id);
  entry["box"]["min"] = json_vector(instance.box.min());
  entry["box"]["max"] = json_vector(instance.box.max());
  entry["centroid"] = json_vector(instance.centroid);
  entry["points"] = instance.points;
  entry["views"] = instance.views;
  if (instance.confidence) entry["confidence"] = json_number(*instance.confidence);
  entry["superpoints"] = instance.super_points;
  return entry;
}

Json parts_json_value(std::span<const ObjectPart* const> parts) {
  Json list = Json::array();
  for (const ObjectPart* part : parts) {
    Json entry = instance_json_value(*part, {});
    entry.erase("id");
    entry["name"] = concat("part ", list.size() + 1);
    list.push_back(std::move(entry));
  }
  return list;
}

Json relation_json_value(const ObjectRelation& relation) {
  return {{"object", relation.object},
          {"relation", relation_name(relation.relation)},
          {"anchor", relation.anchor},
          {"score", json_number(relation.score)},
          {"evidence", relation.evidence}};
}

namespace {

Json instance_list(const MapInfo& info, const ObjectTitles& titles) {
  const auto parts = parts_by_object(info.parts, info.instances);
  Json list = Json::array();
  for (const InstanceSummary& instance : info.instances) {
    list.push_back(instance_json_value(instance, titles));
    if (const auto of_it = parts.find(instance.id); of_it != parts.end())
      list.back()["parts"] = parts_json_value(of_it->second);
  }
  return list;
}

Json relation_list(std::span<const ObjectRelation> relations) {
  Json list = Json::array();
  for (const ObjectRelation& relation : relations) list.push_back(relation_json_value(relation));
  return list;
}

Json writing_value(const MapInfo& info) {
  Json objects = Json::object();
  for (const auto& [id, lines] : info.writing)
    for (const WrittenLine& line : lines)
      objects[std::to_string(id)].push_back(
          {{"text", line.text}, {"confidence", json_number(line.confidence)}});
  return {{"reader", info.writing_reader}, {"objects", objects}};
}

Json box_or_null(const Eigen::AlignedBox3f& box) {
  if (box.isEmpty()) return nullptr;
  return {{"min", json_vector(box.min())}, {"max", json_vector(box.max())}};
}

Json history_value(const MapHistory& history) {
  Json visits = Json::array(), events = Json::array();
  for (const MapVisit& visit : history.visits)
    visits.push_back({{"source", visit.source},
                      {"first_frame", visit.first_frame},
                      {"first_index", visit.first_index},
                      {"recorded_s", json_or_null<Json>(visit.recorded_s)}});
  for (const ObjectEvent& event : history.events)
    events.push_back({{"object", event.instance},
                      {"event", event_name(event.kind)},
                      {"visit", event.visit},
                      {"frame", event.frame},
                      {"before", box_or_null(event.before)},
                      {"after", box_or_null(event.after)},
                      {"may_be", event.may_be == 0 ? Json(nullptr) : Json(event.may_be)}});
  return {{"visits", visits}, {"events", events}};
}

Json info_value(const std::filesystem::path& path, const MapInfo& info,
                const ObjectLabels& labels) {
  Json document;
  document["map"] = path.string();
  document["schema"] = info.schema;
  document["frames"] = info.frames;
  document["mask_frames"] = info.mask_frames;
  document["instances"] = instance_list(info, {info.names, labels});
  document["hidden"] = Json::array();
  for (const InstanceSummary& instance : info.hidden) document["hidden"].push_back(instance.id);
  if (!info.writing_reader.empty()) document["writing"] = writing_value(info);
  document["locked"] = info.locked;
  document["history"] = history_value(info.history);
  document["voxel_size_m"] = json_number(info.voxel_size_m);
  document["blocks"] = info.blocks;
  document["size_bytes"] = info.size_bytes;
  document["content_hash"] = hash_text(info.content_hash);
  document["source"] = info.source;
  document["version"] = info.version;
  document["config"] = info.config_text;
  return document;
}

std::string text_of(const Json& document) {
  constexpr int kCompact = -1;
  return document.dump(kCompact, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string info_json(const std::filesystem::path& path, const MapInfo& info,
                      const ObjectLabels& labels) {
  return text_of(info_value(path, info, labels));
}

std::string scene_json(const std::filesystem::path& path, const MapInfo& info,
                       const ObjectLabels& labels, std::span<const ObjectRelation> relations) {
  Json document = info_value(path, info, labels);
  document["up"] = json_vector(info.up);
  document["relations"] = relation_list(relations);
  return text_of(document);
}

}  // namespace ovimap
