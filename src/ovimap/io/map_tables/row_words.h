// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Numbers in the blobs of rows: little-endian.

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "ovimap/image/codec.h"
#include "ovimap/io/map_tables/map_file_rows.h"

namespace ovimap {

template <class Word>
void append_word(Bytes& bytes, Word word) {
  for (std::size_t i = 0; i < sizeof(Word); ++i)
    bytes.push_back(static_cast<std::uint8_t>(word >> 8 * i));
}

inline Bytes label_bytes(std::span<const Label> labels) {
  Bytes bytes;
  for (const Label label : labels) append_word(bytes, label);
  return bytes;
}

inline void append_float(Bytes& bytes, float value) {
  append_word(bytes, std::bit_cast<std::uint32_t>(value));
}

/// Lower corner, then upper one.
inline void append_box(Bytes& bytes, const Eigen::AlignedBox3f& box) {
  for (const Eigen::Vector3f& corner : {box.min(), box.max()})
    for (const float coordinate : corner) append_float(bytes, coordinate);
}

template <class Word>
std::vector<Word> words_of(std::span<const std::uint8_t> bytes, const RowReader& rows) {
  if (bytes.size() % sizeof(Word) != 0) rows.fail(concat("has a list of ", bytes.size(), " bytes"));
  static_assert(std::endian::native == std::endian::little);
  std::vector<Word> words(bytes.size() / sizeof(Word));
  if (!words.empty()) std::memcpy(words.data(), bytes.data(), bytes.size());
  return words;
}

inline constexpr std::size_t kBoxBytes = 24;

/// Whatever the corners are. `bytes`: kBoxBytes of them.
inline Eigen::AlignedBox3f box_of_words(std::span<const std::uint8_t> bytes,
                                        const RowReader& rows) {
  const auto words = words_of<std::uint32_t>(bytes, rows);
  Eigen::AlignedBox3f box;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto word = static_cast<std::size_t>(axis);
    box.min()[axis] = std::bit_cast<float>(words[word]);
    box.max()[axis] = std::bit_cast<float>(words[word + 3]);
  }
  return box;
}

}  // namespace ovimap
