// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ovimap {

/// A binary mask as bits, so that overlaps of whole masks are a few hundred word operations.
class BitMask {
 public:
  BitMask() = default;
  BitMask(int width, int height)
      : width_(width),
        height_(height),
        words_((static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + 63) / 64) {}

  int width() const { return width_; }
  int height() const { return height_; }

  bool at(int x, int y) const { return words_[index(x, y) / 64] >> (index(x, y) % 64) & 1; }
  void set(int x, int y) { words_[index(x, y) / 64] |= std::uint64_t{1} << (index(x, y) % 64); }
  void clear(int x, int y) {
    words_[index(x, y) / 64] &= ~(std::uint64_t{1} << (index(x, y) % 64));
  }

  int count() const {
    int bits = 0;
    for (const std::uint64_t word : words_) bits += std::popcount(word);
    return bits;
  }
  /// Pixels set in both; the masks have one size.
  int overlap(const BitMask& other) const {
    int bits = 0;
    for (std::size_t i = 0; i < words_.size(); ++i)
      bits += std::popcount(words_[i] & other.words_[i]);
    return bits;
  }
  BitMask& operator|=(const BitMask& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
    return *this;
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_ = 0, height_ = 0;
  std::vector<std::uint64_t> words_;
};

}  // namespace ovimap
