// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/name_guesses.h"

#include <algorithm>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

SearchIndex index_of(const MapRecord& map) {
  std::vector<SearchObject> objects;
  for (const InstanceSummary& instance : map.instances) {
    objects.push_back({instance.id, instance.box, instance.centroid, instance.points, ""});
  }
  const SemanticRecord& semantics = map.semantics;
  return SearchIndex(std::move(objects),
                     fused_embeddings(semantics.looks, map.instances, semantics.views.fusion,
                                      semantics.encoder.dimension));
}

}  // namespace

bool has_embeddings(const MapRecord& map) {
  return std::any_of(map.instances.begin(), map.instances.end(), [&](const auto& instance) {
    const Appearance look = appearance_of(map.semantics.looks, instance.super_points);
    return std::any_of(look.views.begin(), look.views.end(),
                       [](const ObjectView* view) { return view->embedding.size() > 0; });
  });
}

NameGuesses guess_names(const MapRecord& map, ImageTextEncoder& encoder, const LabelSet& set,
                        std::size_t top) {
  const EncoderIdentity &ours = map.semantics.encoder, &theirs = encoder.identity();
  if (!ours.name.empty() && !(ours == theirs))
    throw Error(concat("encoder '", theirs.name,
                       "' cannot name the map's objects: their embeddings ", "are those of '",
                       ours.name, "'", ours.name == theirs.name ? " with other files" : "",
                       "; name that encoder, or map again with this one"));
  const SearchIndex index = index_of(map);
  const auto classes = project_classes(index, encoder, set, top);
  NameGuesses guesses;
  for (std::size_t i = 0; i < index.size(); ++i)
    for (const ClassGuess& guess : classes[i])
      guesses[index.object(i).id].push_back({set.labels[guess.label].name, guess.score});
  return guesses;
}

}  // namespace ovimap
