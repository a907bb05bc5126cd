// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/string.h>

#include "bindings.h"
#include "ovimap/pipeline/search/scene_graph.h"
#include "ovimap/pipeline/search/scene_graph_json.h"
#include "saved_map.h"
#include "without_gil.h"

namespace ovimap::python {

namespace {

/// What speaks for words, or null where that cannot be told: a search in words says why.
const TextEvidence* evidence_of(SavedMap& map) {
  try {
    const TextMatcher* matcher = map.engine(true).matcher();
    return matcher ? matcher->evidence() : nullptr;
  } catch (const Error&) {
    return nullptr;
  }
}

std::string scene_graph(SavedMap& map) {
  const SceneGraph graph = make_scene_graph(map.standing_space(), map.search(), evidence_of(map));
  return scene_graph_json(graph, map.search());
}

}  // namespace

void bind_scene(nb::class_<SavedMap>& map) {
  map.def("scene_graph", &scene_graph, nb::call_guard<WithoutGil>(),
          "Rooms, doors, places, objects and how they stand to each other, as JSON "
          "(docs/export.md, \"Scene graph\"). Reads the voxels the first time. Raises Error for a "
          "map without voxels.");
}

}  // namespace ovimap::python
