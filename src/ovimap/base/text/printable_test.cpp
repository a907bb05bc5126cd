// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/text/printable.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(PrintableTest, TextsOfAnyScriptStay) {
  for (const char* text : {"", "mug 12", "Tür", "青い椅子", "كرسي", "🪑", "\xED\x9F\xBF"}) {
    EXPECT_TRUE(is_printable(text)) << text;
    EXPECT_EQ(printable(text), text);
  }
}

TEST(PrintableTest, WhatATerminalObeysIsReplaced) {
  EXPECT_EQ(printable("a\x1b]0;x\a"), "a\uFFFD]0;x\uFFFD");
  EXPECT_EQ(printable("two\nlines"), "two\uFFFDlines");
  for (const char* text :
       {"\t", "\x7f", "\u009b2J", "\u0085", "\u202e", "\u2028", "\u2066", "\u200f", "\u061c"})
    EXPECT_FALSE(is_printable(text)) << text;
}

TEST(PrintableTest, BytesOfNoCharacterAreReplaced) {
  for (const char* text :
       {"\x80", "\xC0\xAF", "\xE2\x82", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF8\x88\x80\x80\x80"})
    EXPECT_FALSE(is_printable(text)) << text;
  EXPECT_EQ(printable("a\xE2\x82z"), "a\uFFFD\uFFFDz");
}

}  // namespace
}  // namespace ovimap
