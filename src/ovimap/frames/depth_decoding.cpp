// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/depth_decoding.h"

#include <bit>
#include <cstring>

#include <zlib.h>

#include "ovimap/base/error.h"

namespace ovimap {

static_assert(std::endian::native == std::endian::little, "depth is stored little-endian");

Image<std::uint16_t> decode_zlib_depth(std::span<const std::uint8_t> bytes, int width, int height) {
  Image<std::uint16_t> units(width, height);
  const auto expected = static_cast<uLongf>(units.size() * sizeof(std::uint16_t));
  uLongf decoded = expected;
  const int status = uncompress(reinterpret_cast<Bytef*>(units.data()), &decoded, bytes.data(),
                                static_cast<uLong>(bytes.size()));
  if (status == Z_BUF_ERROR && decoded == expected)
    throw Error(concat("holds more depth than ", width, "x", height));
  if (status != Z_OK) throw Error("is broken zlib data");
  if (decoded != expected)
    throw Error(concat("holds ", decoded, " bytes of depth, expected ", expected, " for ", width,
                       "x", height));
  return units;
}

Image<std::uint16_t> decode_raw_depth(std::span<const std::uint8_t> bytes, int width, int height) {
  Image<std::uint16_t> units(width, height);
  const std::size_t expected = units.size() * sizeof(std::uint16_t);
  if (bytes.size() != expected)
    throw Error(concat("holds ", bytes.size(), " bytes of depth, expected ", expected, " for ",
                       width, "x", height));
  if (expected > 0) std::memcpy(units.data(), bytes.data(), expected);
  return units;
}

}  // namespace ovimap
