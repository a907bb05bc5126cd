// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/rooms/watershed.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

Image<float> row(const std::vector<float>& heights) {
  Image<float> image(static_cast<int>(heights.size()), 1);
  std::copy(heights.begin(), heights.end(), image.begin());
  return image;
}

std::vector<int> regions(const std::vector<float>& heights, const WatershedConfig& config) {
  const auto image = watershed(row(heights), config);
  return {image.begin(), image.end()};
}

TEST(Watershed, PartsAtLowPasses) {
  EXPECT_EQ(regions({3, 4, 1, 5, 2, 0, 2}, {1.5f, 0.5f}), (std::vector<int>{2, 2, 1, 1, 1, 0, 3}));
}

TEST(Watershed, APassThatIsWideOrHardlyLowerPartsNothing) {
  EXPECT_EQ(regions({3, 4, 1, 5, 2}, {0.9f, 0.5f}), (std::vector<int>{1, 1, 1, 1, 1}));
  EXPECT_EQ(regions({3, 4, 1, 5, 2}, {1.5f, 0.2f}), (std::vector<int>{1, 1, 1, 1, 1}));
}

TEST(Watershed, ARegionBehindAPassIsNotJoinedByAThird) {
  EXPECT_EQ(regions({6, 1, 5, 4, 5, 1, 6}, {1.5f, 0.5f}), (std::vector<int>{1, 1, 3, 3, 3, 2, 2}));
}

TEST(Watershed, MoreRegionsThanNumbersLeaveTheLowestWithout) {
  std::vector<float> heights;
  for (int i = 0; i < 70000; ++i) heights.insert(heights.end(), {100000.f - i, 0.f});
  const std::vector<int> found = regions(heights, {});
  EXPECT_EQ(found[0], 1);
  EXPECT_EQ(found[2 * 65534], 65535);
  EXPECT_EQ(found[2 * 65535], 0);
  EXPECT_EQ(found[2 * 69999], 0);
}

TEST(Watershed, RegionsDoNotCreepAlongTheirBorders) {
  // Two rooms side by side with low cells along their wall; the pass is in the middle.
  const std::vector<std::vector<float>> rows = {
      {1, 1, 1, 0, 1, 1, 1}, {1, 5, 1, 0, 1, 4, 1}, {1, 2, 1, 1, 1, 2, 1}, {1, 1, 1, 0, 1, 1, 1}};
  Image<float> heights(7, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 7; ++x)
      heights.at(x, y) = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
  const auto regions = watershed(heights, {1.f, 0.5f});
  for (int y = 0; y < 4; ++y)
    for (int x = 4; x < 7; ++x) EXPECT_EQ(regions.at(x, y), 2) << x << " " << y;
}

}  // namespace
}  // namespace ovimap
