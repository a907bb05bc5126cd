// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>

#include "apps/command/command.h"
#include "ovimap/base/text/printable.h"
#include "ovimap/io/exports/instance_json.h"
#include "ovimap/io/exports/json_values.h"
#include "ovimap/io/map_file/map_check.h"
#include "ovimap/io/map_file/map_file_access.h"
#include "ovimap/io/map_file/searchable_map.h"
#include "ovimap/pipeline/revise/percent_text.h"
#include "ovimap/pipeline/search/history_search.h"
#include "ovimap/pipeline/search/object_labels.h"
#include "ovimap/pipeline/search/scene_graph.h"
#include "ovimap/pipeline/sequence/timings_text.h"

namespace ovimap::apps {

namespace {

struct InfoOptions {
  std::filesystem::path map;
  bool check = false;
  bool history = false, rooms = false, parts = false;
  bool recover = false;
  bool json = false;
};

/// Exit code 1: something is damaged.
int check_file(const InfoOptions& options) {
  const MapCheck check = check_map(options.map);
  if (options.json) {
    print_json({{"map", options.map.string()},
                {"ok", check.faults.empty()},
                {"faults", check.faults},
                {"tables", check.tables},
                {"tiles", check.tiles},
                {"blocks", check.blocks}});
  } else {
    for (const std::string& fault : check.faults) std::printf("damaged: %s\n", fault.c_str());
    std::printf("%s: %zu tables, %zu tiles with %zu blocks of voxels: %s\n", options.map.c_str(),
                check.tables, check.tiles, check.blocks,
                check.faults.empty() ? "all as written" : "restore it from a copy or map again");
  }
  return check.faults.empty() ? kDone : kAnswerIsNo;
}

/// What objects clearly are, those that are gone included; none where nothing tells words.
ObjectLabels labels_with_gone(const std::filesystem::path& path, const MapInfo& map) {
  ObjectLabels labels;
  try {
    const auto encoder = encoder_of_map(map.encoder, "auto", {});
    if (!encoder) return labels;
    for (auto& [id, word] : words_with_gone(read_corrected_record(path), map, *encoder, {}, {}))
      if (word != ObjectName::kUnclear) labels.emplace(id, std::move(word));
  } catch (const Error&) {  // a search in words says why; here they are an extra
  }
  return labels;
}

/// The name that people gave, or in brackets what the object looks like.
std::string shown_title(const ObjectTitles& titles, InstanceId id) {
  const std::string name = titles.name_of(id), label = titles.label_of(id);
  return !name.empty() || label.empty() ? name : concat("(", label, ")");
}

/// A line for each visit, and below it one for each thing that it found changed.
void print_history(const MapInfo& map, const ObjectTitles& titles, const HistoryDates& dates) {
  std::vector<MapVisit> visits = map.history.visits;
  if (visits.empty()) visits.push_back({map.source, 0, 0});
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const std::int64_t end = i + 1 < visits.size() ? visits[i + 1].first_frame : map.frames;
    const int visit = static_cast<int>(i + 1);
    std::printf("%s, %lld frames: %s\n", dates.visit_text(visit).c_str(),
                static_cast<long long>(end - visits[i].first_frame), visits[i].source.c_str());
    for (const ObjectEvent& event : map.history.events) {
      if (event.visit != visit) continue;
      std::printf("%6u  %-24s %s\n", event.instance, shown_title(titles, event.instance).c_str(),
                  event_text(event).c_str());
    }
  }
}

/// A line for each room and what is in it, then one for each door.
void print_rooms(const InfoOptions& options) {
  const MapSearch search = open_map_search(options.map);
  const SceneGraph graph = read_scene_graph(options.map, search, "auto");
  if (graph.plan.rooms.empty())
    std::printf("no rooms: the frames looked through no free space at breast height\n");
  for (const Room& room : graph.plan.rooms) {
    const std::string number = concat("room ", room.id), name = graph.name_of(room);
    std::printf("%s, %.1f m2%s\n", number.c_str(), double{room.area_m2},
                name == number ? "" : concat(": ", name).c_str());
    for (std::size_t i = 0; i < search.index.size(); ++i)
      if (graph.room_of[i] == room.id)
        std::printf("%6u  %s\n", search.index.object(i).id, graph.titles[i].c_str());
  }
  for (const RoomDoor& door : graph.plan.doors)
    std::printf("door from room %d to room %d at %.2f %.2f, %.2f m wide\n", door.first, door.second,
                double{door.place_m.x()}, double{door.place_m.y()}, double{door.width_m});
}

/// Adds to each object when it was seen last.
void add_sightings(const MapSightings& sightings, const HistoryDates& dates,
                   nlohmann::json& instances) {
  for (nlohmann::json& instance : instances) {
    std::int64_t last = -1;
    for (const Label label : instance["superpoints"].get<std::vector<Label>>())
      if (const auto seen = sightings.last.find(label); seen != sightings.last.end())
        last = std::max(last, seen->second);
    if (const auto seen = dates.sighting(last))
      instance["last_seen"] = {{"visit", seen->visit}, {"time_s", json_or_null(seen->time_s)}};
  }
}

/// Adds when visits were and events happened, in seconds since 1970 (UTC) or null.
void add_dates(const HistoryDates& dates, nlohmann::json& history) {
  for (std::size_t i = 0; i < history["visits"].size(); ++i)
    history["visits"][i]["begin_s"] = json_or_null(dates.begin_of(static_cast<int>(i) + 1));
  for (std::size_t i = 0; i < history["events"].size(); ++i)
    history["events"][i]["time_s"] = json_or_null(dates.date_of(i));
}

void print_parts(std::span<const ObjectPart* const> parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Eigen::Vector3f center = parts[i]->centroid, size = parts[i]->box.sizes();
    std::printf("%6s  %-24s %8.2f%8.2f%8.2f %8.2f%8.2f%8.2f %8zu %6d\n", "",
                concat("  part ", i + 1).c_str(), double{center.x()}, double{center.y()},
                double{center.z()}, double{size.x()}, double{size.y()}, double{size.z()},
                parts[i]->points, parts[i]->views);
  }
}

