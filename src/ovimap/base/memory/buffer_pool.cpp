// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/memory/buffer_pool.h"

#include <mutex>
#include <new>
#include <unordered_map>
#include <vector>

namespace ovimap::detail {

namespace {

// Sanitizers watch what is freed; a pool would hide it from them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kMostHeld = 0;
#else
constexpr std::size_t kMostHeld = 64 << 20;
#endif
constexpr std::size_t kLeastPooled = 64 << 10;  // the C library is quick with smaller ones

class Pool {
 public:
  void* take(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    const auto found = free_.find(bytes);
    if (found == free_.end() || found->second.empty()) return nullptr;
    void* buffer = found->second.back();
    found->second.pop_back();
    held_ -= bytes;
    return buffer;
  }

  bool give(void* buffer, std::size_t bytes) noexcept {
    if (bytes > kMostHeld) return false;
    const std::lock_guard lock(mutex_);
    if (held_ + bytes > kMostHeld) clear();  // sizes that nobody asks for any more, as a rule
    try {
      free_[bytes].push_back(buffer);
    } catch (const std::bad_alloc&) {
      return false;
    }
    held_ += bytes;
    return true;
  }

 private:
  void clear() noexcept {
    for (auto& [bytes, buffers] : free_)
      for (void* buffer : buffers) ::operator delete(buffer);
    free_.clear();
    held_ = 0;
  }

  std::mutex mutex_;
  std::unordered_map<std::size_t, std::vector<void*>> free_;
  std::size_t held_ = 0;
};

/// Never destroyed: images may outlive every other object.
Pool& pool() {
  static Pool* const instance = new Pool;
  return *instance;
}

}  // namespace

void* take_buffer(std::size_t bytes) {
  if (bytes >= kLeastPooled)
    if (void* buffer = pool().take(bytes)) return buffer;
  return ::operator new(bytes);
}

void give_buffer(void* buffer, std::size_t bytes) noexcept {
  if (bytes < kLeastPooled || !pool().give(buffer, bytes)) ::operator delete(buffer);
}

}  // namespace ovimap::detail
