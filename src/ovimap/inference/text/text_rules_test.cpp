// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/text/text_rules.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(TextRule, NoneOnlyMendsTheEncoding) {
  EXPECT_EQ(apply_text_rule(TextRule::kNone, " A\tb "), " A\tb ");
  EXPECT_EQ(apply_text_rule(TextRule::kNone, "a\xFF"), "a\xEF\xBF\xBD");
}

TEST(TextRule, Siglip) {
  EXPECT_EQ(apply_text_rule(TextRule::kSiglip, "A photo of: a RED mug!"), "▁a photo of a red mug");
  EXPECT_EQ(apply_text_rule(TextRule::kSiglip, "  two\t\n blanks  "), "▁ two blanks");
  EXPECT_EQ(apply_text_rule(TextRule::kSiglip, "a ! b"), "▁a b");    // one space where two meet
  EXPECT_EQ(apply_text_rule(TextRule::kSiglip, "«É»—…"), "▁«é»—…");  // only ASCII punctuation
  EXPECT_EQ(apply_text_rule(TextRule::kSiglip, "a▁b"), "▁a b");
  EXPECT_EQ(apply_text_rule(TextRule::kSiglip, "ΟΔΟΣ"), "▁οδος");
  EXPECT_EQ(apply_text_rule(TextRule::kSiglip,
                            "a\x1C"
                            "b"),
            "▁a b");
  EXPECT_EQ(apply_text_rule(TextRule::kSiglip, ""), "▁");
  EXPECT_EQ(apply_text_rule(TextRule::kSiglip, " ?! "), "▁");
}

TEST(TextRule, Clip) {
  EXPECT_EQ(apply_text_rule(TextRule::kClip, "A  Photo\n\tOf it"), "a photo of it");
  EXPECT_EQ(apply_text_rule(TextRule::kClip, "CAFE\xCC\x81"), "caf\xC3\xA9");  // composed first
  EXPECT_EQ(apply_text_rule(TextRule::kClip, "İ"), "i\xCC\x87");               // but not after
}

TEST(TextRule, Bert) {
  EXPECT_EQ(apply_text_rule(TextRule::kBert, "Crème Brûlée, ÅNGSTRÖM"), "creme brulee, angstrom");
  EXPECT_EQ(apply_text_rule(TextRule::kBert, "a漢字b"), "a 漢  字 b");
  EXPECT_EQ(apply_text_rule(TextRule::kBert, std::string_view("a\0b\tc\x01\r\n", 8)), "ab c  ");
  EXPECT_EQ(apply_text_rule(TextRule::kBert, "zero\u200Bwidth\u00A0space"), "zerowidth space");
  EXPECT_EQ(apply_text_rule(TextRule::kBert, "bad\xFF"), "bad");
  EXPECT_EQ(apply_text_rule(TextRule::kBert, "한"), "\u1112\u1161\u11AB");
}

}  // namespace
}  // namespace ovimap
