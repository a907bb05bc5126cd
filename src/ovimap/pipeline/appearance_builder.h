// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "ovimap/frames/frame.h"
#include "ovimap/pipeline/embedding_queue.h"
#include "ovimap/semantics/view_selection.h"

namespace ovimap {

/// Everything about how objects get their embeddings.
struct SemanticsConfig {
  ViewSelectionConfig views;
  CropConfig crops;
  EmbeddingQueueConfig queue;
};
void list_fields(SemanticsConfig& config, ConfigFields& fields);

/// What objects look like at one moment of the mapping, some of it still with the encoder.
class PendingAppearances {
 public:
  /// `asked_for`: the open tickets.
  PendingAppearances(Appearances appearances,
                     const std::unordered_map<std::uint64_t, InstanceId>& asked_for,
                     const SemanticsConfig& config);

  void apply(const EmbeddingAnswer& answer);
  /// Whether the encoder has answered all of it.
  bool complete() const { return open_.empty(); }
  Appearances take() { return std::move(appearances_); }

 private:
  SemanticsConfig config_;
  Appearances appearances_;
  std::unordered_map<std::uint64_t, InstanceId> owners_;  ///< of views with open tickets
  std::unordered_set<std::uint64_t> open_;                ///< tickets
};

/// Gathers what objects look like while a map is built: chooses views, cuts them out, has them
/// embedded beside the mapping, and follows the registry's merges. What comes out does not depend
/// on how fast the encoder is.
class AppearanceBuilder {
 public:
  /// `encoder` may be null: then only crops are kept, which can be embedded later.
  AppearanceBuilder(const SemanticsConfig& config, std::shared_ptr<ImageTextEncoder> encoder);

  /// Throws what the encoder threw since the last report, once; its views stay without embedding.
  void rethrow_failure() { queue_.rethrow_failure(); }
  /// From now on what the encoder throws is counted alone.
  void forgive_encoder() { queue_.forgive_failures(); }
  EncoderFailures encoder_failures() const { return queue_.failures(); }
  /// Chooses and cuts out views of one frame; returns how many.
  int choose(const Frame& frame, const SeenObjects& seen, const InstanceRegistry& registry);
  /// Hands the chosen views to the encoder; `wait`: not before it has room for them.
  void submit(bool wait = true);
  /// Whether the encoder's queue is at most half full.
  bool keeps_up() const { return 2 * queue_.waiting() <= config_.queue.capacity; }

  /// Waits until the encoder has answered for every view handed to it. Throws as rethrow_failure.
  void catch_up(const InstanceRegistry& registry);
  /// The same for every chosen view, after the last frame; called again, it does not throw.
  void finish(const InstanceRegistry& registry);
  /// All that was gathered; call finish() first.
  Appearances take() { return std::move(appearances_); }

  /// What is gathered by now: views that the encoder has not answered have no embedding yet.
  const Appearances& appearances() const { return appearances_; }

  /// The present moment, to be stored: what the encoder answers later still comes to it while views
  /// are chosen. One at a time.
  std::shared_ptr<PendingAppearances> remember();
  /// Goes on where another builder stopped.
  void restore(Appearances appearances) { appearances_ = std::move(appearances); }

  /// What the encoder took for each view since the last call.
  std::vector<double> take_durations_ms() { return std::exchange(durations_ms_, {}); }

  const std::shared_ptr<ImageTextEncoder>& encoder() const { return encoder_; }
  const SemanticsConfig& config() const { return config_; }

 private:
  void apply(std::vector<EmbeddingAnswer> answers, const InstanceRegistry& registry);

  SemanticsConfig config_;
  std::shared_ptr<ImageTextEncoder> encoder_;
  ViewSelector selector_;
  Appearances appearances_;
  std::vector<EmbeddingRequest> chosen_;
  std::unordered_map<std::uint64_t, InstanceId> asked_for_;  ///< open tickets
  std::shared_ptr<PendingAppearances> remembered_;
  std::vector<double> durations_ms_;
  EmbeddingQueue queue_;
};

}  // namespace ovimap
