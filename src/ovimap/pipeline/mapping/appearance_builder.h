// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "ovimap/frames/frame/frame.h"
#include "ovimap/pipeline/mapping/embedding_queue.h"
#include "ovimap/semantics/views/telling_pixels.h"
#include "ovimap/semantics/views/view_selection.h"

namespace ovimap {

/// Everything about how objects get their embeddings.
struct SemanticsConfig {
  ViewSelectionConfig views;
  TellingConfig telling;
  CropConfig crops;
  EmbeddingQueueConfig queue;
};
void list_fields(SemanticsConfig& config, ConfigFields& fields);

/// What super-points look like at one moment of the mapping, some of it still with the encoder.
class PendingLooks {
 public:
  /// `asked_for`: views that the encoder has yet to answer for.
  PendingLooks(SuperPointLooks looks, const LabelForest& forest, const std::set<ViewKey>& asked_for,
               const SemanticsConfig& config);

  void apply(const EmbeddingAnswer& answer);
  /// Whether the encoder has answered all of it.
  bool complete() const { return open_.empty(); }
  SuperPointLooks take() { return std::move(looks_); }

 private:
  SemanticsConfig config_;
  SuperPointLooks looks_;
  std::map<ViewKey, Label> open_;  ///< with the roots that they belong to
};

/// Gathers what objects look like while a map is built: chooses views, cuts them out, and has them
/// embedded beside the mapping. Views are kept by super-point, so that they go with it whichever
/// object it is taken for. What comes out does not depend on how fast the encoder is.
///
/// `forest` is always that of the map, whose labels only ever merge.
class AppearanceBuilder {
 public:
  /// `encoder` may be null: then only crops are kept, which can be embedded later.
  AppearanceBuilder(const SemanticsConfig& config, std::shared_ptr<ImageTextEncoder> encoder);

  /// From now on views are shown to it too. Null: to none.
  void recognize_with(std::shared_ptr<const ThingRecognizer> recognizer);
  /// Of what recognizes things in the views.
  RecognizerIdentity recognizer() const;

  /// Throws what the encoder threw since the last report, once; its views stay without embedding.
  void rethrow_failure() { queue_.rethrow_failure(); }
  /// From now on what the encoder throws is counted alone.
  void forgive_encoder() { queue_.forgive_failures(); }
  EncoderFailures encoder_failures() const { return queue_.failures(); }
  /// Chooses and cuts out views of one frame; returns how many.
  int choose(const Frame& frame, const SeenObjects& seen, const InstanceRegistry& registry,
             const LabelForest& forest);
  /// Hands the chosen views to the encoder; `wait`: not before it has room for them.
  void submit(bool wait = true);
  /// Whether the encoder's queue is at most half full.
  bool keeps_up() const { return 2 * queue_.waiting() <= config_.queue.capacity; }

  /// Takes in what the encoder has answered by now.
  void take_answers(const LabelForest& forest) { apply(queue_.take(), forest); }
  /// Waits until the encoder has answered for every view handed to it. Throws as rethrow_failure.
  void catch_up(const LabelForest& forest);
  /// The same for every chosen view, after the last frame; called again, it does not throw.
  void finish(const LabelForest& forest);
  /// All that was gathered; call finish() first.
  SuperPointLooks take() { return std::move(looks_); }

  /// What is gathered by now: views that the encoder has not answered have no embedding yet.
  const SuperPointLooks& looks() const { return looks_; }

  /// The present moment, to be stored: what the encoder answers later still comes to it while views
  /// are chosen. One at a time.
  std::shared_ptr<PendingLooks> remember(const LabelForest& forest);
  /// Goes on where another builder stopped.
  void restore(SuperPointLooks looks) { looks_ = std::move(looks); }

  /// What the encoder took for each view since the last call.
  std::vector<double> take_durations_ms() { return std::exchange(durations_ms_, {}); }

  const std::shared_ptr<ImageTextEncoder>& encoder() const { return encoder_; }
  const SemanticsConfig& config() const { return config_; }

 private:
  void apply(std::vector<EmbeddingAnswer> answers, const LabelForest& forest);
  void follow(const LabelForest& forest);

  SemanticsConfig config_;
  std::shared_ptr<ImageTextEncoder> encoder_;
  std::shared_ptr<const ThingRecognizer> recognizer_;
  ViewSelector selector_;
  SuperPointLooks looks_;
  std::uint32_t followed_ = 0;  ///< the forest's epoch that `looks_` agree with
  std::vector<EmbeddingRequest> chosen_;
  std::set<ViewKey> asked_for_;  ///< and not answered
  std::shared_ptr<PendingLooks> remembered_;
  std::vector<double> durations_ms_;
  EmbeddingQueue queue_;
};

}  // namespace ovimap
