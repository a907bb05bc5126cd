// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/approach/gaps.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

constexpr float kCell_m = 0.08f;
constexpr int kSide = 8;  // of a cube of empty cells

/// A cube of cells that were looked through, walls around it but for the side at x = kSide.
struct OpenBox {
  SeenFree::Regions regions;
  SurfaceErrors walls;

  OpenBox() {
    regions[pack_index({0, 0, 0})].fill({6, 0, false});
    for (int a = -1; a <= kSide; ++a)
      for (int b = -1; b <= kSide; ++b)
        for (const BlockIndex& block :
             {BlockIndex(-1, a, b), BlockIndex(a, -1, b), BlockIndex(a, kSide, b),
              BlockIndex(a, b, -1), BlockIndex(a, b, kSide)})
          walls[pack_index(block)] = 0.002f;
  }
  std::vector<Gap> gaps(const GapsConfig& config = {}) const {
    SeenFree space;
    space.restore(regions);
    return find_gaps(space, walls, kCell_m, config);
  }
};

TEST(Gaps, WhereNobodyLookedIsTheOpenSide) {
  const std::vector<Gap> gaps = OpenBox().gaps();
  ASSERT_EQ(gaps.size(), 1u);
  EXPECT_EQ(gaps[0].kind, GapKind::kUnseen);
  EXPECT_NEAR(gaps[0].middle.x(), (kSide + 0.5f) * kCell_m, 1e-5f);
  // The cells beside the walls are left out: rays graze there.
  EXPECT_NEAR(gaps[0].area_m2, (kSide - 2) * (kSide - 2) * kCell_m * kCell_m, 1e-4f);
  EXPECT_NEAR(gaps[0].box.sizes().y(), (kSide - 2) * kCell_m, 1e-5f);
}

TEST(Gaps, ASideThatSurfaceClosesIsNone) {
  OpenBox box;
  for (int y = -1; y <= kSide; ++y)
    for (int z = -1; z <= kSide; ++z) box.walls[pack_index({kSide, y, z})] = 0.002f;
  EXPECT_TRUE(box.gaps().empty());
}

TEST(Gaps, WhereSomethingWasSeenIsNone) {
  OpenBox box;
  SpaceRegion& beyond = box.regions[pack_index({1, 0, 0})];
  beyond.fill({0, 8, false});
  EXPECT_TRUE(box.gaps().empty());
}

TEST(Gaps, SurfaceThatIsKnownTooLittleIsThin) {
  OpenBox box;
  for (int y = 0; y < 6; ++y)
    for (int z = 0; z < 6; ++z) box.walls[pack_index({-1, y, z})] = 0.02f;
  const std::vector<Gap> gaps = box.gaps();
  ASSERT_EQ(gaps.size(), 2u);
  const Gap& thin = gaps[gaps[0].kind == GapKind::kThin ? 0 : 1];
  EXPECT_NEAR(thin.area_m2, 36 * kCell_m * kCell_m, 1e-4f);
  EXPECT_NEAR(thin.middle.x(), -0.5f * kCell_m, 1e-5f);
}

TEST(Gaps, SmallOnesAndTooManyAreLeftOut) {
  OpenBox box;
  EXPECT_TRUE(box.gaps({.least_area_m2 = 1.f}).empty());
  box.regions[pack_index({5, 0, 0})].fill({6, 0, false});
  EXPECT_EQ(box.gaps().size(), 5u) << "large ones are cut into places to go to";
  const std::vector<Gap> one = box.gaps({.most = 1});
  ASSERT_EQ(one.size(), 1u);
  EXPECT_GT(one[0].middle.x(), 3.f) << "the cube without walls is the larger gap";
}

TEST(Gaps, OfNoSpaceNothingIsUnseen) {
  EXPECT_TRUE(find_gaps(SeenFree(), OpenBox().walls, kCell_m).empty());
}

}  // namespace
}  // namespace ovimap
