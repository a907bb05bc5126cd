// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/mapping/embedding_queue.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "ovimap/base/config.h"
#include "ovimap/base/thread_priority.h"
#include "ovimap/semantics/views/object_embedding.h"

namespace ovimap {

namespace {

std::string message_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& fault) {
    return fault.what();
  } catch (...) {
    return "no reason given";
  }
}

}  // namespace

void list_fields(EmbeddingQueueConfig& config, ConfigFields& fields) {
  fields.add("capacity", config.capacity, 1, 1000000,
             "views that wait for the encoder at most; then the mapper waits");
  fields.add("batch", config.batch, 1, 1024, "views embedded at once");
}

EmbeddingQueue::EmbeddingQueue(const EmbeddingQueueConfig& config, const CropConfig& crops,
                               std::shared_ptr<ImageTextEncoder> encoder)
    : config_(config), crops_(crops), encoder_(std::move(encoder)), worker_([this] { work(); }) {}

EmbeddingQueue::~EmbeddingQueue() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  worker_.join();
}

void EmbeddingQueue::recognize_with(std::shared_ptr<const ThingRecognizer> recognizer) {
  const std::lock_guard lock(mutex_);
  recognizer_ = std::move(recognizer);
}

int EmbeddingQueue::waiting() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(waiting_.size());
}

void EmbeddingQueue::submit(std::vector<EmbeddingRequest> requests, bool wait) {
  for (EmbeddingRequest& request : requests) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] {
      return !wait || waiting_.size() < static_cast<std::size_t>(config_.capacity);
    });
    waiting_.push_back(std::move(request));
    lock.unlock();
    changed_.notify_all();
  }
}

std::vector<EmbeddingAnswer> EmbeddingQueue::take() {
  const std::lock_guard lock(mutex_);
  if (failure_) return {};
  return std::exchange(answered_, {});
}

std::vector<EmbeddingAnswer> EmbeddingQueue::finish() {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return waiting_.empty() && under_way_ == 0; });
  }
  rethrow_failure();
  return take();
}

void EmbeddingQueue::rethrow_failure() {
  const std::unique_lock lock(mutex_);
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void EmbeddingQueue::forgive_failures() {
  const std::lock_guard lock(mutex_);
  forgiving_ = true;
  failure_ = nullptr;
}

EncoderFailures EmbeddingQueue::failures() const {
  const std::lock_guard lock(mutex_);
  return failures_;
}

/// With the lock held.
void EmbeddingQueue::note_failure(std::exception_ptr failure, std::size_t views) {
  if (failures_.views == 0) failures_.first = message_of(failure);
  failures_.views += static_cast<std::int64_t>(views);
  if (!forgiving_ && !failure_) failure_ = std::move(failure);
}

void EmbeddingQueue::work() {
  lower_thread_priority();
  while (true) {
    std::vector<EmbeddingRequest> batch;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stop_ || !waiting_.empty(); });
      if (stop_) return;
      under_way_ = std::min(waiting_.size(), static_cast<std::size_t>(config_.batch));
      for (std::size_t i = 0; i < under_way_; ++i) {
        batch.push_back(std::move(waiting_.front()));
        waiting_.pop_front();
      }
    }
    changed_.notify_all();
    std::vector<EmbeddingAnswer> answers;
    std::exception_ptr failure;
    for (ImageTextEncoder* encoder : {encoder_.get(), static_cast<ImageTextEncoder*>(nullptr)}) {
      try {
        answers = answer(batch, encoder);
        break;
      } catch (...) {  // then without it: the crops can be embedded later
        if (!failure) failure = std::current_exception();
      }
    }
    std::vector<Eigen::VectorXf> things;
    try {
      things = recognize(batch);
    } catch (...) {  // then by the encoder alone
      if (!failure) failure = std::current_exception();
    }
    for (std::size_t i = 0; i < std::min(things.size(), answers.size()); ++i)
      answers[i].things = std::move(things[i]);
    {
      const std::lock_guard lock(mutex_);
      std::move(answers.begin(), answers.end(), std::back_inserter(answered_));
      under_way_ = 0;
      if (failure) note_failure(std::move(failure), batch.size());
    }
    changed_.notify_all();
  }
}

std::vector<Eigen::VectorXf> EmbeddingQueue::recognize(const std::vector<EmbeddingRequest>& batch) {
  std::shared_ptr<const ThingRecognizer> recognizer;
  {
    const std::lock_guard lock(mutex_);
    recognizer = recognizer_;
  }
  if (!recognizer) return {};
  std::vector<Eigen::VectorXf> things(batch.size());
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (!batch[i].picture || batch[i].crop.in_frame.isEmpty()) continue;
    if (batch[i].picture != seen_picture_) {
      seen_things_ = recognizer->look(*batch[i].picture);
      seen_picture_ = batch[i].picture;
    }
    things[i] = seen_things_->log_ratios(batch[i].crop.in_frame);
  }
  return things;
}

std::vector<EmbeddingAnswer> EmbeddingQueue::answer(const std::vector<EmbeddingRequest>& batch,
                                                    ImageTextEncoder* encoder) const {
  std::vector<const ObjectCrop*> objects;
  for (const EmbeddingRequest& request : batch) objects.push_back(&request.crop);
  std::vector<Eigen::VectorXf> embeddings(batch.size());
  const auto start = std::chrono::steady_clock::now();
  if (encoder) embeddings = embed_objects(*encoder, objects, crops_);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  const double each_ms = encoder ? taken.count() / static_cast<double>(batch.size()) : 0;
  std::vector<EmbeddingAnswer> answers;
  for (std::size_t i = 0; i < batch.size(); ++i)
    answers.push_back({batch[i].view, std::move(embeddings[i]),
                       crops_.kept_views > 0 ? store_crop(batch[i].crop, crops_) : StoredCrop{},
                       each_ms});
  return answers;
}

}  // namespace ovimap
