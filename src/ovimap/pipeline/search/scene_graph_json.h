// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ovimap/pipeline/search/scene_graph.h"

namespace ovimap {

/// The JSON object of docs/export.md, "Scene graph". Metres, world frame.
std::string scene_graph_json(const SceneGraph& graph, const MapSearch& search);

}  // namespace ovimap
