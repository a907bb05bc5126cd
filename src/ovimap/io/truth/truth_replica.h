// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "ovimap/io/truth/truth.h"

namespace ovimap {

/// Where Replica's own annotation of the recording ROOT/SCENE may lie, the nearest first:
/// ROOT/SCENE, ROOT/SCENE/habitat and, as Replica names the scene of "room0", ROOT/room_0 and
/// ROOT/room_0/habitat.
std::vector<std::filesystem::path> replica_annotation_folders(const std::filesystem::path& scene);

/// mesh_semantic.ply in one of those folders; empty when there is none.
std::filesystem::path find_replica_semantic_mesh(const std::filesystem::path& scene);

/// Loads a scene's truth as Replica publishes it: mesh_semantic.ply, whose faces have an object_id,
/// and info_semantic.json beside it, which tells the class and the name of each object. A vertex is
/// of the object that most of its triangles have, the one of the lowest id among equals. Objects of
/// a negative class have no class; object 0 is Replica's own for what is unlabelled. Throws Error
/// naming the file that is missing or broken.
Truth load_replica_semantic_mesh(const std::filesystem::path& mesh);

/// Names of classes and objects: {"classes": [{"id": 1, "name": "backpack"}], "objects": [{"id":
/// 12, "class_name": "sofa", "class_id": 76}]}. Throws Error when the file is not of that form.
void read_replica_names(const std::filesystem::path& info_semantic, Truth& truth);

}  // namespace ovimap
