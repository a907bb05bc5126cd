// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/surface/kept_bytes.h"

#include <utility>

namespace ovimap {

KeptBytes::Bytes KeptBytes::find(std::uint64_t key) {
  const std::lock_guard lock(mutex_);
  const auto found = place_.find(key);
  if (found == place_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->bytes;
}

void KeptBytes::keep(std::uint64_t key, Bytes bytes) {
  const std::lock_guard lock(mutex_);
  if (place_.contains(key)) return;  // another thread made the same
  bytes_ += bytes->size();
  entries_.push_front({key, std::move(bytes)});
  place_[key] = entries_.begin();
  for (; bytes_ > max_bytes_; entries_.pop_back()) {
    bytes_ -= entries_.back().bytes->size();
    place_.erase(entries_.back().key);
  }
}

}  // namespace ovimap
