// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "ovimap/pipeline/approach/standing_space.h"
#include "ovimap/pipeline/rooms/places.h"
#include "ovimap/pipeline/rooms/room_plan.h"
#include "ovimap/pipeline/search/map_search.h"
#include "ovimap/semantics/relations/scene_relations.h"

namespace ovimap {

/// A map as rooms, places in them, objects in rooms, and how objects stand to each other.
struct SceneGraph {
  RoomPlan plan;
  PlaceGraph places;
  std::vector<RoomFit> fits;        ///< of plan.rooms, in their order
  std::vector<int> room_of;         ///< of each object of the index
  std::vector<std::string> titles;  ///< of each object: its name, else what it clearly is
  std::vector<ObjectRelation> relations;
  Eigen::Matrix3f grid_from_world = Eigen::Matrix3f::Identity();
  float floor_m = 0;  ///< height of the floor, grid frame

  /// "kitchen", or "room 2" where its kind is not clear.
  std::string name_of(const Room& room) const;
};

/// `evidence` may be null: then nothing but names that people gave says what objects and rooms are.
SceneGraph make_scene_graph(const StandingSpace& space, const MapSearch& search,
                            const TextEvidence* evidence);

/// The same of a map file. What objects look like counts where the encoder that `spec` names
/// (encoder_of_map) is on this machine. Throws what make_standing_space throws.
SceneGraph read_scene_graph(const std::filesystem::path& map, const MapSearch& search,
                            const std::string& spec,
                            const std::vector<std::filesystem::path>& model_dirs = {});

}  // namespace ovimap
