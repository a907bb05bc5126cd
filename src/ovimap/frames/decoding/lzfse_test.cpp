// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/decoding/lzfse.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"

namespace ovimap {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// What the format's own library made of 6000 bytes entropy_byte(i): one block bvx2.
constexpr std::string_view kEntropyStream =
    "62767832701700008801500c004500300af4d0430f700070a600000010d0f0002717a3079db4b581a1085cdf"
    "5d4c640009f4e666ecbbbb17e013f817ce5f800d000000c01800000000000000007c08cfc2bff0217c0a1fc3"
    "a7f01a3c0fcfc2c7f027fc097fc187f027000000000000000000000000000000000000000000000000000000"
    "0000000000000000000000000000000000000000000000000000000000000000000000c0ec16e12ba779ff60"
    "5b89f78ba762603e0ca29470050be3af77e094655dc6a70df88ed334445fd62a285d1c8b23db0befa08ebfcc"
    "6f581015cb43a17f5a7243120cde2e1448f5cbca1f8d2a901825977a3fb4bcc66c7dbd31c1c7c3d02884fd74"
    "aa5537433964033e253b9f21b4322fbbb4fcf74d911efecfeddc8218f2067b721eaf9302f1d81d666b9ca060"
    "a5565f23c9dadafafc58d20ce3a1b2acff2701ff3e5149158b8e4f4185dd2fa6aa4e8683a8e0f5589b2662b4"
    "fabf17d9676116c077340d00000000000000000000d80266fff7308aff77b9faf507095f1259d5d500a1361c"
    "36d00a56e1b81e15722fa2345bc1119e40814c2007d6002a4f8e229f03abd124da88f13bffe2a12708ea462e"
    "66c88ca8126e13547e6ab8d07982ce801ea7c683c8ff3ddec02b5023b4d12f02c2c6e362767824";
/// And of 900 bytes lzvn_byte(i): one block bvxn.
constexpr std::string_view kLzvnStream =
    "6276786e8403000006010000500100e0130101020203030405060708090a0b0c0e0f1112141517191b1d1f21"
    "232527292c2e3101f96e02f0006e03f0006e04f0006e05f0006e06f0006e07f0006e08f0006e09f0006e0af0"
    "006e0bf000e019172a3e1125380c2034081c3004182c0015293e12273b10253a0f24390e23380e23390e2439"
    "0f253b01f96e02f0006e03f0006e04f0006e05f0006e06f0006e07f0006e08f0006e09f0006e0af0006e0bf0"
    "00e0071c032a11381f062d143b230a32190128103820083018000008ef2109321a032b143d260f38210a3301"
    "30016e02f0006e03f0006e04f0006e05f0006e06f0006e07f0006e08f0006e09f0006e0af0006e0bfce40b0b"
    "0b0b060000000000000062767824";

int entropy_byte(int i) {
  return (i * i / 97) & 15;
}
int lzvn_byte(int i) {
  return i % 300 < 40 ? (i * i / 31) & 63 : i % 300 / 25;
}

Bytes from_hex(std::string_view text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes.push_back(
        static_cast<std::uint8_t>(std::stoi(std::string(text.substr(i, 2)), nullptr, 16)));
  return bytes;
}

Bytes made(int count, int (*byte)(int)) {
  Bytes bytes;
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(byte(i)));
  return bytes;
}

Bytes text_bytes(std::string_view text) {
  return Bytes(text.begin(), text.end());
}

/// A block bvxn of hand-made codes, with the end code and the end of the stream.
Bytes lzvn_stream(const Bytes& codes, std::uint8_t raw_size) {
  const auto number = [](std::size_t low) {
    return std::string{static_cast<char>(low), '\0', '\0', '\0'};
  };
  const std::string end = '\6' + std::string(7, '\0');
  return text_bytes("bvxn" + number(raw_size) + number(codes.size() + end.size()) +
                    std::string(codes.begin(), codes.end()) + end + "bvx$");
}

TEST(Lzfse, EntropyCodedBlockComesBack) {
  EXPECT_EQ(decode_lzfse(from_hex(kEntropyStream), 6000), made(6000, entropy_byte));
}

TEST(Lzfse, LzvnBlockComesBack) {
  EXPECT_EQ(decode_lzfse(from_hex(kLzvnStream), 900), made(900, lzvn_byte));
}

