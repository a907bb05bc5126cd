// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/shares.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(SharesTest, NobodyTakesAll) {
  Shares shares(10, 6);
  auto first = shares.take("a", 4);
  EXPECT_TRUE(first);
  EXPECT_FALSE(shares.take("a", 3));
  const auto second = shares.take("b", 6);
  EXPECT_TRUE(second);
  EXPECT_FALSE(shares.take("c", 1));
  EXPECT_TRUE(shares.take("c", 0));
  first.reset();
  EXPECT_TRUE(shares.take("c", 4));
  EXPECT_FALSE(shares.take("c", ~std::size_t{0}));
}

TEST(SharesTest, MayBeHeldLongerThanTheyLive) {
  std::shared_ptr<void> held;
  {
    Shares shares(1, 1);
    held = shares.take("a", 1);
  }
  held.reset();
}

}  // namespace
}  // namespace ovimap
