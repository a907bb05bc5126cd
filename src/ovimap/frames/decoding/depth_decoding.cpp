// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/decoding/depth_decoding.h"

#include <bit>
#include <cstring>

#include <zlib.h>

#include "ovimap/base/error.h"
#include "ovimap/frames/decoding/lzfse.h"
#include "ovimap/image/size_limits.h"

namespace ovimap {

static_assert(std::endian::native == std::endian::little, "depth is stored little-endian");

namespace {

/// Throws when there can be no image of that size.
std::size_t size_in_bytes(int width, int height, std::size_t pixel_bytes) {
  // A negative side becomes a huge one.
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  if (!plausible_size(columns, rows))
    throw Error(concat("has an impossible size, ", width, "x", height));
  return columns * rows * pixel_bytes;
}

[[noreturn]] void throw_wrong_size(std::size_t bytes, std::size_t expected, int width, int height) {
  throw Error(concat("holds ", bytes, " bytes, expected ", expected, " for ", width, "x", height));
}

}  // namespace

Image<std::uint16_t> decode_zlib_depth(std::span<const std::uint8_t> bytes, int width, int height) {
  if (!deflate_can_hold(bytes.size(), size_in_bytes(width, height, sizeof(std::uint16_t))))
    throw Error(concat("is too short, ", bytes.size(), " bytes, for ", width, "x", height));
  Image<std::uint16_t> units(width, height);
  const auto expected = static_cast<uLongf>(units.size() * sizeof(std::uint16_t));
  uLongf decoded = expected;
  const int status = uncompress(reinterpret_cast<Bytef*>(units.data()), &decoded, bytes.data(),
                                static_cast<uLong>(bytes.size()));
  if (status == Z_BUF_ERROR && decoded == expected)
    throw Error(concat("holds more depth than ", width, "x", height));
  if (status != Z_OK) throw Error("is broken zlib data");
  if (decoded != expected) throw_wrong_size(decoded, expected, width, height);
  return units;
}

namespace {

/// An image of pixels as they lie in memory.
template <class Pixel>
Image<Pixel> image_of(std::span<const std::uint8_t> bytes, int width, int height) {
  const std::size_t expected = size_in_bytes(width, height, sizeof(Pixel));
  if (bytes.size() != expected) throw_wrong_size(bytes.size(), expected, width, height);
  Image<Pixel> image(width, height);
  std::memcpy(image.data(), bytes.data(), expected);
  return image;
}

template <class Pixel>
Image<Pixel> unpacked_image(std::span<const std::uint8_t> bytes, int width, int height) {
  const std::size_t expected = size_in_bytes(width, height, sizeof(Pixel));
  if (bytes.size() == expected || !is_lzfse(bytes)) return image_of<Pixel>(bytes, width, height);
  return image_of<Pixel>(decode_lzfse(bytes, expected), width, height);
}

}  // namespace

Image<std::uint16_t> decode_raw_depth(std::span<const std::uint8_t> bytes, int width, int height) {
  return image_of<std::uint16_t>(bytes, width, height);
}

DepthImage decode_float_depth(std::span<const std::uint8_t> bytes, int width, int height) {
  return unpacked_image<float>(bytes, width, height);
}

Image<std::uint8_t> decode_bytes(std::span<const std::uint8_t> bytes, int width, int height) {
  return unpacked_image<std::uint8_t>(bytes, width, height);
}

RgbImage decode_raw_color(std::span<const std::uint8_t> bytes, int width, int height) {
  static_assert(sizeof(Rgb8) == 3);
  return image_of<Rgb8>(bytes, width, height);
}

}  // namespace ovimap
