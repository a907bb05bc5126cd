// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/decoding/lzfse_blocks.h"

namespace ovimap::lzfse {

namespace {

constexpr std::size_t kShortestMatch = 3;
constexpr std::size_t kLongRun = 16;  ///< the least length that takes a byte of its own
constexpr std::uint8_t kEnd = 0x06;
constexpr std::size_t kEndPadding = 7;

/// The bits [first, first + count) of a byte.
std::size_t bits(std::size_t byte, int first, int count) {
  return (byte >> first) & ((std::size_t{1} << count) - 1);
}

bool is_nothing(std::uint8_t code) {
  return code == 0x0e || code == 0x16;
}

bool is_undefined(std::uint8_t code) {
  const bool reserved = (code >= 0x70 && code <= 0x7f) || (code >= 0xd0 && code <= 0xdf);
  return reserved || (code < 0x40 && bits(code, 0, 3) == 6);
}

/// 0 to 3 literals, then a match at a new or the previous distance.
void decode_literals_and_match(std::uint8_t code, Input& input, Output& output,
                               std::size_t& distance) {
  std::size_t literals = bits(code, 6, 2);
  std::size_t length = bits(code, 3, 3) + kShortestMatch;
  if (code >= 0xa0 && code <= 0xbf) {  // 101LLMMM DDDDDDMM DDDDDDDD
    const auto more = take_number<std::uint16_t>(input);
    literals = bits(code, 3, 2);
    length = (bits(code, 0, 3) << 2 | bits(more, 0, 2)) + kShortestMatch;
    distance = bits(more, 2, 14);
  } else if (bits(code, 0, 3) == 7) {  // LLMMM111 DDDDDDDD DDDDDDDD
    distance = take_number<std::uint16_t>(input);
  } else if (bits(code, 0, 3) != 6) {  // LLMMMDDD DDDDDDDD; LLMMM110 keeps the distance
    distance = bits(code, 0, 3) << 8 | take_number<std::uint8_t>(input);
  }
  output.append(take(input, literals));
  output.repeat(distance, length);
}

}  // namespace

void decode_lzvn_block(Input& input, Output& output) {
  const auto raw_size = take_number<std::uint32_t>(input);
  Input payload = take(input, take_number<std::uint32_t>(input));
  const std::size_t begin = output.size();
  std::size_t distance = 0;
  while (true) {
    const auto code = take_number<std::uint8_t>(payload);
    if (code == kEnd) break;
    if (is_nothing(code)) continue;
    if (is_undefined(code)) fail_broken();
    if (code < 0xe0) {
      decode_literals_and_match(code, payload, output, distance);
      continue;
    }
    const std::size_t small = bits(code, 0, 4);
    const std::size_t length = small > 0 ? small : take_number<std::uint8_t>(payload) + kLongRun;
    if (code < 0xf0)
      output.append(take(payload, length));
    else
      output.repeat(distance, length);
  }
  take(payload, kEndPadding);
  if (!payload.empty() || output.size() - begin != raw_size) fail_broken();
}

}  // namespace ovimap::lzfse
