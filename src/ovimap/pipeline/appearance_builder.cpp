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

namespace {

/// Gives a view what the encoder answered. Views drawn at random may yet be thrown out: which crops
/// stay is settled in the end.
void fill_view(ObjectView& view, EmbeddingAnswer answer, const SemanticsConfig& config,
               Appearance& appearance) {
  view.embedding = std::move(answer.embedding);
  view.crop = std::move(answer.crop);
  if (config.views.strategy != ViewStrategy::kRandom)
    prune_crops(appearance, config.crops.kept_views);
}

ObjectView* find_view(Appearance& appearance, std::uint64_t ticket) {
  const auto found = std::find_if(appearance.views.begin(), appearance.views.end(),
                                  [&](const ObjectView& view) { return view.ticket == ticket; });
  return found == appearance.views.end() ? nullptr : &*found;
}

}  // namespace

PendingAppearances::PendingAppearances(
    Appearances appearances, const std::unordered_map<std::uint64_t, InstanceId>& asked_for,
    const SemanticsConfig& config)
    : config_(config), appearances_(std::move(appearances)) {
  for (const auto& [ticket, id] : asked_for) open_.insert(ticket);
  for (const auto& [id, appearance] : appearances_)
    for (const ObjectView& view : appearance.views)
      if (asked_for.contains(view.ticket)) owners_[view.ticket] = id;
}

void PendingAppearances::apply(const EmbeddingAnswer& answer) {
  if (open_.erase(answer.ticket) == 0) return;  // asked later
  const auto owner = owners_.find(answer.ticket);
  if (owner == owners_.end()) return;  // a better view had taken its place
  Appearance& appearance = appearances_.at(owner->second);
  if (ObjectView* view = find_view(appearance, answer.ticket))
    fill_view(*view, answer, config_, appearance);
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

void AppearanceBuilder::catch_up(const InstanceRegistry& registry) {
  apply(queue_.finish(), registry);
}

void AppearanceBuilder::finish(const InstanceRegistry& registry) {
  catch_up(registry);
  for (auto& [id, appearance] : appearances_) prune_crops(appearance, config_.crops.kept_views);
}

std::shared_ptr<PendingAppearances> AppearanceBuilder::remember() {
  return remembered_ = std::make_shared<PendingAppearances>(appearances_, asked_for_, config_);
}

void AppearanceBuilder::apply(std::vector<EmbeddingAnswer> answers,
                              const InstanceRegistry& registry) {
  follow_merges(appearances_, registry);
  for (EmbeddingAnswer& answer : answers) {
    if (encoder_) durations_ms_.push_back(answer.milliseconds);
    if (remembered_) remembered_->apply(answer);
    const InstanceId asked = asked_for_.extract(answer.ticket).mapped();
    const auto owner = appearances_.find(registry.resolve(asked));
    if (owner == appearances_.end()) continue;
    ObjectView* view = find_view(owner->second, answer.ticket);
    if (!view) continue;  // a better one took its place meanwhile
    fill_view(*view, std::move(answer), config_, owner->second);
  }
}

}  // namespace ovimap
