// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/appearance_builder.h"

#include <algorithm>
#include <utility>

#include "ovimap/base/config.h"

namespace ovimap {

void list_fields(SemanticsConfig& config, ConfigFields& fields) {
  fields.group("views", [&](ConfigFields& f) { list_fields(config.views, f); });
  fields.group("crops", [&](ConfigFields& f) { list_fields(config.crops, f); });
  fields.group("embedding", [&](ConfigFields& f) { list_fields(config.queue, f); });
}

AppearanceBuilder::AppearanceBuilder(const SemanticsConfig& config,
                                     std::shared_ptr<ImageTextEncoder> encoder)
    : config_(config),
      encoder_(std::move(encoder)),
      selector_(config.views),
      queue_(config.queue, config.crops, encoder_) {}

int AppearanceBuilder::choose(const Frame& frame, const SeenObjects& seen,
                              const InstanceRegistry& registry) {
  apply(queue_.take(), registry);
  for (const ChosenView& view : selector_.select(seen, registry, appearances_)) {
    auto crop =
        cut_object(frame, {seen.depth, seen.instances, view.id, view.box_px}, config_.crops);
    if (!crop) continue;  // outside the colour image: the view stays without embedding
    asked_for_[view.ticket] = view.id;
    chosen_.push_back({view.ticket, std::move(*crop)});
  }
  return static_cast<int>(chosen_.size());
}

void AppearanceBuilder::submit(bool wait) {
  queue_.submit(std::exchange(chosen_, {}), wait);
}

void AppearanceBuilder::finish(const InstanceRegistry& registry) {
  apply(queue_.finish(), registry);
  for (auto& [id, appearance] : appearances_) prune_crops(appearance, config_.crops.kept_views);
}

void AppearanceBuilder::apply(std::vector<EmbeddingAnswer> answers,
                              const InstanceRegistry& registry) {
  follow_merges(appearances_, registry);
  for (EmbeddingAnswer& answer : answers) {
    if (encoder_) durations_ms_.push_back(answer.milliseconds);
    const InstanceId asked = asked_for_.extract(answer.ticket).mapped();
    const auto owner = appearances_.find(registry.resolve(asked));
    if (owner == appearances_.end()) continue;
    auto& views = owner->second.views;
    const auto view = std::find_if(views.begin(), views.end(), [&](const ObjectView& candidate) {
      return candidate.ticket == answer.ticket;
    });
    if (view == views.end()) continue;  // a better one took its place meanwhile
    view->embedding = std::move(answer.embedding);
    view->crop = std::move(answer.crop);
    // Views drawn at random may yet be thrown out: which crops stay is settled in the end.
    if (config_.views.strategy != ViewStrategy::kRandom)
      prune_crops(owner->second, config_.crops.kept_views);
  }
}

}  // namespace ovimap
