// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ovimap/geometry/mesh.h"
#include "ovimap/io/map_file/searchable_map.h"
#include "ovimap/semantics/query/query_scene.h"

namespace ovimap {

/// A saved map, ready for a QueryEngine.
struct MapSearch {
  MapInfo info;
  SearchIndex index;  ///< positions are those of info.instances
  QueryScene scene;   ///< surfaces where the map has them, else boxes; seen from the mean camera
};

/// The objects' ids, by position.
std::vector<InstanceId> ids_of(const SearchIndex& index);

/// Reads what a search needs, without the voxels, which are read when a query asks for a room.
/// Throws what read_searchable_map throws.
MapSearch open_map_search(const std::filesystem::path& map);

/// The same of a corrected map in memory. `info`: what the record does not tell; the rest of it is
/// filled in.
MapSearch make_map_search(const MapRecord& corrected, MapInfo info);

/// The encoder that `spec` names, as make_image_text_encoder takes it, or with "auto" the model on
/// the search path that the map's embeddings are of. Throws Error when there is none, or when its
/// embeddings cannot be compared with the map's. Null where `spec` is "none" or empty.
std::unique_ptr<ImageTextEncoder> encoder_of_map(
    const EncoderIdentity& of_map, const std::string& spec, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs = {});

/// The same for work that is pointless without: throws Error where `spec` names none.
std::unique_ptr<ImageTextEncoder> needed_encoder_of_map(
    const EncoderIdentity& of_map, const std::string& spec, const RuntimeConfig& runtime,
    const std::vector<std::filesystem::path>& model_dirs = {});

/// Colours a mesh labelled with instance ids by the relevance [objects] of an answer; what is no
/// object of the index is as irrelevant as can be.
void color_by_relevance(Mesh& mesh, const SearchIndex& index, const Eigen::VectorXf& relevance);

}  // namespace ovimap
