// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "ovimap/io/exports/object_titles.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/semantics/relations/scene_relations.h"

namespace ovimap {

/// What a map file is, as a JSON object: {"map", "schema", "frames", "mask_frames", "instances", a
/// list of {"id", "name", "label", "box": {"min", "max"}, "centroid", "points", "views",
/// "confidence" where masks are rated, "superpoints"}, metres in the world frame, "hidden" and
/// "locked" (ids, as people corrected the map), "history" ({"visits", "events"}, docs/changes.md),
/// "voxel_size_m", "blocks", "size_bytes", "content_hash" (16 hexadecimal digits), "source",
/// "version", "config"}; an instance of which parts are known has "parts", a list of
/// {"name", "box", "centroid", "points", "views", "confidence", "superpoints"}. And, where it was
/// read, "writing": {"reader", "objects":
/// {"ID": [{"text", "confidence"}]}}. `path` is how the map is called in it. A name or label is ""
/// where there is none; what is not UTF-8 in it is replaced.
std::string info_json(const std::filesystem::path& path, const MapInfo& info,
                      const ObjectLabels& labels = {});

/// The same and how the objects stand to each other: "up" (away from the ground, world frame) and
/// "relations", a list of {"object", "relation", "anchor", "score", "evidence"}, ids.
std::string scene_json(const std::filesystem::path& path, const MapInfo& info,
                       const ObjectLabels& labels, std::span<const ObjectRelation> relations);

}  // namespace ovimap
