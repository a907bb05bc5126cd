// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/memory/recently_used.h"

#include <string>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(RecentlyUsedTest, LetsGoWhatNobodyAskedForTheLongest) {
  RecentlyUsed<int, std::string> kept(10);
  kept.keep(1, "one", 4);
  kept.keep(2, "two", 4);
  EXPECT_EQ(kept.find(1), "one");
  kept.keep(3, "three", 4);
  EXPECT_EQ(kept.find(1), "one");
  EXPECT_EQ(kept.find(2), std::nullopt);
  EXPECT_EQ(kept.find(3), "three");
}

TEST(RecentlyUsedTest, KeepsTheFirstOfTwoThatWereMadeAtOnce) {
  RecentlyUsed<int, std::string> kept(10);
  kept.keep(1, "first", 4);
  kept.keep(1, "second", 4);
  EXPECT_EQ(kept.find(1), "first");
  kept.keep(2, "two", 6);
  EXPECT_EQ(kept.find(1), "first") << "it counts once";
}

TEST(RecentlyUsedTest, KeepsNothingThatIsLargerThanAll) {
  RecentlyUsed<int, std::string> kept(10);
  kept.keep(1, "huge", 11);
  EXPECT_EQ(kept.find(1), std::nullopt);
  kept.keep(2, "two", 10);
  EXPECT_EQ(kept.find(2), "two");
}

}  // namespace
}  // namespace ovimap
