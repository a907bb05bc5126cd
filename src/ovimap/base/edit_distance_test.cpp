// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/edit_distance.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(EditDistance, CountsLetters) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("mask", ""), 4u);
  EXPECT_EQ(edit_distance("mask", "masks"), 1u);
  EXPECT_EQ(edit_distance("frames", "fames"), 1u);
  EXPECT_EQ(edit_distance("query", "qeury"), 1u);
  EXPECT_EQ(edit_distance("abcdef", "badcfe"), 3u);
  EXPECT_EQ(edit_distance("ca", "abc"), 3u);  // no letter is touched twice
}

TEST(LikelyWord, IsOneThatIsNearOrBegins) {
  const std::vector<std::string> words = {"help", "frames", "json", "max-memory", "set"};
  EXPECT_EQ(likely_word("frame", words), "frames");
  EXPECT_EQ(likely_word("jsno", words), "json");
  EXPECT_EQ(likely_word("max-mem", words), "max-memory");
  EXPECT_EQ(likely_word("ste", words), "set");
  EXPECT_EQ(likely_word("JSON", words), "json");
  EXPECT_EQ(likely_word("poses", words), "");
  EXPECT_EQ(likely_word("j", words), "");
  EXPECT_EQ(likely_word("x", {}), "");
}

}  // namespace
}  // namespace ovimap
