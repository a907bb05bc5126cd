// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/models/sha256.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "ovimap/base/error_fixture.h"

namespace ovimap {
namespace {

std::string sha256_of_text(std::string_view text, std::size_t piece) {
  Sha256 sha;
  for (std::size_t at = 0; at < text.size(); at += piece) {
    const std::string_view part = text.substr(at, piece);
    sha.update({reinterpret_cast<const std::uint8_t*>(part.data()), part.size()});
  }
  return sha.finish();
}

// Vectors of FIPS 180-4's companion examples.
TEST(Sha256, MatchesTheStandardsVectors) {
  EXPECT_EQ(sha256_of_text("", 1),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of_text("abc", 3),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_text("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", 56),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of_text(std::string(1000000, 'a'), 4096),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PiecesDoNotMatter) {
  for (const std::size_t size : {1u, 55u, 56u, 63u, 64u, 65u, 119u, 120u, 128u, 1000u}) {
    std::string text(size, 'x');
    for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>(i * 7);
    const std::string whole = sha256_of_text(text, size);
    for (const std::size_t piece : {1u, 3u, 63u, 64u, 65u})
      EXPECT_EQ(sha256_of_text(text, piece), whole) << size << " bytes in pieces of " << piece;
  }
}

TEST(Sha256, MissingFileIsNamed) {
  EXPECT_NE(error_of([] { sha256_of_file("no/such/file"); }).find("no/such/file"),
            std::string::npos);
}

}  // namespace
}  // namespace ovimap
