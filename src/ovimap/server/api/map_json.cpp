// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/map_json.h"

#include <span>

#include <nlohmann/json.hpp>

#include "ovimap/base/error.h"
#include "ovimap/base/version.h"
#include "ovimap/io/exports/json_values.h"
#include "ovimap/io/map_tables/map_file_record.h"
#include "ovimap/io/pictures/palette.h"
#include "ovimap/pipeline/search/history_dates.h"
#include "ovimap/semantics/query/query_grammar.h"
#include "ovimap/semantics/relations/scene_relations.h"
#include "ovimap/semantics/words/main_colors.h"
#include "ovimap/server/api/correction_json.h"
#include "ovimap/server/api/neighbors.h"
#include "ovimap/server/http/request_body.h"

namespace ovimap {

namespace {

using nlohmann::json;

json box(const Eigen::AlignedBox3f& b) {
  const json nowhere = {nullptr, nullptr, nullptr};
  if (b.isEmpty()) return {{"min", nowhere}, {"max", nowhere}};
  return {{"min", rounded_point(b.min())}, {"max", rounded_point(b.max())}};
}

json color(Rgb8 c) {
  return {c.r, c.g, c.b};
}

/// Sixteen colours from cold to hot; what lies between is interpolated.
json heat_ramp() {
  constexpr int kColors = 16;
  json ramp = json::array();
  for (int i = 0; i < kColors; ++i)
    ramp.push_back(color(heat_color(static_cast<float>(i) / (kColors - 1))));
  return ramp;
}

std::span<const ClassGuess> guesses_of(const MapSnapshot& now, InstanceId id) {
  if (!now.guesses) return {};
  const auto found = now.guesses->of_object.find(id);
  if (found == now.guesses->of_object.end()) return {};
  return found->second;
}

json guesses_json(const MapSnapshot& now, InstanceId id) {
  json list = json::array();
  for (const ClassGuess& guess : guesses_of(now, id))
    list.push_back({{"name", now.guesses->set.labels[guess.label].name},
                    {"cosine", rounded_json(guess.score)}});
  return list;
}

json class_of(const MapSnapshot& now, InstanceId id) {
  const auto guesses = guesses_of(now, id);
  if (guesses.empty()) return nullptr;
  const ClassLabel& label = now.guesses->set.labels[guesses.front().label];
  return {{"id", label.id},
          {"name", label.name},
          {"color", color(instance_color(static_cast<std::uint32_t>(label.id)))}};
}

/// What the object is called where nobody named it; null: not known yet.
json label_of(const MapSnapshot& now, std::size_t position) {
  if (position >= now.names.size()) return nullptr;
  const ObjectName& name = now.names[position];
  return {{"name", name.word}, {"share", name.share}};
}

/// Positions of an object's views that keep a crop, as ordinals of /crops/.
json crops_of(const MapSnapshot& now, const InstanceSummary& instance) {
  json ordinals = json::array();
  const Appearance look = appearance_of(now.record->semantics.looks, instance.super_points);
  for (std::size_t i = 0; i < look.views.size(); ++i)
    if (!look.views[i]->crop.empty()) ordinals.push_back(i);
  return ordinals;
}

/// Readings of what is written on it, surest first.
json writing_of(const MapSnapshot& now, InstanceId id) {
  json list = json::array();
  const auto& known = now.objects->info.writing;
  if (const auto lines = known.find(id); lines != known.end())
    for (const WrittenLine& line : lines->second)
      list.push_back({{"text", line.text}, {"confidence", rounded_json(line.confidence)}});
  return list;
}

/// When the last frame was taken that showed it; null: not known.
json last_seen_of(const MapSnapshot& now, const HistoryDates& dates,
                  const InstanceSummary& instance) {
  const auto seen = last_seen(*now.record, dates, instance.super_points);
  if (!seen) return nullptr;
  return {
      {"visit", seen->visit}, {"visits", dates.visits()}, {"time_s", json_or_null(seen->time_s)}};
}

json instance_json(const MapSnapshot& now, const HistoryDates& dates, std::size_t position) {
  const InstanceSummary& instance = now.record->instances[position];
  return {{"id", instance.id},
          {"name", now.name_of(instance.id)},
          {"label", label_of(now, position)},
          {"guesses", guesses_json(now, instance.id)},
          {"class", class_of(now, instance.id)},
          {"color", color(instance_color(instance.id))},
          {"box", box(instance.box)},
          {"centroid", rounded_point(instance.centroid)},
          {"points", instance.points},
          {"views", instance.views},
          {"last_seen", last_seen_of(now, dates, instance)},
          {"confidence", instance.confidence ? rounded_json(*instance.confidence) : json()},
          {"locked", now.record->locked.contains(instance.id)},
          {"crops", crops_of(now, instance)},
          {"writing", writing_of(now, instance.id)}};
}

json colors_json(const QueryScene& scene, std::size_t position) {
  json list = json::array();
  if (!scene.colors || position >= scene.colors->surfaces().size()) return list;
  for (const auto& [color, share] : main_colors(scene.colors->surfaces()[position].shares))
    list.push_back({{"name", color_name(color)}, {"share", rounded_json(share)}});
  return list;
}

/// Parts that masks tell in an object, by number.
json parts_json(const MapSnapshot& now, std::size_t position) {
  json list = json::array();
  const QueryScene& scene = now.objects->scene;
  for (const std::size_t p : scene.parts_of(position)) {
    const SearchObject& part = scene.parts->index.object(p);
    list.push_back({{"number", scene.parts->numbers[p]},
                    {"box", box(part.box)},
                    {"centroid", rounded_point(part.centroid)},
                    {"points", part.points}});
  }
  return list;
}

json part_json(const QueryMatch& match) {
  if (match.part == 0) return nullptr;
  return {{"number", match.part}, {"box", box(match.part_box)}};
}

json match_json(const MapAnswer& answered, const QueryMatch& match) {
  const SearchObject& object = answered.index().object(match.position);
  const std::size_t event = answered.past ? answered.past->events[match.position] : 0;
  return {{"id", match.id},
          {"name", answered.map->name_of(match.id)},
          {"box", box(object.box)},
          {"centroid", rounded_point(object.centroid)},
          {"event", event == 0 ? json() : json(event)},
          {"score", match.score},
          {"standard_score", match.standard_score},
          {"p_value", json_or_null(match.p_value)},
          {"probability", json_or_null(match.probability)},
          {"evidence", match.evidence},
          {"part", part_json(match)}};
}

json teaching_json(const Teaching& teaching) {
  return {{"on", teaching.on}, {"examples", teaching.examples}, {"fault", teaching.fault}};
}

json camera_json(const PinholeCamera& camera) {
  return {{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
          {"fy", camera.fy},       {"cx", camera.cx},         {"cy", camera.cy}};
}

}  // namespace

std::size_t position_of(const MapSnapshot& now, InstanceId id) {
  if (const auto position = now.index().find(now.current_id(id))) return *position;
  throw BadRequest(404, concat("the map has no object ", id, "; GET /api/instances lists them"));
}

json map_json(const ServedMap& map) {
  const std::uint64_t last_event = map.events().last();  // before the rest, which may be newer
  const auto now = map.snapshot();
  const MapInfo& info = now->objects->info;
  return {{"title", map.path().stem().string()},
          {"program", version()},
          {"version", now->version},
          {"mesh_version", map.surface()->version()},
          {"last_event", last_event},
          {"live", now->live},
          {"tracking", json::parse(tracking_json(map.tracking()))},
          {"frames", info.frames},
          {"mask_frames", info.mask_frames},
          {"instances", now->record->instances.size()},
          {"voxel_size_m", rounded_json(info.voxel_size_m)},
          {"up", rounded_point(info.up)},
          {"blocks", info.blocks},
          {"size_bytes", info.size_bytes},
          {"content_hash", hash_text(info.content_hash)},
          {"encoder", info.encoder.name},
          {"search", {{"state", search_state_name(now->search)}, {"reason", now->why_no_search}}},
          {"classes", now->guesses ? json(now->guesses->set.name) : json()},
          {"teaching", teaching_json(map.teaching())},
          {"heat_ramp", heat_ramp()}};
}

json instances_json(const ServedMap& map) {
  const auto now = map.snapshot();
  const HistoryDates dates(now->record->history, now->record->frames);
  json list = json::array();
  for (std::size_t i = 0; i < now->record->instances.size(); ++i)
    list.push_back(instance_json(*now, dates, i));
  return {{"version", now->version}, {"instances", list}};
}

json labels_json(const ServedMap& map) {
  const auto now = map.snapshot();
  json hidden = json::array();
  for (const InstanceSummary& instance : now->record->hidden) hidden.push_back(instance.id);
  return {{"version", now->version}, {"instances", now->instance_of_label}, {"hidden", hidden}};
}

json corrections_json(const ServedMap& map) {
  const auto now = map.snapshot();
  json log = json::array();
  for (const MapEdit& edit : now->record->edits) log.push_back(edit_json(edit));
  return {{"version", now->version}, {"corrections", log}};
}

json instance_detail_json(const ServedMap& map, InstanceId id) {
  const auto now = map.snapshot();
  const std::size_t position = position_of(*now, id);
  const QueryScene& scene = now->objects->scene;
  json detail =
      instance_json(*now, HistoryDates(now->record->history, now->record->frames), position);
  const ObjectShape& shape = scene.shapes.outline(position);
  detail["super_points"] = now->record->instances[position].super_points;
  detail["height_m"] = rounded_json(shape.height_m());
  detail["footprint_m2"] = rounded_json(area_m2(shape.footprint));
  detail["colors"] = colors_json(scene, position);
  detail["parts"] = parts_json(*now, position);
  detail["neighbors"] = json::array();
  for (const Neighbor& other : neighbors_of(now->index(), scene, position, map.relations()))
    detail["neighbors"].push_back({{"id", other.id},
                                   {"relation", other.relation},
                                   {"gap_m", rounded_json(other.gap_m)},
                                   {"evidence", other.evidence}});
  return detail;
}

static json count_json(const std::optional<CountEstimate>& count) {
  if (!count) return json();
  return {{"expected", rounded_json(static_cast<float>(count->expected))},
          {"deviation", rounded_json(static_cast<float>(count->deviation))},
          {"found", count->found}};
}

json answer_json(const MapAnswer& answered) {
  const QueryAnswer& answer = answered.answer;
  json matches = json::array();
  for (const QueryMatch& match : answer.matches) matches.push_back(match_json(answered, match));
  json result = {{"query", answer.query},
                 {"verdict", verdict_name(answer.verdict)},
                 {"reading", answer.reading},
                 {"reason", answer.reason},
                 {"count", count_json(answer.count)},
                 {"matches", matches}};
  if (answer.relevance.size() > 0) {
    result["heat"] = json::array();
    for (std::size_t i = 0; i < answered.index().size(); ++i)
      result["heat"].push_back({answered.index().object(i).id,
                                rounded_json(answer.relevance[static_cast<Eigen::Index>(i)])});
  }
  return result;
}

json relations_json(const ServedMap& map) {
  const auto now = map.snapshot();
  json list = json::array();
  for (const ObjectRelation& relation :
       find_relations(ids_of(now->index()), now->objects->scene.shapes.whole(), map.relations()))
    list.push_back({{"object", relation.object},
                    {"relation", relation_name(relation.relation)},
                    {"anchor", relation.anchor},
                    {"score", rounded_json(relation.score)},
                    {"evidence", relation.evidence}});
  return {{"version", now->version}, {"relations", list}};
}

json mesh_json(const ServedMap& map, int level, std::uint64_t since) {
  const auto surface = map.surface();
  json chunks = json::array();
  for (const ChunkListing& chunk : surface->list(level, since)) {
    json row = {{"x", chunk.index.x()},
                {"y", chunk.index.y()},
                {"z", chunk.index.z()},
                {"version", chunk.version}};
    for (const auto& [name, total] : {std::pair("patches", &ChunkTotals::patches),
                                      std::pair("vertices", &ChunkTotals::vertices),
                                      std::pair("triangles", &ChunkTotals::triangles)})
      row[name] = chunk.totals ? json((*chunk.totals).*total) : json();
    chunks.push_back(std::move(row));
  }
  return {{"version", surface->version()},
          {"level", level},
          {"chunk_edge_m", surface->grid().edge_m()},
          {"chunks", chunks}};
}

json cameras_json(const ServedMap& map) {
  const auto now = map.snapshot();
  json frames = json::array();
  for (const FrameLogEntry& frame : now->record->frames) {
    json pose = json::array();
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column)
        pose.push_back(rounded_json(frame.world_from_camera.matrix()(row, column)));
    frames.push_back({{"index", frame.index},
                      {"timestamp_s", rounded_json(frame.timestamp_s)},
                      {"labelled", frame.labelled},
                      {"world_from_camera", pose}});
  }
  return {{"camera", camera_json(now->record->depth_camera)}, {"frames", frames}};
}

}  // namespace ovimap
