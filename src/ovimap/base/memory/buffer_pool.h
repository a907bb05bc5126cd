// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace ovimap {

namespace detail {
void* take_buffer(std::size_t bytes);
void give_buffer(void* buffer, std::size_t bytes) noexcept;
}  // namespace detail

/// An array of numbers or pixels whose memory goes to the next of the same size. A frame's images
/// are as large as those of the frame before; the C library hands such memory back to the system
/// each time, and mapping it anew costs more than the work on it. Holds at most 64 MiB;
/// thread-safe. (A std::vector with an allocator of its own would walk through all pixels to
/// destroy nothing.)
template <class T>
class PooledBuffer {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  PooledBuffer() = default;
  /// What is made without a value stays as memory had it, where its type allows that. (Values that
  /// are copied as bytes begin to live with their memory, whatever their constructors do.)
  explicit PooledBuffer(std::size_t count) : PooledBuffer(Room{count}) {
    if constexpr (!std::is_trivially_copyable_v<T>)
      std::uninitialized_default_construct_n(data_, count);
  }
  PooledBuffer(std::size_t count, const T& value) : PooledBuffer(Room{count}) {
    std::uninitialized_fill_n(data_, count, value);
  }
  PooledBuffer(const PooledBuffer& other) : PooledBuffer(Room{other.size_}) {
    std::uninitialized_copy_n(other.data_, size_, data_);
  }
  PooledBuffer(PooledBuffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  PooledBuffer& operator=(PooledBuffer other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }
  ~PooledBuffer() {
    if (data_ != nullptr) detail::give_buffer(data_, size_ * sizeof(T));
  }

  std::size_t size() const { return size_; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  bool operator==(const PooledBuffer& other) const {
    return std::equal(begin(), end(), other.begin(), other.end());
  }

 private:
  struct Room {
    std::size_t count;
  };
  explicit PooledBuffer(Room room) : size_(room.count) {
    if (size_ > std::numeric_limits<std::size_t>::max() / sizeof(T))
      throw std::bad_array_new_length();
    if (size_ > 0) data_ = static_cast<T*>(detail::take_buffer(size_ * sizeof(T)));
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace ovimap
