// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/image/codec.h"

#include <cstdlib>
#include <memory>
#include <string_view>

#include <spng.h>
#include <turbojpeg.h>
#include <zlib.h>

#include "ovimap/image/size_limits.h"

namespace ovimap {

namespace {

static_assert(sizeof(Rgb8) == 3, "the codecs write packed RGB");

/// What a PNG may hold beside its pixels (profiles, texts), unpacked: one such part, and all.
constexpr std::size_t kLargestPngPart = std::size_t{16} << 20, kAllPngParts = std::size_t{64} << 20;

/// PNG: deflate's fastest level, which looks for runs alone: filtered rows hold little else. Trying
/// the upper pixel as well pays for depth and ids, not for noisy colour.
constexpr int kPngLevel = 1;
constexpr int kPngStrategy = Z_RLE;
constexpr int kColorFilters = SPNG_FILTER_CHOICE_SUB;
constexpr int kGrayFilters = SPNG_FILTER_CHOICE_SUB | SPNG_FILTER_CHOICE_UP;

using PngContext = std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)>;
using JpegHandle = std::unique_ptr<void, decltype(&tjDestroy)>;

bool is_png(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  return bytes.size() >= sizeof(kSignature) &&
         std::equal(std::begin(kSignature), std::end(kSignature), bytes.begin());
}

bool is_jpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

std::string unknown_format(std::span<const std::uint8_t> bytes, std::string_view accepted) {
  return bytes.empty() ? "is empty" : concat("is not ", accepted);
}

void check_size(std::uint64_t width, std::uint64_t height, std::optional<ImageSize> expected) {
  if (!plausible_size(width, height))
    throw Error(concat("has an impossible size, ", width, "x", height));
  if (expected &&
      (static_cast<int>(width) != expected->width || static_cast<int>(height) != expected->height))
    throw Error(
        concat("is ", width, "x", height, ", expected ", expected->width, "x", expected->height));
}

[[noreturn]] void throw_png_fault(int code) {
  if (code == SPNG_EOF || code == SPNG_EIDAT_TOO_SHORT || code == SPNG_IO_EOF)
    throw Error("is a truncated PNG");
  throw Error(concat("is a damaged PNG (", spng_strerror(code), ")"));
}

void check_png(int code) {
  if (code != 0) throw_png_fault(code);
}

/// The pixels as they were before compression, less a byte a row.
std::uint64_t packed_bytes(const spng_ihdr& header) {
  const std::uint64_t channels = header.color_type == SPNG_COLOR_TYPE_TRUECOLOR         ? 3
                                 : header.color_type == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA ? 4
                                 : header.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA ? 2
                                                                                        : 1;
  return header.height * (header.width * channels * header.bit_depth / 8);
}

PngContext open_png(std::span<const std::uint8_t> bytes, spng_ihdr& header,
                    std::optional<ImageSize> expected) {
  PngContext context(spng_ctx_new(0), &spng_ctx_free);
  if (!context) throw std::bad_alloc();
  check_png(spng_set_chunk_limits(context.get(), kLargestPngPart, kAllPngParts));
  check_png(spng_set_png_buffer(context.get(), bytes.data(), bytes.size()));
  check_png(spng_get_ihdr(context.get(), &header));
  check_size(header.width, header.height, expected);
  if (!deflate_can_hold(bytes.size(), packed_bytes(header))) throw Error("is a truncated PNG");
  return context;
}

RgbImage decode_png_rgb(std::span<const std::uint8_t> bytes, std::optional<ImageSize> expected) {
  spng_ihdr header{};
  const PngContext context = open_png(bytes, header, expected);
  RgbImage image(static_cast<int>(header.width), static_cast<int>(header.height));
  check_png(spng_decode_image(context.get(), image.data(), image.size() * sizeof(Rgb8),
                              SPNG_FMT_RGB8, 0));
  return image;
}

JpegHandle open_jpeg(std::span<const std::uint8_t> bytes, ImageSize& found,
                     std::optional<ImageSize> expected) {
  JpegHandle handle(tjInitDecompress(), &tjDestroy);
  if (!handle) throw std::bad_alloc();
  int sampling = 0, colorspace = 0;
  if (tjDecompressHeader3(handle.get(), bytes.data(), static_cast<unsigned long>(bytes.size()),
                          &found.width, &found.height, &sampling, &colorspace) != 0)
    throw Error(concat("is a damaged JPEG (", tjGetErrorStr2(handle.get()), ")"));
  const auto columns = static_cast<std::uint64_t>(found.width),
             rows = static_cast<std::uint64_t>(found.height);
  check_size(columns, rows, expected);
  // Each 8x8 block takes a bit at least.
  if (columns * rows / (64 * 8) > bytes.size()) throw Error("is a truncated JPEG");
  return handle;
}

RgbImage decode_jpeg(std::span<const std::uint8_t> bytes, std::optional<ImageSize> expected) {
  ImageSize found;
  const JpegHandle handle = open_jpeg(bytes, found, expected);
  const auto size = static_cast<unsigned long>(bytes.size());
  const auto [width, height] = found;
  RgbImage image(width, height);
  auto* pixels = reinterpret_cast<unsigned char*>(image.data());
  if (tjDecompress2(handle.get(), bytes.data(), size, pixels, width, 0, height, TJPF_RGB,
                    TJFLAG_LIMITSCANS) != 0) {
    const std::string reason = tjGetErrorStr2(handle.get());
    // Stray bytes between segments lose no pixel; cameras write them.
    const bool harmless = tjGetErrorCode(handle.get()) == TJERR_WARNING &&
                          reason.find("extraneous bytes") != std::string::npos;
    if (reason.find("remature end") != std::string::npos) throw Error("is a truncated JPEG");
    if (!harmless) throw Error(concat("is a damaged JPEG (", reason, ")"));
  }
  return image;
}

Bytes encode_png(const void* pixels, std::size_t size_bytes, int width, int height,
                 spng_color_type color, int bits) {
  PngContext context(spng_ctx_new(SPNG_CTX_ENCODER), &spng_ctx_free);
  if (!context) throw std::bad_alloc();
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(width);
  header.height = static_cast<std::uint32_t>(height);
  header.color_type = static_cast<std::uint8_t>(color);
  header.bit_depth = static_cast<std::uint8_t>(bits);
  spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_set_option(context.get(), SPNG_IMG_COMPRESSION_LEVEL, kPngLevel);
  spng_set_option(context.get(), SPNG_IMG_COMPRESSION_STRATEGY, kPngStrategy);
  spng_set_option(context.get(), SPNG_FILTER_CHOICE,
                  color == SPNG_COLOR_TYPE_GRAYSCALE ? kGrayFilters : kColorFilters);
  int code = spng_set_ihdr(context.get(), &header);
  if (code == 0)
    code = spng_encode_image(context.get(), pixels, size_bytes, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
  std::size_t length = 0;
  std::unique_ptr<void, decltype(&std::free)> buffer(
      code == 0 ? spng_get_png_buffer(context.get(), &length, &code) : nullptr, &std::free);
  if (!buffer)
    throw Error(
        concat("cannot write a PNG of ", width, "x", height, " (", spng_strerror(code), ")"));
  const auto* bytes = static_cast<const std::uint8_t*>(buffer.get());
  return Bytes(bytes, bytes + length);
}

/// Runs `decode` on the file's bytes and puts the path before its complaints.
template <class Decode>
auto read_named(const std::filesystem::path& path, Decode&& decode) {
  const Bytes bytes = read_file(path);
  try {
    return decode(bytes);
  } catch (const Error& fault) {
    throw Error(concat(path.string(), " ", fault.what()));
  }
}

}  // namespace

ImageSize image_size(std::span<const std::uint8_t> bytes) {
  ImageSize found;
  if (is_png(bytes)) {
    spng_ihdr header{};
    open_png(bytes, header, std::nullopt);
    found = {static_cast<int>(header.width), static_cast<int>(header.height)};
  } else if (is_jpeg(bytes)) {
    open_jpeg(bytes, found, std::nullopt);
  } else {
    throw Error(unknown_format(bytes, "a PNG or JPEG"));
  }
  return found;
}

RgbImage decode_rgb(std::span<const std::uint8_t> bytes, std::optional<ImageSize> expected) {
  if (is_png(bytes)) return decode_png_rgb(bytes, expected);
  if (is_jpeg(bytes)) return decode_jpeg(bytes, expected);
  throw Error(unknown_format(bytes, "a PNG or JPEG"));
}

GrayPng decode_gray(std::span<const std::uint8_t> bytes, std::optional<ImageSize> expected) {
  if (!is_png(bytes)) throw Error(unknown_format(bytes, "a PNG"));
  spng_ihdr header{};
  const PngContext context = open_png(bytes, header, expected);
  if (header.color_type != SPNG_COLOR_TYPE_GRAYSCALE)
    throw Error("is a PNG in colour, accepted is one grey channel");
  if (header.bit_depth < 8)
    throw Error(concat("is a ", int(header.bit_depth), "-bit PNG, accepted are 8 and 16 bits"));
  GrayPng gray;
  gray.bits = header.bit_depth;
  gray.values =
      Image<std::uint16_t>::unset(static_cast<int>(header.width), static_cast<int>(header.height));
  // SPNG_FMT_PNG delivers 16-bit values in the machine's byte order.
  if (gray.bits == 16) {
    check_png(spng_decode_image(context.get(), gray.values.data(), gray.values.size() * 2,
                                SPNG_FMT_PNG, 0));
  } else {
    Bytes narrow(gray.values.size());
    check_png(spng_decode_image(context.get(), narrow.data(), narrow.size(), SPNG_FMT_PNG, 0));
    std::copy(narrow.begin(), narrow.end(), gray.values.begin());
  }
  return gray;
}

RgbImage read_rgb(const std::filesystem::path& path) {
  return read_named(path, [](const Bytes& bytes) { return decode_rgb(bytes); });
}

GrayPng read_gray(const std::filesystem::path& path) {
  return read_named(path, [](const Bytes& bytes) { return decode_gray(bytes); });
}

Bytes encode_png(const RgbImage& image) {
  return encode_png(image.data(), image.size() * sizeof(Rgb8), image.width(), image.height(),
                    SPNG_COLOR_TYPE_TRUECOLOR, 8);
}

Bytes encode_png(const Image<std::uint8_t>& image) {
  return encode_png(image.data(), image.size(), image.width(), image.height(),
                    SPNG_COLOR_TYPE_GRAYSCALE, 8);
}

Bytes encode_png(const Image<std::uint16_t>& image) {
  return encode_png(image.data(), image.size() * sizeof(std::uint16_t), image.width(),
                    image.height(), SPNG_COLOR_TYPE_GRAYSCALE, 16);
}

Bytes encode_jpeg(const RgbImage& image, int quality) {
  if (quality < 1 || quality > 100)
    throw Error(concat("JPEG quality is ", quality, "; accepted is 1 to 100"));
  const JpegHandle handle(tjInitCompress(), &tjDestroy);
  if (!handle) throw std::bad_alloc();
  unsigned char* compressed = nullptr;
  unsigned long length = 0;
  const auto* pixels = reinterpret_cast<const unsigned char*>(image.data());
  const int code = tjCompress2(handle.get(), pixels, image.width(), 0, image.height(), TJPF_RGB,
                               &compressed, &length, TJSAMP_420, quality, 0);
  const std::unique_ptr<unsigned char, decltype(&tjFree)> owner(compressed, &tjFree);
  if (code != 0)
    throw Error(concat("cannot write a JPEG of ", image.width(), "x", image.height(), " (",
                       tjGetErrorStr2(handle.get()), ")"));
  return Bytes(compressed, compressed + length);
}

}  // namespace ovimap
