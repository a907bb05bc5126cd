// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/scene_graph.h"

#include "ovimap/base/error.h"
#include "ovimap/io/map_file/map_edits.h"
#include "ovimap/pipeline/rooms/map_rooms.h"
#include "ovimap/pipeline/search/object_labels.h"

namespace ovimap {

namespace {

constexpr float kBodyLow_m = 0.1f, kBodyHigh_m = 1.5f;  // as the exported grid's band

std::vector<std::string> titles_of(const SearchIndex& index, const TextEvidence* evidence) {
  const std::vector<ObjectName> guesses =
      evidence ? name_objects(*evidence) : std::vector<ObjectName>(index.size());
  std::vector<std::string> titles;
  for (std::size_t i = 0; i < index.size(); ++i)
    titles.push_back(index.object(i).name.empty() ? guesses[i].word : index.object(i).name);
  return titles;
}

}  // namespace

std::string SceneGraph::name_of(const Room& room) const {
  const auto kind = fits[static_cast<std::size_t>(room.id - 1)].kind();
  return kind ? room_kinds()[*kind].names[0] : concat("room ", room.id);
}

SceneGraph make_scene_graph(const StandingSpace& space, const MapSearch& search,
                            const TextEvidence* evidence) {
  SceneGraph graph;
  graph.plan = find_rooms(space.grid);
  graph.places =
      find_places(band_of(space.grid, kBodyLow_m, kBodyHigh_m, OccupancyConfig{}), graph.plan);
  const std::vector<InstanceId> ids = ids_of(search.index);
  graph.room_of = rooms_of_objects(graph.plan, space, ids);
  graph.fits = fit_rooms(graph.room_of, search.index.objects(), evidence);
  graph.fits.resize(graph.plan.rooms.size());
  graph.titles = titles_of(search.index, evidence);
  graph.relations = find_relations(ids, search.scene.shapes.whole());
  graph.grid_from_world = space.grid.grid_from_world;
  graph.floor_m = space.grid.floor_m;
  return graph;
}

SceneGraph read_scene_graph(const std::filesystem::path& map, const MapSearch& search,
                            const std::string& spec,
                            const std::vector<std::filesystem::path>& model_dirs) {
  const auto judge = open_word_judge(search, spec, model_dirs);
  return make_scene_graph(make_standing_space(load_corrected_map(map)), search, judge->evidence());
}

}  // namespace ovimap
