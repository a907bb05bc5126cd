// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace ovimap {

/// Answers that were costly to make, by key, up to a bound; those that nobody asked for the longest
/// time go first. Thread-safe.
class KeptBytes {
 public:
  using Bytes = std::shared_ptr<const std::string>;
  explicit KeptBytes(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Null when there is none.
  Bytes find(std::uint64_t key);
  void keep(std::uint64_t key, Bytes bytes);

 private:
  struct Entry {
    std::uint64_t key;
    Bytes bytes;
  };
  const std::size_t max_bytes_;
  std::mutex mutex_;          ///< guards what follows
  std::list<Entry> entries_;  ///< latest first
  std::map<std::uint64_t, std::list<Entry>::iterator> place_;
  std::size_t bytes_ = 0;
};

}  // namespace ovimap
