// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace ovimap {

/// The wire format of protocol buffers, as far as small files of networks and tokenizers need it
/// (protobuf.dev, "Encoding"). Messages within messages are written as bytes.
class ProtoWriter {
 public:
  ProtoWriter& number(int field, std::uint64_t value) {
    varint(static_cast<std::uint64_t>(field) << 3);
    varint(value);
    return *this;
  }
  ProtoWriter& real(int field, float value) {
    constexpr int kFixed32 = 5, kBytes = 4, kBitsPerByte = 8;
    varint(static_cast<std::uint64_t>(field) << 3 | kFixed32);
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int i = 0; i < kBytes; ++i) text_ += static_cast<char>(bits >> (kBitsPerByte * i) & 0xFF);
    return *this;
  }
  ProtoWriter& bytes(int field, std::string_view value) {
    constexpr int kDelimited = 2;
    varint(static_cast<std::uint64_t>(field) << 3 | kDelimited);
    varint(value.size());
    text_ += value;
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  void varint(std::uint64_t value) {
    for (; value > 0x7F; value >>= 7) text_ += static_cast<char>(0x80 | (value & 0x7F));
    text_ += static_cast<char>(value);
  }
  std::string text_;
};

}  // namespace ovimap
