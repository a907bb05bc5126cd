// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "ovimap/geometry/mesh.h"
#include "ovimap/io/exports/object_titles.h"
#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/semantics/relations/scene_relations.h"

namespace ovimap {

/// Throws Error unless `folder` can be created, or is there, empty and writable. Changes nothing.
void check_new_folder(const std::filesystem::path& folder);

/// Writes a folder per object, named "12" or "12_mug", with mesh.ply (world frame), object.json (as
/// in instances_json, with its "relations" and its "crops": file, mask, frame, visible_px, box_px)
/// and the kept crops as crop_1.jpg and crop_1_mask.png (white on the object), largest view first;
/// and scene.json, `scene_text`, beside them. `parts` have instance ids as labels. The folder
/// appears only when complete. Throws Error as check_new_folder, and naming what cannot be written.
void write_object_folder(const std::filesystem::path& folder, const MapRecord& map,
                         const ObjectLabels& labels, const MeshParts& parts,
                         std::span<const ObjectRelation> relations, const std::string& scene_text);

}  // namespace ovimap
