// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/spelling.h"

#include <gtest/gtest.h>

#include "ovimap/semantics/words/text_evidence.h"

namespace ovimap {
namespace {

TEST(MeantWord, IsNearToWhatNobodyKnows) {
  const Concepts& concepts = builtin_concepts();
  EXPECT_EQ(meant_word("chiar", concepts), "chair");
  EXPECT_EQ(meant_word("red Chiar", concepts), "chair");
  EXPECT_EQ(meant_word("chir", concepts), "chair");
  for (const char* text : {"chair", "chairs", "kitchen chair", "zyzzyva", "chr", "mu", ""})
    EXPECT_EQ(meant_word(text, concepts), "") << text;
}

}  // namespace
}  // namespace ovimap
