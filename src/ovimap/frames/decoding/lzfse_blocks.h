// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ovimap/base/error.h"

namespace ovimap::lzfse {

using Input = std::span<const std::uint8_t>;

[[noreturn]] inline void fail_broken() {
  throw Error("is broken LZFSE data");
}

/// The first `count` bytes, which are taken off the input.
inline Input take(Input& input, std::size_t count) {
  if (count > input.size()) fail_broken();
  const Input taken = input.first(count);
  input = input.subspan(count);
  return taken;
}

/// A little-endian number, taken off the input.
template <class Number>
Number take_number(Input& input) {
  const Input bytes = take(input, sizeof(Number));
  Number number = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    number |= static_cast<Number>(static_cast<Number>(bytes[i]) << (8 * i));
  return number;
}

/// What was decompressed so far; matches repeat parts of it.
class Output {
 public:
  explicit Output(std::size_t max_size) : max_size_(max_size) {}

  std::size_t size() const { return bytes_.size(); }
  std::vector<std::uint8_t> release() { return std::move(bytes_); }

  void append(Input literals) {
    reserve(literals.size());
    bytes_.insert(bytes_.end(), literals.begin(), literals.end());
  }
  /// Source and target may overlap: then the repeated part repeats itself.
  void repeat(std::size_t distance, std::size_t length) {
    if (length == 0) return;
    if (distance == 0 || distance > bytes_.size()) fail_broken();
    reserve(length);
    std::size_t from = bytes_.size() - distance;
    for (std::size_t i = 0; i < length; ++i) bytes_.push_back(bytes_[from++]);
  }

 private:
  void reserve(std::size_t more) const {
    if (more > max_size_ - bytes_.size())
      throw Error(concat("holds more than the expected ", max_size_, " bytes"));
  }

  std::vector<std::uint8_t> bytes_;
  std::size_t max_size_;
};

/// Decodes one block from behind its four letters and takes it off the input.
void decode_entropy_block(Input& input, Output& output);  ///< bvx2
void decode_lzvn_block(Input& input, Output& output);     ///< bvxn

}  // namespace ovimap::lzfse