int info(const InfoOptions& options) {
  if (options.recover && !recover_map(options.map))
    std::fprintf(stderr, "%s: nothing to recover\n", options.map.c_str());
  if (options.check || options.recover) return check_file(options);
  if (options.rooms && !options.json && !options.history) {
    print_rooms(options);
    return kDone;
  }
  const MapInfo map = read_map_info(options.map);
  const TileTraffic tiles = tile_traffic(parse_timings(map.timings));
  ObjectTitles titles{map.names, {}};
  if (options.history && !options.json) {
    if (!map.encoder.name.empty()) titles.labels = labels_with_gone(options.map, map);
    print_history(map, titles, HistoryDates(map.history, read_sightings(options.map).frames));
    return kDone;
  }
  if (!map.encoder.name.empty()) titles.labels = read_labels(open_map_search(options.map), "auto");
  if (options.json) {
    auto document = nlohmann::json::parse(info_json(options.map, map, titles.labels));
    document["tiles_evicted"] = tiles.evicted;
    document["tiles_loaded"] = tiles.loaded;
    const MapSightings sightings = read_sightings(options.map);
    const HistoryDates dates(map.history, sightings.frames);
    add_sightings(sightings, dates, document["instances"]);
    if (!map.history.visits.empty()) add_dates(dates, document["history"]);
    print_json(document);
    return kDone;
  }
  std::printf(
      "%s: %zu objects, %lld frames, %lld blocks of %g m voxels, %.1f MB, made by ovimap %s\n",
      options.map.c_str(), map.instances.size(), static_cast<long long>(map.frames),
      static_cast<long long>(map.blocks), double{map.voxel_size_m},
      static_cast<double>(map.size_bytes) / 1e6, printable(map.version).c_str());
  if (map.unfinished)
    std::printf(
        "unfinished: a run was broken off; the same command with --resume goes on with it\n");
  if (tiles.evicted > 0)
    std::printf("made within a bound on memory: %zu tiles left it, %zu came back\n", tiles.evicted,
                tiles.loaded);
  std::printf("%6s  %-24s %24s %24s %8s %6s %6s\n", "id", "name", "centroid (m)", "size (m)",
              "points", "views", "whole");
  const auto parts = parts_by_object(map.parts, map.instances);
  for (const InstanceSummary& instance : map.instances) {
    const Eigen::Vector3f center = instance.centroid, size = instance.box.sizes();
    std::printf("%6u  %-24s %8.2f%8.2f%8.2f %8.2f%8.2f%8.2f %8zu %6d %6s\n", instance.id,
                shown_title(titles, instance.id).c_str(), double{center.x()}, double{center.y()},
                double{center.z()}, double{size.x()}, double{size.y()}, double{size.z()},
                instance.points, instance.views,
                instance.confidence ? percent_text(*instance.confidence).c_str() : "");
    if (const auto of_it = parts.find(instance.id); options.parts && of_it != parts.end())
      print_parts(of_it->second);
  }
  return kDone;
}

}  // namespace

Action add_info(CLI::App& command) {
  auto options = std::make_shared<InfoOptions>();
  command.add_option("MAP", options->map, "map file")->required();
  command.add_flag("--check", options->check,
                   "examine the file: SQLite's own check, the hash of every table and tile; exit "
                   "code 1 and a list where something is damaged");
  command.add_flag("--history", options->history,
                   "which recordings went into the map, and what each found moved, gone or new");
  command.add_flag("--rooms", options->rooms,
                   "which rooms the map has, what is in each, and the doors between them");
  command.add_flag("--parts", options->parts,
                   "list below each object the parts that masks tell in it: drawers, cushions");
  command.add_flag("--recover", options->recover,
                   "make a map whole beside which a change that was cut short left its log: the "
                   "change is taken back, or in where it was finished; then examine it");
  command.add_flag("--json", options->json, "print one JSON object");
  return [options] { return info(*options); };
}

}  // namespace ovimap::apps
