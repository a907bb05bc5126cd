// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/image/codec.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <random>

#include <sys/resource.h>
#include <unistd.h>
#include <zlib.h>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"

namespace ovimap {
namespace {

RgbImage random_rgb(int width, int height) {
  std::mt19937 random(7);
  RgbImage image(width, height);
  for (Rgb8& pixel : image)
    pixel = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
             static_cast<std::uint8_t>(random())};
  return image;
}

Image<std::uint16_t> random_gray(int width, int height) {
  std::mt19937 random(8);
  Image<std::uint16_t> image(width, height);
  for (std::uint16_t& value : image) value = static_cast<std::uint16_t>(random());
  return image;
}

/// A PNG assembled by hand: one 2x1 grey row in a stored (uncompressed) deflate block.
Bytes tiny_gray_png(int bits, const Bytes& row);

std::uint32_t crc_of(const Bytes& bytes, std::size_t begin) {
  std::uint32_t crc = 0xffffffffu;
  for (std::size_t i = begin; i < bytes.size(); ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

void put_u32(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void put_chunk(Bytes& png, const char* type, const Bytes& content) {
  put_u32(png, static_cast<std::uint32_t>(content.size()));
  const std::size_t begin = png.size();
  png.insert(png.end(), type, type + 4);
  png.insert(png.end(), content.begin(), content.end());
  put_u32(png, crc_of(png, begin));
}

Bytes tiny_gray_png(int bits, const Bytes& row) {
  Bytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  put_chunk(png, "IHDR", {0, 0, 0, 2, 0, 0, 0, 1, static_cast<std::uint8_t>(bits), 0, 0, 0, 0});
  Bytes scanline = {0};  // no filter
  scanline.insert(scanline.end(), row.begin(), row.end());
  const auto size = static_cast<std::uint8_t>(scanline.size());
  Bytes stream = {0x78, 0x01, 0x01, size, 0, static_cast<std::uint8_t>(~size), 0xff};
  std::uint32_t a = 1, b = 0;
  for (const std::uint8_t byte : scanline) {
    stream.push_back(byte);
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  put_u32(stream, (b << 16) | a);
  put_chunk(png, "IDAT", stream);
  put_chunk(png, "IEND", {});
  return png;
}

TEST(Png, RgbRoundTripIsExact) {
  const RgbImage image = random_rgb(37, 21);
  EXPECT_EQ(decode_rgb(encode_png(image)), image);
}

TEST(Png, Gray16RoundTripIsExact) {
  const Image<std::uint16_t> image = random_gray(53, 17);
  const GrayPng back = decode_gray(encode_png(image));
  EXPECT_EQ(back.bits, 16);
  EXPECT_EQ(back.values, image);
}

TEST(Png, SixteenBitValuesAreBigEndianInTheFile) {
  const GrayPng gray = decode_gray(tiny_gray_png(16, {0x12, 0x34, 0xff, 0x01}));
  EXPECT_EQ(gray.values.at(0, 0), 0x1234);
  EXPECT_EQ(gray.values.at(1, 0), 0xff01);
}

TEST(Png, EightBitValuesAreNotScaled) {
  const GrayPng gray = decode_gray(tiny_gray_png(8, {3, 200}));
  EXPECT_EQ(gray.bits, 8);
  EXPECT_EQ(gray.values.at(0, 0), 3);
  EXPECT_EQ(gray.values.at(1, 0), 200);
}

TEST(Png, GrayReadAsRgbHasThreeEqualChannels) {
  const RgbImage image = decode_rgb(tiny_gray_png(8, {3, 200}));
  EXPECT_EQ(image.at(0, 0), (Rgb8{3, 3, 3}));
  EXPECT_EQ(image.at(1, 0), (Rgb8{200, 200, 200}));
}

TEST(Png, NarrowGrayAndColourAreRefusedAsValues) {
  EXPECT_NE(error_of([] { decode_gray(tiny_gray_png(4, {0x12})); }).find("4-bit"),
            std::string::npos);
  EXPECT_NE(error_of([] { decode_gray(encode_png(random_rgb(4, 4))); }).find("in colour"),
            std::string::npos);
  EXPECT_NE(error_of([] { decode_gray(encode_jpeg(random_rgb(16, 16), 90)); }).find("not a PNG"),
            std::string::npos);
}

TEST(Png, EveryTruncationIsAFault) {
  const Bytes whole = encode_png(random_gray(24, 24));
  // The last 12 bytes are the end mark, after all pixels.
  for (std::size_t length = 0; length + 12 < whole.size(); length += 13)
    EXPECT_THROW(decode_gray(std::span(whole).first(length)), Error) << length;
  EXPECT_EQ(error_of([&] { decode_gray(std::span(whole).first(whole.size() / 2)); }),
            "is a truncated PNG");
}

TEST(Png, FlippedBitIsAFault) {
  Bytes bytes = encode_png(random_gray(24, 24));
  bytes[bytes.size() / 2] ^= 0x10;
  EXPECT_NE(error_of([&] { decode_gray(bytes); }).find("damaged PNG"), std::string::npos);
}

TEST(Codec, AnotherSizeIsFoundBeforeThePixels) {
  const std::string fault = "is 24x16, expected 24x17";
  const Bytes color = encode_png(random_rgb(24, 16)), gray = encode_png(random_gray(24, 16)),
              jpeg = encode_jpeg(random_rgb(24, 16), 90);
  for (const Bytes& bytes : {color, jpeg}) {
    EXPECT_EQ(decode_rgb(bytes, ImageSize{24, 16}), decode_rgb(bytes));
    EXPECT_EQ(error_of([&] { decode_rgb(bytes, ImageSize{24, 17}); }), fault);
  }
  const auto header_alone = std::span(gray).first(60);
  EXPECT_EQ(error_of([&] { decode_gray(header_alone, ImageSize{24, 17}); }), fault);
}

TEST(Png, ImpossibleSizeIsRefusedBeforeMemoryIsTaken) {
  Bytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  put_chunk(png, "IHDR", {0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 16, 0, 0, 0, 0});
  put_chunk(png, "IDAT", {});
  EXPECT_THROW(decode_gray(png), Error);
  EXPECT_THROW(decode_rgb(png), Error);
}

/// What `call` says while the process may take no more than 64 MB beyond what it has.
template <class Call>
std::string fault_in_little_memory(Call&& call) {
  std::ifstream statm("/proc/self/statm");
  rlim_t pages = 0;
  statm >> pages;
  rlimit before{};
  ::getrlimit(RLIMIT_AS, &before);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they reserve more than that
  const rlimit little{pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (rlim_t{64} << 20),
                      before.rlim_max};
  ::setrlimit(RLIMIT_AS, &little);
#endif
  std::string fault;
  try {
    fault = error_of(call);
  } catch (const std::bad_alloc&) {
    fault = "out of memory";
  }
  ::setrlimit(RLIMIT_AS, &before);
  return fault;
}

TEST(Png, ASizeThatTheBytesCannotHoldTakesNoMemory) {
  Bytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  put_chunk(png, "IHDR", {0, 0, 0x2c, 0, 0, 0, 0x2c, 0, 16, 0, 0, 0, 0});  // 11264 x 11264
  put_chunk(png, "IDAT", Bytes(1000));
  EXPECT_EQ(fault_in_little_memory([&] { decode_gray(png); }), "is a truncated PNG");
  EXPECT_EQ(fault_in_little_memory([&] { decode_rgb(png); }), "is a truncated PNG");
}

TEST(Png, AnEmptyImageAsLargeAsACamerasIsTaken) {
  const Image<std::uint16_t> nothing(4000, 3000);
  EXPECT_EQ(decode_gray(encode_png(nothing)).values, nothing);
  const RgbImage black(4000, 3000);
  EXPECT_EQ(decode_rgb(encode_png(black)), black);
  EXPECT_EQ(decode_rgb(encode_jpeg(black, 1)).size(), black.size());
}

TEST(Png, TextsThatUnpackToGigabytesAreRefused) {
  const Bytes zeros(100 << 20);
  uLongf size = compressBound(zeros.size());
  Bytes text = {'a', 0, 0};  // keyword, method
  text.resize(3 + size);
  ASSERT_EQ(compress(text.data() + 3, &size, zeros.data(), zeros.size()), Z_OK);
  text.resize(3 + size);
  const Bytes plain = encode_png(random_gray(16, 16));
  const std::ptrdiff_t after_header = 8 + 25;
  Bytes png(plain.begin(), plain.begin() + after_header);
  put_chunk(png, "zTXt", text);
  png.insert(png.end(), plain.begin() + after_header, plain.end());
  EXPECT_NE(error_of([&] { decode_gray(png); }).find("damaged PNG"), std::string::npos);
}

TEST(Jpeg, ASizeThatTheBytesCannotHoldTakesNoMemory) {
  Bytes jpeg = encode_jpeg(random_rgb(16, 16), 90);
  const Bytes frame = {0xff, 0xc0};  // its size stands five bytes further
  const auto at = std::search(jpeg.begin(), jpeg.end(), frame.begin(), frame.end());
  ASSERT_NE(at, jpeg.end());
  for (const int i : {5, 7}) at[i] = 0x2c;
  EXPECT_EQ(fault_in_little_memory([&] { decode_rgb(jpeg); }), "is a truncated JPEG");
}

TEST(Jpeg, SmoothImageComesBackNearly) {
  RgbImage image(64, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      image.at(x, y) = {static_cast<std::uint8_t>(2 * x), static_cast<std::uint8_t>(3 * y), 90};
  const RgbImage back = decode_rgb(encode_jpeg(image, 95));
  ASSERT_TRUE(back.same_size(image));
  for (std::size_t i = 0; i < image.size(); ++i) {
    ASSERT_LE(std::abs(back[i].r - image[i].r), 8) << i;
    ASSERT_LE(std::abs(back[i].g - image[i].g), 8) << i;
    ASSERT_LE(std::abs(back[i].b - image[i].b), 8) << i;
  }
}

TEST(Jpeg, TruncationIsAFault) {
  const Bytes whole = encode_jpeg(random_rgb(64, 48), 90);
  for (const std::size_t length :
       {std::size_t{3}, std::size_t{40}, whole.size() / 2, whole.size() - 40})
    EXPECT_THROW(decode_rgb(std::span(whole).first(length)), Error) << length;
  EXPECT_EQ(error_of([&] { decode_rgb(std::span(whole).first(whole.size() / 2)); }),
            "is a truncated JPEG");
}

TEST(Jpeg, QualityOutOfRangeIsRefused) {
  EXPECT_THROW(encode_jpeg(random_rgb(8, 8), 0), Error);
  EXPECT_THROW(encode_jpeg(random_rgb(8, 8), 101), Error);
}

TEST(Decode, UnknownContentIsNamed) {
  const Bytes text = {'h', 'e', 'l', 'l', 'o'};
  EXPECT_EQ(error_of([&] { decode_rgb(text); }), "is not a PNG or JPEG");
  EXPECT_EQ(error_of([] { decode_rgb({}); }), "is empty");
  EXPECT_EQ(error_of([] { decode_gray({}); }), "is empty");
}

TEST(Decode, FaultOfAFileNamesTheFile) {
  const fixture::TemporaryFolder folder;
  const auto path = folder.path() / "picture.jpg";
  write_file(path, {});
  EXPECT_EQ(error_of([&] { read_rgb(path); }), path.string() + " is empty");
  EXPECT_EQ(error_of([&] { read_gray(path); }), path.string() + " is empty");
}

}  // namespace
}  // namespace ovimap
