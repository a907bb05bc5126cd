// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/natural_order.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(NaturalOrder, DigitsCountAsNumbers) {
  std::vector<std::string> names = {"10.jpg", "a2b10",  "2.jpg", "a2b9", "a10b1",
                                    "1.jpg",  "02.jpg", "a",     ""};
  std::sort(names.begin(), names.end(), natural_less);
  EXPECT_EQ(names, (std::vector<std::string>{"", "1.jpg", "02.jpg", "2.jpg", "10.jpg", "a", "a2b9",
                                             "a2b10", "a10b1"}));
}

TEST(NaturalOrder, IsAStrictOrder) {
  const std::vector<std::string> names = {"",    "0",  "00", "1",  "01", "a",  "a0",
                                          "a00", "a1", "b",  "1a", "1b", "10a"};
  for (const auto& a : names) {
    EXPECT_FALSE(natural_less(a, a));
    for (const auto& b : names) {
      EXPECT_EQ(natural_less(a, b) || natural_less(b, a), a != b) << a << " " << b;
      EXPECT_FALSE(natural_less(a, b) && natural_less(b, a)) << a << " " << b;
    }
  }
}

TEST(NaturalOrder, NumbersOfAnyLength) {
  EXPECT_TRUE(natural_less("9999999999999999999999", "10000000000000000000000"));
}

}  // namespace
}  // namespace ovimap
