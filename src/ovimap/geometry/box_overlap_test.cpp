// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/geometry/box_overlap.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

Eigen::AlignedBox2f box(float left, float top, float right, float bottom) {
  return {Eigen::Vector2f(left, top), Eigen::Vector2f(right, bottom)};
}

TEST(Overlap, IsIntersectionOverUnion) {
  EXPECT_FLOAT_EQ(overlap(box(0, 0, 1, 1), box(0, 0, 1, 1)), 1.f);
  EXPECT_FLOAT_EQ(overlap(box(0, 0, 1, 1), box(0.5f, 0, 1.5f, 1)), 1.f / 3);
  EXPECT_FLOAT_EQ(overlap(box(0, 0, 0.4f, 1), box(0.5f, 0, 1, 1)), 0.f);
  EXPECT_FLOAT_EQ(overlap(box(1, 1, 0, 0), box(0, 0, 1, 1)), 0.f) << "a box turned inside out";
}

}  // namespace
}  // namespace ovimap
