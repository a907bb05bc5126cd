// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/scene_graph_json.h"

#include <nlohmann/json.hpp>

#include "ovimap/io/exports/json_values.h"
#include "ovimap/pipeline/rooms/room_outline.h"
#include "ovimap/semantics/query/query_grammar.h"

namespace ovimap {

namespace {

using Json = nlohmann::ordered_json;

Json on_floor(const SceneGraph& graph, const Eigen::Vector2f& place) {
  return rounded_point<Json>(graph.grid_from_world.transpose() *
                             Eigen::Vector3f(place.x(), place.y(), graph.floor_m));
}

Json outline_json(const SceneGraph& graph, int room) {
  Json outline = Json::array();
  for (const Polygon& polygon : room_outline(graph.plan, room)) {
    Json corners = Json::array();
    for (const Eigen::Vector2f& corner : polygon) corners.push_back(on_floor(graph, corner));
    outline.push_back(std::move(corners));
  }
  return outline;
}

Json room_json(const SceneGraph& graph, const Room& room, const SearchIndex& index) {
  const RoomFit& fit = graph.fits[static_cast<std::size_t>(room.id - 1)];
  Json kinds = Json::object(), known_by = Json::array(), objects = Json::array();
  for (std::size_t k = 0; k < fit.chances.size(); ++k)
    if (fit.chances[k] > 0.f) kinds[room_kinds()[k].names[0]] = rounded_json<Json>(fit.chances[k]);
  if (const auto kind = fit.kind())
    for (const std::size_t thing : fit.known_by[*kind]) known_by.push_back(index.object(thing).id);
  for (std::size_t i = 0; i < index.size(); ++i)
    if (graph.room_of[i] == room.id) objects.push_back(index.object(i).id);
  return {{"id", room.id},
          {"name", graph.name_of(room)},
          {"kinds", kinds},
          {"known_by", known_by},
          {"area_m2", rounded_json<Json>(room.area_m2)},
          {"center", on_floor(graph, room.center_m)},
          {"outline", outline_json(graph, room.id)},
          {"objects", objects}};
}

Json box_json(const Eigen::AlignedBox3f& box) {
  return {{"min", rounded_point<Json>(box.min())}, {"max", rounded_point<Json>(box.max())}};
}

/// What masks tell in the object at a position, in the order of their numbers, from 1.
Json parts_json(const QueryScene& scene, std::size_t position) {
  Json list = Json::array();
  for (const std::size_t p : scene.parts_of(position)) {
    const SearchObject& part = scene.parts->index.object(p);
    list.push_back({{"box", box_json(part.box)}, {"centroid", rounded_point<Json>(part.centroid)}});
  }
  return list;
}

Json object_json(const SceneGraph& graph, const MapSearch& search, std::size_t position) {
  const SearchObject& object = search.index.object(position);
  return {{"id", object.id},
          {"name", object.name},
          {"title", graph.titles[position]},
          {"room", graph.room_of[position]},
          {"box", box_json(object.box)},
          {"centroid", rounded_point<Json>(object.centroid)},
          {"parts", parts_json(search.scene, position)}};
}

}  // namespace

std::string scene_graph_json(const SceneGraph& graph, const MapSearch& search) {
  Json rooms = Json::array(), doors = Json::array(), places = Json::array(), links = Json::array(),
       objects = Json::array(), relations = Json::array();
  for (const Room& room : graph.plan.rooms) rooms.push_back(room_json(graph, room, search.index));
  for (const RoomDoor& door : graph.plan.doors)
    doors.push_back({{"rooms", Json::array({door.first, door.second})},
                     {"place", on_floor(graph, door.place_m)},
                     {"width_m", rounded_json<Json>(door.width_m)}});
  for (const Place& place : graph.places.places)
    places.push_back({{"place", on_floor(graph, place.middle_m)},
                      {"radius_m", rounded_json<Json>(place.radius_m)},
                      {"room", place.room}});
  for (const auto& [a, b] : graph.places.links) links.push_back(Json::array({a, b}));
  for (std::size_t i = 0; i < search.index.size(); ++i)
    objects.push_back(object_json(graph, search, i));
  for (const ObjectRelation& relation : graph.relations)
    relations.push_back({{"object", relation.object},
                         {"relation", relation_name(relation.relation)},
                         {"anchor", relation.anchor},
                         {"score", rounded_json<Json>(relation.score)},
                         {"evidence", relation.evidence}});
  Json turn = Json::array();
  for (int i = 0; i < 9; ++i) turn.push_back(graph.grid_from_world(i / 3, i % 3));
  const Json whole = {{"up", rounded_point<Json>(search.info.up)},
                      {"grid_from_world", turn},
                      {"floor_m", rounded_json<Json>(graph.floor_m)},
                      {"rooms", rooms},
                      {"doors", doors},
                      {"places", places},
                      {"links", links},
                      {"objects", objects},
                      {"relations", relations}};
  return whole.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ovimap
