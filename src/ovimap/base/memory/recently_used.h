// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace ovimap {

/// Values that were costly to make, by key, up to so many bytes; those that nobody asked for the
/// longest go first. Thread-safe.
template <class Key, class Value>
class RecentlyUsed {
 public:
  explicit RecentlyUsed(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  std::optional<Value> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto known = places_.find(key);
    if (known == places_.end()) return std::nullopt;
    entries_.splice(entries_.begin(), entries_, known->second);
    return known->second->value;
  }

  /// `bytes`: what keeping it costs. Of two that were made at once the first stays.
  void keep(const Key& key, Value value, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    if (places_.contains(key)) return;
    entries_.push_front({key, std::move(value), bytes});
    places_.emplace(key, entries_.begin());
    for (bytes_ += bytes; bytes_ > max_bytes_; entries_.pop_back()) {
      bytes_ -= entries_.back().bytes;
      places_.erase(entries_.back().key);
    }
  }

 private:
  struct Entry {
    Key key;
    Value value;
    std::size_t bytes;
  };
  const std::size_t max_bytes_;
  std::mutex mutex_;          ///< guards what follows
  std::list<Entry> entries_;  ///< latest first
  std::size_t bytes_ = 0;
  std::map<Key, typename std::list<Entry>::iterator> places_;
};

}  // namespace ovimap
