// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ovimap/io/exports/object_titles.h"
#include "ovimap/pipeline/search/map_search.h"
#include "ovimap/semantics/classes/object_names.h"
#include "ovimap/semantics/query/query_engine.h"

namespace ovimap {

/// What tells household words of a map's objects: its encoder and what the map itself knows of
/// them. Refers to the search that it was made for.
struct WordJudge {
  std::unique_ptr<ImageTextEncoder> encoder;
  std::optional<QueryEngine> engine;

  /// Null where nothing tells words.
  const TextEvidence* evidence() const;
};

/// With the encoder that `spec` names (encoder_of_map). Where the map has no embeddings, or that
/// encoder is not on this machine, nothing tells words: a search in words says why, here they are
/// an extra.
std::unique_ptr<WordJudge> open_word_judge(
    const MapSearch& search, const std::string& spec,
    const std::vector<std::filesystem::path>& model_dirs = {});

/// Of `names`, by position in the index, those that are clear.
ObjectLabels labels_of(const SearchIndex& index, std::span<const ObjectName> names);

/// The household words of a map's objects; none where nothing tells them (open_word_judge).
ObjectLabels read_labels(const MapSearch& search, const std::string& spec,
                         const std::vector<std::filesystem::path>& model_dirs = {});

}  // namespace ovimap
