// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/image/image.h"

#include <vector>

#include <gtest/gtest.h>

#include "ovimap/image/set_bytes.h"

namespace ovimap {
namespace {

TEST(Image, IsZeroWhateverItsMemoryHeldBefore) {
  for (int round = 0; round < 3; ++round) {
    DepthImage image(320, 240);
    for (const float pixel : image) ASSERT_EQ(pixel, 0.f);
    image.fill(7.f);
  }
}

TEST(Image, UnsetOnesHaveTheirSizeAndHoldWhatIsWritten) {
  auto image = DepthImage::unset(320, 240);
  EXPECT_EQ(image.width(), 320);
  EXPECT_EQ(image.height(), 240);
  EXPECT_EQ(image.size(), 320u * 240u);
  image.fill(2.f);
  EXPECT_EQ(image, DepthImage(320, 240, 2.f));
}

TEST(ForEachSet, VisitsEveryByteThatIsNotZeroInOrder) {
  for (const int count : {0, 1, 7, 8, 9, 40, 43}) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count));
    std::vector<int> set, visited;
    for (int i = 0; i < count; i += i % 3 ? 1 : 5) {
      bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(1 + i);
      set.push_back(i);
    }
    for_each_set(bytes.data(), count, [&](int i) { visited.push_back(i); });
    EXPECT_EQ(visited, set) << count;
  }
}

}  // namespace
}  // namespace ovimap
