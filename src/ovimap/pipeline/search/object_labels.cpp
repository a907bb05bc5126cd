// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/search/object_labels.h"

#include "ovimap/base/error.h"

namespace ovimap {

const TextEvidence* WordJudge::evidence() const {
  return engine && engine->matcher() ? engine->matcher()->evidence() : nullptr;
}

std::unique_ptr<WordJudge> open_word_judge(const MapSearch& search, const std::string& spec,
                                           const std::vector<std::filesystem::path>& model_dirs) {
  auto judge = std::make_unique<WordJudge>();
  if (search.index.embedded() == 0) return judge;
  try {
    judge->encoder = encoder_of_map(search.info.encoder, spec, {}, model_dirs);
    if (judge->encoder)
      judge->engine.emplace(search.index, judge->encoder.get(), QueryConfig{}, Embeddings(),
                            search.scene);
  } catch (const Error&) {
  }
  return judge;
}

ObjectLabels labels_of(const SearchIndex& index, std::span<const ObjectName> names) {
  ObjectLabels labels;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (index.has_embedding(i) && names[i].clear())
      labels.emplace(index.object(i).id, names[i].word);
  return labels;
}

ObjectLabels read_labels(const MapSearch& search, const std::string& spec,
                         const std::vector<std::filesystem::path>& model_dirs) {
  const auto judge = open_word_judge(search, spec, model_dirs);
  if (!judge->evidence()) return {};
  return labels_of(search.index, name_objects(*judge->evidence()));
}

}  // namespace ovimap
