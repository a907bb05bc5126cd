// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/written_words.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

float share_of(const std::string& wanted, std::vector<WrittenLine> lines) {
  return match_writing(written_words(wanted), lines).share;
}

WrittenLine line(const std::string& text, float confidence = 1.f) {
  return {text, confidence, {}};
}

TEST(WrittenWords, AreLettersNumbersAndSignsOfNames) {
  EXPECT_EQ(written_words("The C++ book, 2nd (R&D)"),
            (std::vector<std::u32string>{U"c++", U"book", U"2nd", U"r&d"}));
  EXPECT_EQ(written_words(" ... the "), std::vector<std::u32string>{U"the"}) << "all there is";
  EXPECT_TRUE(written_words(" ... ").empty());
  EXPECT_EQ(written_words("ÉCOLE"), (std::vector<std::u32string>{U"école"}));
}

TEST(WrittenWords, MatchInAnyCaseAcrossLines) {
  EXPECT_FLOAT_EQ(share_of("mobile computer", {line("Mobile"), line("COMPUTER")}), 1.f);
  EXPECT_FLOAT_EQ(share_of("exit sign", {line("EXIT")}), 0.5f);
  EXPECT_FLOAT_EQ(share_of("exit", {line("EXIT", 0.8f)}), 0.8f);
  EXPECT_FLOAT_EQ(share_of("exit", {}), 0.f);
  EXPECT_FLOAT_EQ(share_of("", {line("EXIT")}), 0.f);
}

TEST(WrittenWords, AReadingMayErrInOneCharacterOfFour) {
  EXPECT_GT(share_of("Dedalus", {line("Dadalus")}), 0.8f);
  EXPECT_FLOAT_EQ(share_of("mug", {line("rug")}), 0.f);
  EXPECT_FLOAT_EQ(share_of("table", {line("cable car")}), 0.8f);
  EXPECT_FLOAT_EQ(share_of("milk", {line("silky")}), 0.f);
}

TEST(WrittenWords, TellsWhereTheyWereRead) {
  const std::vector<WrittenLine> lines{line("Mobil", 0.7f), line("Mobile", 0.9f)};
  const auto match = match_writing(written_words("mobile"), lines);
  EXPECT_EQ(match.line, &lines[1]);
  EXPECT_EQ(match_writing(written_words("radio"), lines).line, nullptr);
}

TEST(WrittenWords, OfReadingsOfOneTextTheSurestStays) {
  const auto lines = surest_readings({line("Exit", 0.6f), line("EXIT", 0.9f), line("2", 0.7f)});
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].text, "EXIT");
  EXPECT_EQ(lines[1].text, "2");
}

}  // namespace
}  // namespace ovimap
