// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <new>

namespace ovimap {

namespace detail {
void* take_buffer(std::size_t bytes);
void give_buffer(void* buffer, std::size_t bytes) noexcept;
}  // namespace detail

/// Allocator that keeps large buffers for the next of the same size. A frame's images are as large
/// as those of the frame before; the C library hands such memory back to the system each time, and
/// mapping it anew costs more than the work on it. Holds at most 64 MiB; thread-safe.
template <class T>
struct PooledAllocator {
  using value_type = T;
  PooledAllocator() = default;
  template <class Other>
  PooledAllocator(const PooledAllocator<Other>&) noexcept {}

  T* allocate(std::size_t count) { return static_cast<T*>(detail::take_buffer(count * sizeof(T))); }
  void deallocate(T* buffer, std::size_t count) noexcept {
    detail::give_buffer(buffer, count * sizeof(T));
  }
  /// What is added without a value stays as memory had it, where its type allows that.
  template <class Other>
  void construct(Other* item) {
    ::new (static_cast<void*>(item)) Other;
  }
  template <class Other>
  bool operator==(const PooledAllocator<Other>&) const noexcept {
    return true;
  }
};

}  // namespace ovimap
