// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "ovimap/io/map_tables/map_document.h"
#include "ovimap/semantics/classes/label_set.h"

namespace ovimap {

struct NameGuess {
  std::string name;
  float cosine = 0;  ///< of the object's embedding with the name's
};

/// Best first; none for objects without embedding.
using NameGuesses = std::map<InstanceId, std::vector<NameGuess>>;

/// Whether any listed instance has an embedding, so that names can be guessed.
bool has_embeddings(const MapRecord& map);

/// The `top` names of the set that fit each instance best. Throws Error when the map has no
/// embeddings, or not that encoder's.
NameGuesses guess_names(const MapRecord& map, ImageTextEncoder& encoder, const LabelSet& set,
                        std::size_t top);

}  // namespace ovimap
