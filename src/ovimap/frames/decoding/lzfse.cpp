// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/decoding/lzfse.h"

#include <string_view>

#include "ovimap/frames/decoding/lzfse_blocks.h"

namespace ovimap {

namespace {

constexpr std::size_t kLetters = 4;

std::string_view letters(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kLetters)};
}

}  // namespace

bool is_lzfse(std::span<const std::uint8_t> bytes) {
  const std::string_view first = letters(bytes);
  return first == "bvx2" || first == "bvxn" || first == "bvx-" || first == "bvx$";
}

std::vector<std::uint8_t> decode_lzfse(std::span<const std::uint8_t> bytes, std::size_t max_size) {
  lzfse::Input input = bytes;
  lzfse::Output output(max_size);
  while (true) {
    const std::string_view kind = letters(lzfse::take(input, kLetters));
    if (kind == "bvx$") return output.release();
    if (kind == "bvx2") {
      lzfse::decode_entropy_block(input, output);
    } else if (kind == "bvxn") {
      lzfse::decode_lzvn_block(input, output);
    } else if (kind == "bvx-") {
      output.append(lzfse::take(input, lzfse::take_number<std::uint32_t>(input)));
    } else {
      lzfse::fail_broken();
    }
  }
}

}  // namespace ovimap
