// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/reembed.h"

#include <algorithm>

#include "ovimap/semantics/views/object_embedding.h"

namespace ovimap {

namespace {

bool keeps_crops(const SemanticRecord& record) {
  for (const auto& [label, look] : record.looks)
    for (const ObjectView& view : look.views)
      if (!view.crop.empty()) return true;
  return false;
}

void reembed_views(SuperPointLook& look, const CropConfig& config, ImageTextEncoder& encoder,
                   ReembedSummary& summary) {
  std::vector<ObjectCrop> crops;
  std::vector<ObjectView*> views;
  for (ObjectView& view : look.views) {
    view.embedding = {};
    if (view.crop.empty()) {
      ++summary.dropped;
      continue;
    }
    crops.push_back(restore_crop(view.crop));
    views.push_back(&view);
  }
  std::vector<const ObjectCrop*> objects;
  for (const ObjectCrop& crop : crops) objects.push_back(&crop);
  const std::vector<Eigen::VectorXf> embeddings = embed_objects(encoder, objects, config);
  for (std::size_t i = 0; i < views.size(); ++i) views[i]->embedding = embeddings[i];
  summary.views += views.size();
  summary.super_points += std::any_of(embeddings.begin(), embeddings.end(),
                                      [](const auto& embedding) { return embedding.size() > 0; });
}

}  // namespace

ReembedSummary reembed(SemanticRecord& record, ImageTextEncoder& encoder,
                       const ReembedProgress& progress) {
  if (!keeps_crops(record))
    throw Error(
        "the map keeps no crops to embed; map the recording again with crops.kept_views above 0");
  SemanticRecord changed = record;
  ReembedSummary summary;
  std::size_t done = 0;
  for (auto& [label, look] : changed.looks) {
    reembed_views(look, changed.crops, encoder, summary);
    if (progress) progress(++done, changed.looks.size());
  }
  changed.encoder = encoder.identity();
  record = std::move(changed);
  return summary;
}

}  // namespace ovimap