TEST(Lzfse, PlainBlocksFollowOneAnother) {
  using namespace std::string_view_literals;
  const Bytes stream = text_bytes("bvx-\3\0\0\0abcbvx-\2\0\0\0debvx$"sv);
  EXPECT_EQ(decode_lzfse(stream, 5), text_bytes("abcde"));
  EXPECT_EQ(decode_lzfse(text_bytes("bvx$"), 0), Bytes{});
}

TEST(Lzfse, EveryLzvnCode) {
  // Small literal "abcd"; small match of 2 bytes; both need a distance first.
  const Bytes literal = {0xe4, 'a', 'b', 'c', 'd'};
  const auto with = [&](std::initializer_list<std::uint8_t> more, std::uint8_t raw_size) {
    Bytes codes = literal;
    codes.insert(codes.end(), more);
    return decode_lzfse(lzvn_stream(codes, raw_size), raw_size);
  };
  // LL = 1, MMM = 0 (3 bytes), distance 5, literal 'x'.
  EXPECT_EQ(with({0x40, 5, 'x'}, 8), text_bytes("abcdxabc"));
  // Large distance: LL = 0, MMM = 1 (4 bytes), distance 2: the repeated part repeats itself.
  EXPECT_EQ(with({0x0f, 2, 0}, 8), text_bytes("abcdcdcd"));
  // Medium distance: LL = 1, MMM MM = 000 01 (4 bytes), distance 4, literal 'y'.
  EXPECT_EQ(with({0xa8, 4 << 2 | 1, 0, 'y'}, 9), text_bytes("abcdybcdy"));
  // Previous distance with a literal, then a small match of 2 and a large one of 16 + 1.
  EXPECT_EQ(with({0x0f, 1, 0, 0x46, 'z', 0xf2, 0xf0, 1}, 31),
            text_bytes("abcdddddz" + std::string(22, 'z')));
  // Large literal of 16 bytes, and codes that do nothing.
  EXPECT_EQ(with({0x0e, 0x16, 0xe0, 0,   'p', 'p', 'p', 'p', 'p', 'p',
                  'p',  'p',  'p',  'p', 'p', 'p', 'p', 'p', 'p', 'p'},
                 20),
            text_bytes("abcd" + std::string(16, 'p')));
}

TEST(Lzfse, WhatIsBrokenIsRefused) {
  for (const Bytes& whole : {from_hex(kEntropyStream), from_hex(kLzvnStream)})
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_THROW(decode_lzfse(std::span(whole).first(size), 6000), Error) << size;
  EXPECT_THROW(decode_lzfse(text_bytes("bvx1"), 10), Error);
  EXPECT_THROW(decode_lzfse(lzvn_stream({0x1e}, 0), 10), Error) << "undefined code";
  EXPECT_THROW(decode_lzfse(lzvn_stream({0xf2}, 2), 10), Error) << "no distance yet";
  EXPECT_THROW(decode_lzfse(lzvn_stream({0xe1, 'a', 0x00, 2}, 4), 10), Error) << "too far back";
  EXPECT_THROW(decode_lzfse(lzvn_stream({0xe1, 'a'}, 2), 10), Error) << "promised more";
}

TEST(Lzfse, NeverGivesMoreThanAllowed) {
  EXPECT_THROW(decode_lzfse(from_hex(kEntropyStream), 5999), Error);
  EXPECT_THROW(decode_lzfse(from_hex(kLzvnStream), 899), Error);
}

TEST(Lzfse, ChangedBytesAreSurvived) {
  const Bytes whole = from_hex(kEntropyStream);
  int refused = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    Bytes changed = whole;
    changed[i] ^= static_cast<std::uint8_t>(1 + i % 255);
    try {
      EXPECT_LE(decode_lzfse(changed, 6000).size(), 6000u);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

TEST(Lzfse, IsToldByItsFirstLetters) {
  EXPECT_TRUE(is_lzfse(from_hex(kEntropyStream)));
  EXPECT_TRUE(is_lzfse(from_hex(kLzvnStream)));
  EXPECT_FALSE(is_lzfse(text_bytes("bv")));
  EXPECT_FALSE(is_lzfse(text_bytes("PNG.")));
}

}  // namespace
}  // namespace ovimap
