// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "ovimap/geometry/mesh.h"

namespace ovimap {

/// What a scene really looks like.
struct Truth {
  Mesh mesh;                            ///< world frame, metres
  std::vector<std::int32_t> instances;  ///< id per vertex; 0 or less = unlabelled
  std::vector<std::int32_t> classes;    ///< class per vertex; empty when the source has none
  std::map<std::int32_t, std::string> instance_names, class_names;  ///< empty without labels.json
};

/// Loads the truth beside a recording in the Replica layout. `source` is the scene's folder
/// ROOT/SCENE (the one with results/ and traj.txt); the truth lies in ROOT:
///   SCENE_mesh.ply, instance_labels_SCENE.txt and, when there is one, semantic_labels_SCENE.txt
///   (one whole number per vertex), labels.json {"instances": {"12": "sofa"}, "classes": {"1":
///   "sofa"}}.
/// A labels.json in ROOT/SCENE goes before the one in ROOT. Throws Error naming the file that is
/// missing or broken.
Truth load_truth(const std::filesystem::path& source);

}  // namespace ovimap
