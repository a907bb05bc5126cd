// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ovimap/inference/encoders/image_text_encoder.h"
#include "ovimap/semantics/views/appearance.h"

namespace ovimap {

class ConfigFields;

struct EmbeddingQueueConfig {
  int capacity = 64;  ///< views that wait at most; a mapper that is faster waits for the encoder
  int batch = 4;      ///< views embedded at once, whatever object they show
};
void list_fields(EmbeddingQueueConfig& config, ConfigFields& fields);

/// A view to be embedded. It owns its pixels: however late the encoder comes to it, no other frame
/// can be seen.
struct EmbeddingRequest {
  ViewKey view;
  ObjectCrop crop;
  std::shared_ptr<const RgbImage> picture =
      nullptr;  ///< of the frame, for the recognizer; null: none
};

struct EmbeddingAnswer {
  ViewKey view;
  Eigen::VectorXf embedding;    ///< empty without an encoder, or when it gave nothing finite
  StoredCrop crop;              ///< empty when CropConfig::kept_views is 0
  double milliseconds = 0;      ///< its share of the batch's time; 0 without an encoder
  Eigen::VectorXf things = {};  ///< log ratios; empty without a recognizer
};

/// What an encoder threw, all told.
struct EncoderFailures {
  std::int64_t views = 0;  ///< that stay without embedding for it
  std::string first;       ///< its message
};

/// Embeds views on a thread of its own that lets the mapper go first, in the order they come. When
/// the encoder throws, the views it was given stay without embedding, and the next ones are tried.
class EmbeddingQueue {
 public:
  /// Without an encoder, crops are only packed for the map.
  EmbeddingQueue(const EmbeddingQueueConfig& config, const CropConfig& crops,
                 std::shared_ptr<ImageTextEncoder> encoder);
  /// What still waits is dropped.
  ~EmbeddingQueue();

  /// From now on views are shown to it too.
  void recognize_with(std::shared_ptr<const ThingRecognizer> recognizer);

  /// `wait`: blocks while the queue is full; else it holds more than its capacity for once.
  void submit(std::vector<EmbeddingRequest> requests, bool wait = true);
  /// Views that no work has begun on.
  int waiting() const;
  /// What has been answered since the last call, in the order of submission; nothing while what the
  /// encoder threw is not reported.
  std::vector<EmbeddingAnswer> take();
  /// Waits for everything, then the same. Throws as rethrow_failure; called again, it does not.
  std::vector<EmbeddingAnswer> finish();
  /// Throws the first thing the encoder threw since the last report, once.
  void rethrow_failure();
  /// From now on what the encoder throws is counted alone.
  void forgive_failures();
  EncoderFailures failures() const;

 private:
  void work();
  void note_failure(std::exception_ptr failure, std::size_t views);
  std::vector<EmbeddingAnswer> answer(const std::vector<EmbeddingRequest>& batch,
                                      ImageTextEncoder* encoder) const;
  /// Log ratios of each view; empty ones without recognizer. Views of one frame share one look.
  std::vector<Eigen::VectorXf> recognize(const std::vector<EmbeddingRequest>& batch);

  EmbeddingQueueConfig config_;
  CropConfig crops_;
  std::shared_ptr<ImageTextEncoder> encoder_;
  std::shared_ptr<const RgbImage> seen_picture_;  ///< the last one, and what is in it
  std::unique_ptr<const ThingsInPicture> seen_things_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const ThingRecognizer> recognizer_;
  std::deque<EmbeddingRequest> waiting_;
  std::vector<EmbeddingAnswer> answered_;
  std::size_t under_way_ = 0;
  bool stop_ = false, forgiving_ = false;
  std::exception_ptr failure_;
  EncoderFailures failures_;
  std::thread worker_;  // last: it starts when everything else is there
};

}  // namespace ovimap
