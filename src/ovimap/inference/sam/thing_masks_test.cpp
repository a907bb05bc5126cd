// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/sam/thing_masks.h"

#include <gtest/gtest.h>

#include "ovimap/base/error.h"

namespace ovimap {
namespace {

constexpr int kBasisRows = 2, kBasisColumns = 3, kImages = 2, kGridPx = 6;
constexpr int kKernels = kImages + FinderMaps::kPlaceTerms + 1;

/// Two images over the view: one of ones, one that counts columns.
FinderMaps drawn_maps() {
  FinderMaps maps;
  maps.rows = kBasisRows, maps.columns = kBasisColumns, maps.whole_columns = kBasisColumns;
  maps.kernels.assign(kKernels * kBasisRows * kBasisColumns, 0.f);
  for (int image = 0; image < kImages; ++image)
    for (int i = 0; i < 2 * kBasisRows * 2 * kBasisColumns; ++i)
      maps.basis.push_back(image == 0 ? 1.f : static_cast<float>(i % (2 * kBasisColumns)));
  return maps;
}

void set(FinderMaps& maps, int term, const Eigen::Vector2i& cell, float value) {
  maps.kernels[static_cast<std::size_t>((term * kBasisRows + cell.y()) * kBasisColumns +
                                        cell.x())] = value;
}

LogitGrid grid() {
  LogitGrid grid;
  grid.size = kGridPx, grid.width = 2 * kBasisColumns, grid.height = 2 * kBasisRows;
  return grid;
}

TEST(ThingMasks, AreSumsOfTheBasisAsTheCellWeighsIt) {
  const Eigen::Vector2i cell(1, 0);
  FinderMaps maps = drawn_maps();
  set(maps, 0, cell, 3);
  set(maps, 1, cell, -1);
  set(maps, kKernels - 1, cell, 0);
  const MaskProposals mask = ThingMasks(maps, kGridPx).mask_at(cell, grid());
  EXPECT_EQ(mask.tokens, 1);
  EXPECT_FLOAT_EQ(mask.predicted_iou.at(0), 0.5f);
  EXPECT_FLOAT_EQ(mask.logits.at(0), 3);
  EXPECT_FLOAT_EQ(mask.logits.at(kGridPx + 5), -2);
  EXPECT_LT(mask.logits.back(), -10);  // the image ends above
}

TEST(ThingMasks, KnowWhereAPixelLiesSeenFromTheCell) {
  const Eigen::Vector2i cell(1, 1);  // its middle is at 2.5, 2.5 of the grid
  FinderMaps maps = drawn_maps();
  set(maps, kImages + 1, cell, 32);       // x
  set(maps, kImages + 4, cell, 32 * 32);  // y squared
  const MaskProposals mask = ThingMasks(maps, kGridPx).mask_at(cell, grid());
  EXPECT_FLOAT_EQ(mask.logits.at(0), -2.5f + 6.25f);
  EXPECT_FLOAT_EQ(mask.logits.at(3 * kGridPx + 5), 2.5f + 0.25f);
}

TEST(ThingMasks, AreNoneOfAFinderThatGivesNone) {
  EXPECT_TRUE(ThingMasks({}, kGridPx).empty());
}

TEST(ThingMasks, RefuseADecoderOfAnotherGrid) {
  EXPECT_THROW(ThingMasks(drawn_maps(), 256), Error);
}

}  // namespace
}  // namespace ovimap
