// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/consensus/indexed_map.h"

#include <string>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

IndexedMap<std::string> three() {
  return IndexedMap<std::string>({{7, "seven"}, {1, "one"}, {4000000000u, "many"}});
}

TEST(IndexedMap, IsAskedByNumberAndGoneThroughInOrder) {
  IndexedMap<std::string> map = three();
  EXPECT_EQ(*map.find(7), "seven");
  EXPECT_EQ(map.find(2), nullptr);
  map[3] = "three";
  map.erase(7);
  map.erase(8);
  EXPECT_EQ(map.find(7), nullptr);
  EXPECT_EQ(map.ordered(), (std::map<std::uint32_t, std::string>{
                               {1, "one"}, {3, "three"}, {4000000000u, "many"}}));
}

TEST(IndexedMap, ACopyHasValuesOfItsOwn) {
  IndexedMap<std::string> map = three();
  IndexedMap<std::string> copy = map;
  copy[1] = "changed";
  EXPECT_EQ(*map.find(1), "one");
  map = copy;
  EXPECT_EQ(*map.find(1), "changed");
  map[1] = "again";
  EXPECT_EQ(copy.ordered().at(1), "changed");
  const IndexedMap<std::string> moved = std::move(copy);
  EXPECT_EQ(moved.find(1), &moved.ordered().at(1));
}

TEST(IndexedMap, ValuesStayWhereTheyAreWhileOthersCome) {
  IndexedMap<int> map;
  int& first = map[5] = 50;
  for (std::uint32_t number = 100; number < 5000; ++number) map[number] = 1;
  EXPECT_EQ(&first, map.find(5));
  EXPECT_EQ(first, 50);
}

}  // namespace
}  // namespace ovimap
