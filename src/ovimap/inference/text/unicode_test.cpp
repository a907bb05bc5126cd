// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/text/unicode.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(Utf8, RoundTrip) {
  const std::u32string text = {U'a', 0xE9, 0x6F22, 0x1F600, 0, 0x10FFFF};
  EXPECT_EQ(encode_utf8(text),
            std::string("a\xC3\xA9\xE6\xBC\xA2\xF0\x9F\x98\x80\0\xF4\x8F\xBF\xBF", 15));
  EXPECT_EQ(decode_utf8(encode_utf8(text)), text);
}

TEST(Utf8, InvalidBytesAreReplaced) {
  EXPECT_EQ(decode_utf8("a\xFFz"), (std::u32string{U'a', 0xFFFD, U'z'}));
  EXPECT_EQ(decode_utf8("\xC3"), std::u32string(1, 0xFFFD));              // cut off
  EXPECT_EQ(decode_utf8("\xC0\x80"), std::u32string(2, 0xFFFD));          // overlong
  EXPECT_EQ(decode_utf8("\xED\xA0\x80"), std::u32string(3, 0xFFFD));      // surrogate
  EXPECT_EQ(decode_utf8("\xF4\x90\x80\x80"), std::u32string(4, 0xFFFD));  // beyond Unicode
}

TEST(Normalized, ComposesAndDecomposes) {
  const std::u32string composed = {0xE9, 0xC5, 0xD55C},
                       decomposed = {U'e', 0x301, U'A', 0x30A, 0x1112, 0x1161, 0x11AB};
  EXPECT_EQ(normalized(composed, UnicodeForm::kDecomposed), decomposed);
  EXPECT_EQ(normalized(decomposed, UnicodeForm::kComposed), composed);
  const std::u32string swapped = {U'a', 0x301, 0x323}, ordered = {U'a', 0x323, 0x301};
  EXPECT_EQ(normalized(swapped, UnicodeForm::kDecomposed), ordered);  // below comes before above
  EXPECT_EQ(normalized(U"", UnicodeForm::kComposed), U"");
}

TEST(Lowered, CharacterByCharacter) {
  EXPECT_EQ(lowered(U"AbÉŽ"), U"abéž");
  EXPECT_EQ(lowered(U"ΟΔΟΣ"), U"οδοσ");
  EXPECT_EQ(lowered(std::u32string(1, 0x130)), (std::u32string{U'i', 0x307}));
}

TEST(LoweredInContext, SigmaIsFinalAtTheEndOfAWord) {
  EXPECT_EQ(lowered_in_context(U"ΟΔΟΣ"), U"οδος");
  EXPECT_EQ(lowered_in_context(U"ΣΑΣ ΣΑ"), U"σας σα");
  EXPECT_EQ(lowered_in_context(U"Σ"), U"σ");        // no letter before
  EXPECT_EQ(lowered_in_context(U"ΑΣ.Α"), U"ασ.α");  // a dot does not end it
  EXPECT_EQ(lowered_in_context(U"ΑΣ'"), U"ας'");
}

TEST(Categories, KnowExamples) {
  for (const char32_t c : std::u32string_view(U"aZéßªʰ漢ع"))
    EXPECT_TRUE(is_letter(c)) << static_cast<unsigned>(c);
  for (const char32_t c : std::u32string_view(U"09²½Ⅷ٣"))
    EXPECT_TRUE(is_number(c) && !is_letter(c)) << static_cast<unsigned>(c);
  for (const char32_t c : std::u32string_view(U"!\"#$%&'()*+,-./:;<=>?@[\\]^_`{|}~«»—、"))
    EXPECT_TRUE(is_punctuation(c)) << static_cast<unsigned>(c);
  for (const char32_t c : std::u32string_view(U"a0 €©"))
    EXPECT_FALSE(is_punctuation(c)) << static_cast<unsigned>(c);
  for (const char32_t c : {0x9, 0xA, 0xB, 0xC, 0xD, 0x20, 0x85, 0xA0, 0x2003, 0x2028, 0x3000})
    EXPECT_TRUE(is_space(c)) << static_cast<unsigned>(c);
  for (const char32_t c : {0x0, 0x1C, 0x200B, 0x200D, 0x2581, 0xFEFF})
    EXPECT_FALSE(is_space(c)) << static_cast<unsigned>(c);
  for (const char32_t c : {0x0, 0x7F, 0xAD, 0x200B, 0x200D, 0xE000, 0xFEFF})
    EXPECT_TRUE(is_invisible(c)) << static_cast<unsigned>(c);
  EXPECT_FALSE(is_invisible(U' '));
  EXPECT_TRUE(is_nonspacing_mark(0x301));
  EXPECT_FALSE(is_nonspacing_mark(0x903));  // a spacing mark
  EXPECT_TRUE(is_cjk(0x4E00) && is_cjk(0x9FFF) && is_cjk(0x20000) && is_cjk(0xF900));
  EXPECT_FALSE(is_cjk(0x3042) || is_cjk(0xAC00));  // hiragana, hangul
}

}  // namespace
}  // namespace ovimap
