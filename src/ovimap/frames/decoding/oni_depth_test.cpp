// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/decoding/oni_depth.h"

#include <random>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"

namespace ovimap {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<int> decoded(const Bytes& bytes, int width, bool with_table = false) {
  const Image<std::uint16_t> depth = decode_oni_depth(bytes, width, 1, with_table);
  return {depth.begin(), depth.end()};
}

TEST(OniDepth, ReadsEachCode) {
  EXPECT_EQ(decoded({0x34, 0x12}, 1), std::vector{0x1234});
  // Two small differences in a byte: each is what the value falls by, and 6 more.
  EXPECT_EQ(decoded({100, 0, 0x5C}, 3), (std::vector{100, 101, 95}));
  // One alone at the end.
  EXPECT_EQ(decoded({100, 0, 0x0D}, 2), (std::vector{100, 106}));
  // Twice so many equal values.
  EXPECT_EQ(decoded({100, 0, 0xE2}, 5), (std::vector{100, 100, 100, 100, 100}));
  // A difference of a byte, the value itself, and both after a nibble.
  EXPECT_EQ(decoded({100, 0, 0xFF, 0xC0 + 20}, 2), (std::vector{100, 80}));
  EXPECT_EQ(decoded({100, 0, 0xFF, 0x12, 0x34}, 2), (std::vector{100, 0x1234}));
  EXPECT_EQ(decoded({100, 0, 0x5F, 0xC0 - 20}, 3), (std::vector{100, 101, 121}));
  EXPECT_EQ(decoded({100, 0, 0x5F, 0x12, 0x34}, 3), (std::vector{100, 101, 0x1234}));
}

TEST(OniDepth, ATableHoldsTheValues) {
  EXPECT_EQ(decoded({3, 0, 0, 0, 0xE8, 3, 0xD0, 7, 1, 0, 0x5D}, 2, true),
            (std::vector{1000, 2000}));
}

TEST(OniDepth, WhatIsNoSuchImageIsRefused) {
  for (const Bytes& bytes : {Bytes{}, Bytes{1}, Bytes{100, 0}, Bytes{100, 0, 0x66, 0x66},
                             Bytes{100, 0, 0xFF}, Bytes{100, 0, 0x6F, 0x12}, Bytes{100, 0, 0xEF}})
    EXPECT_THROW(decoded(bytes, 3), Error);
  EXPECT_THROW(decoded({0, 0, 0, 0}, 1, true), Error) << "an empty table";
  EXPECT_THROW(decoded({9, 0, 0, 0}, 1, true), Error) << "a table that is cut off";
  EXPECT_THROW(decoded({1, 0, 0, 0, 1, 0}, 1, true), Error) << "a place beyond the table";
  EXPECT_THROW(decode_oni_depth(Bytes{1, 0}, 30000, 4000, false), Error)
      << "too short for its size";
}

TEST(OniDepth, AnyBytesAreReadOrRefused) {
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes(random() % 40);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    try {
      decode_oni_depth(bytes, 8, 2, random() % 2 == 0);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace ovimap
