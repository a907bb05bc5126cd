// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/appearance_builder.h"

#include <algorithm>
#include <utility>

#include "ovimap/base/config.h"
#include "ovimap/image/resize.h"

namespace ovimap {

void list_fields(SemanticsConfig& config, ConfigFields& fields) {
  fields.group("views", [&](ConfigFields& f) { list_fields(config.views, f); });
  fields.group("telling", [&](ConfigFields& f) { list_fields(config.telling, f); });
  fields.group("crops", [&](ConfigFields& f) { list_fields(config.crops, f); });
  fields.group("embedding", [&](ConfigFields& f) { list_fields(config.queue, f); });
}

namespace {

constexpr int kPictureSide_px = 640;  // as much as a recognizer of things sees

/// The frame's picture, for a recognizer; shrunk, since several may wait.
std::shared_ptr<const RgbImage> picture_of(const Frame& frame) {
  const int longer = std::max(frame.color.width(), frame.color.height());
  if (longer <= kPictureSide_px) return std::make_shared<const RgbImage>(frame.color);
  const auto shrunk = [&](int side) { return std::max(1, side * kPictureSide_px / longer); };
  return std::make_shared<const RgbImage>(resize_filtered(frame.color, shrunk(frame.color.width()),
                                                          shrunk(frame.color.height()),
                                                          ResizeFilter::kBilinear));
}

/// Gives a view what the encoder answered. Views drawn at random may yet be thrown out: which crops
/// stay is settled in the end.
void fill_view(EmbeddingAnswer answer, const SemanticsConfig& config, SuperPointLook& look) {
  ObjectView* view = find_view(look, answer.view);
  if (!view) return;  // a better one took its place meanwhile
  view->embedding = std::move(answer.embedding);
  view->crop = std::move(answer.crop);
  view->things = std::move(answer.things);
  if (config.views.strategy != ViewStrategy::kRandom) prune_crops(look, config.crops.kept_views);
}

}  // namespace

PendingLooks::PendingLooks(SuperPointLooks looks, const LabelForest& forest,
                           const std::set<ViewKey>& asked_for, const SemanticsConfig& config)
    : config_(config), looks_(std::move(looks)) {
  for (const ViewKey& key : asked_for) open_[key] = forest.root(key.super_point);
}

void PendingLooks::apply(const EmbeddingAnswer& answer) {
  const auto asked = open_.extract(answer.view);
  if (asked.empty()) return;  // asked later
  if (const auto look = looks_.find(asked.mapped()); look != looks_.end())
    fill_view(answer, config_, look->second);
}

AppearanceBuilder::AppearanceBuilder(const SemanticsConfig& config,
                                     std::shared_ptr<ImageTextEncoder> encoder)
    : config_(config),
      encoder_(std::move(encoder)),
      selector_(config.views),
      queue_(config.queue, config.crops, encoder_) {}

void AppearanceBuilder::recognize_with(std::shared_ptr<const ThingRecognizer> recognizer) {
  recognizer_ = recognizer;
  queue_.recognize_with(std::move(recognizer));
}

RecognizerIdentity AppearanceBuilder::recognizer() const {
  return recognizer_ ? recognizer_->identity() : RecognizerIdentity{};
}

int AppearanceBuilder::choose(const Frame& frame, const SeenObjects& seen,
                              const InstanceRegistry& registry, const LabelForest& forest) {
  take_answers(forest);
  std::shared_ptr<const RgbImage> picture;
  TellingPixels telling(frame, config_.telling);
  for (ChosenView& chosen : selector_.select(seen, registry, looks_)) {
    auto crop = cut_object(frame, {seen.color_index, seen.instances, chosen.id, chosen.box_px},
                           config_.crops);
    if (!crop) continue;  // what has no picture has not been looked at
    const bool first = appearance_of(looks_, registry.super_points_of(chosen.id)).views.empty();
    if (!telling.weigh(chosen.view, *crop, first)) continue;
    const ViewKey key = chosen.view.key();
    selector_.commit(std::move(chosen), forest, looks_);
    asked_for_.insert(key);
    if (recognizer_ && !picture) picture = picture_of(frame);
    chosen_.push_back({key, std::move(*crop), picture});
  }
  return static_cast<int>(chosen_.size());
}

void AppearanceBuilder::submit(bool wait) {
  queue_.submit(std::exchange(chosen_, {}), wait);
}

void AppearanceBuilder::catch_up(const LabelForest& forest) {
  apply(queue_.finish(), forest);
}

void AppearanceBuilder::finish(const LabelForest& forest) {
  catch_up(forest);
  for (auto& [label, look] : looks_) prune_crops(look, config_.crops.kept_views);
}

std::shared_ptr<PendingLooks> AppearanceBuilder::remember(const LabelForest& forest) {
  follow(forest);
  return remembered_ = std::make_shared<PendingLooks>(looks_, forest, asked_for_, config_);
}

void AppearanceBuilder::follow(const LabelForest& forest) {
  if (followed_ == forest.epoch()) return;
  follow_merges(looks_, forest);
  followed_ = forest.epoch();
}

void AppearanceBuilder::apply(std::vector<EmbeddingAnswer> answers, const LabelForest& forest) {
  follow(forest);
  for (EmbeddingAnswer& answer : answers) {
    if (encoder_) durations_ms_.push_back(answer.milliseconds);
    if (remembered_) remembered_->apply(answer);
    asked_for_.erase(answer.view);
    const auto look = looks_.find(forest.root(answer.view.super_point));
    if (look != looks_.end()) fill_view(std::move(answer), config_, look->second);
  }
}

}  // namespace ovimap
