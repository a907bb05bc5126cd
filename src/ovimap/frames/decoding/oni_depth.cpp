// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/decoding/oni_depth.h"

#include <algorithm>
#include <vector>

#include "ovimap/base/error.h"
#include "ovimap/image/size_limits.h"

namespace ovimap {

namespace {

/// A byte below kRun holds two nibbles, each a difference of so much less than kNibbleZero; from
/// there on it is a run of twice so many equal values, or kWide.
constexpr int kNibbleZero = 6, kRun = 0xE0, kWide = 0xFF;
constexpr int kNoValue = 0xD, kWideNibble = 0xF;  ///< as a byte's second nibble
constexpr int kByteZero = 0xC0;                   ///< of a difference with a byte of its own

[[noreturn]] void throw_broken() {
  throw Error("is broken OpenNI depth");
}

/// Bytes one after another.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool at_end() const { return position_ == bytes_.size(); }
  int byte() {
    if (at_end()) throw_broken();
    return bytes_[position_++];
  }
  std::uint16_t little_endian() {
    const int low = byte();
    return static_cast<std::uint16_t>(low | byte() << 8);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
};

class Decoder {
 public:
  Decoder(ByteReader& in, Image<std::uint16_t>& out, const std::vector<std::uint16_t>& table)
      : in_(in), out_(out), table_(table) {}

  /// Returns how many values there were.
  std::size_t decode() {
    value_ = in_.little_endian();
    put();
    while (!in_.at_end()) {
      const int byte = in_.byte();
      if (byte < kRun)
        nibbles(byte);
      else if (byte == kWide)
        wide();
      else
        for (int i = 0; i < 2 * (byte - kRun); ++i) put();
    }
    return count_;
  }

 private:
  void nibbles(int byte) {
    step((byte >> 4) - kNibbleZero);
    const int second = byte & 0xF;
    if (second == kWideNibble)
      wide();
    else if (second != kNoValue)
      step(second - kNibbleZero);
  }
  /// A difference of a byte, or the value itself in two, the higher one first.
  void wide() {
    const int byte = in_.byte();
    if ((byte & 0x80) != 0) return step(byte - kByteZero);
    value_ = static_cast<std::uint16_t>(byte << 8 | in_.byte());
    put();
  }
  void step(int less) {
    value_ = static_cast<std::uint16_t>(value_ - less);
    put();
  }
  void put() {
    if (count_ == out_.size() || (!table_.empty() && value_ >= table_.size())) throw_broken();
    out_[count_++] = table_.empty() ? value_ : table_[value_];
  }

  ByteReader& in_;
  Image<std::uint16_t>& out_;
  const std::vector<std::uint16_t>& table_;
  std::uint16_t value_ = 0;
  std::size_t count_ = 0;
};

/// A run is the densest code: twice 15 values in a byte.
bool can_hold(std::size_t bytes, std::size_t pixels) {
  return pixels / (2 * (kWide - kRun)) <= bytes;
}

}  // namespace

Image<std::uint16_t> decode_oni_depth(std::span<const std::uint8_t> bytes, int width, int height,
                                      bool with_table) {
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  if (!plausible_size(columns, rows))
    throw Error(concat("has an impossible size, ", width, "x", height));
  if (!can_hold(bytes.size(), columns * rows)) throw_broken();
  ByteReader in(bytes);
  std::vector<std::uint16_t> table(with_table ? in.little_endian() : 0);
  if (with_table && table.empty()) throw_broken();
  std::generate(table.begin(), table.end(), [&] { return in.little_endian(); });
  Image<std::uint16_t> depth(width, height);
  if (Decoder(in, depth, table).decode() != depth.size()) throw_broken();
  return depth;
}

}  // namespace ovimap
