// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "ovimap/image/image.h"

namespace ovimap {

using Bytes = std::vector<std::uint8_t>;

struct ImageSize {
  int width = 0, height = 0;
};

/// Reads a PNG or JPEG (told by its content) as RGB; grey becomes three equal channels, alpha is
/// dropped. Throws Error naming the file and the fault (missing, unknown format, truncated, another
/// size than `expected`, which is found before any pixel is decoded).
RgbImage read_rgb(const std::filesystem::path& path);
RgbImage decode_rgb(std::span<const std::uint8_t> bytes, std::optional<ImageSize> expected = {});
/// Its size, from its head alone.
ImageSize image_size(std::span<const std::uint8_t> bytes);

/// A single-channel PNG with its values as stored, 8 or 16 bits.
struct GrayPng {
  Image<std::uint16_t> values;
  int bits = 16;
};

/// Reads a grey PNG without scaling its values (depth, ids). Throws Error naming the file and the
/// fault; a colour or palette PNG is a fault.
GrayPng read_gray(const std::filesystem::path& path);
GrayPng decode_gray(std::span<const std::uint8_t> bytes, std::optional<ImageSize> expected = {});

Bytes encode_png(const RgbImage& image);
Bytes encode_png(const Image<std::uint8_t>& image);   ///< 8-bit grey
Bytes encode_png(const Image<std::uint16_t>& image);  ///< 16-bit grey
Bytes encode_jpeg(const RgbImage& image, int quality);

/// Whole file in memory, and back. Writing replaces the file only when complete: a full disk leaves
/// the old one. Both throw Error naming the path and the system's reason.
Bytes read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_text(const std::filesystem::path& path, std::string_view text);

/// Throws what write_file would throw for a target that cannot be written, so that long work learns
/// of it before it starts. Changes nothing.
void check_file_target(const std::filesystem::path& path);

}  // namespace ovimap
