// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "ovimap/image/image.h"

namespace ovimap {

/// Rows of little-endian 16-bit numbers, zlib-compressed. Throws Error with a phrase that follows
/// the file's name ("is broken zlib data") when the bytes are no such image of that size.
Image<std::uint16_t> decode_zlib_depth(std::span<const std::uint8_t> bytes, int width, int height);

/// The same, uncompressed.
Image<std::uint16_t> decode_raw_depth(std::span<const std::uint8_t> bytes, int width, int height);

/// Rows of little-endian 32-bit numbers, LZFSE-compressed or plain.
DepthImage decode_float_depth(std::span<const std::uint8_t> bytes, int width, int height);

/// Rows of bytes, LZFSE-compressed or plain.
Image<std::uint8_t> decode_bytes(std::span<const std::uint8_t> bytes, int width, int height);

/// Rows of pixels, a byte each of red, green and blue.
RgbImage decode_raw_color(std::span<const std::uint8_t> bytes, int width, int height);

}  // namespace ovimap
