// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/words/main_colors.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(MainColors, AreTheLargestFirst) {
  ColorShares shares{};
  shares[static_cast<std::size_t>(Color::kRed)] = 0.3f;
  shares[static_cast<std::size_t>(Color::kWhite)] = 0.62f;
  shares[static_cast<std::size_t>(Color::kBrown)] = 0.08f;
  const auto colors = main_colors(shares);
  ASSERT_EQ(colors.size(), 2u);
  EXPECT_EQ(colors[0], std::pair(Color::kWhite, 0.62f));
  EXPECT_EQ(colors[1], std::pair(Color::kRed, 0.3f));
}

TEST(MainColors, AreNoneWhereNotKnown) {
  EXPECT_TRUE(main_colors({}).empty());
}

}  // namespace
}  // namespace ovimap
