// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/relations/object_measures.h"

#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

TEST(MeasureObjects, SayHowSurfaceIsSpread) {
  ObjectShape shape;  // a table of one square metre on a leg
  for (int i = 0; i < 50; ++i)
    for (int k = 0; k < 50; ++k)
      shape.surface.emplace_back(0.01f + 0.02f * static_cast<float>(i),
                                 0.01f + 0.02f * static_cast<float>(k), 0.75f);
  for (int i = 0; i < 500; ++i)
    shape.surface.emplace_back(0.5f, 0.5f, 0.0014f * static_cast<float>(i));
  shape.footprint = {{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}};
  shape.top_m = 0.75f;
  const ObjectMeasures found = measure_objects(std::span(&shape, 1)).front();
  EXPECT_NEAR(found.top_share, 2500.f / 3000.f, 0.01f);
  EXPECT_NEAR(found.covered_share, 500.f / 3000.f, 0.01f);
  shape.surface.clear();
  EXPECT_LT(measure_objects(std::span(&shape, 1)).front().top_share, 0.f);
}

TEST(MeasureObjects, MeasuresAlongTheObjectsOwnSides) {
  ObjectShape shape;  // 2 m by 1 m, turned by 45 degrees
  const float s = std::sqrt(0.5f);
  shape.footprint = {{0.f, 0.f}, {2 * s, 2 * s}, {s, 3 * s}, {-s, s}};
  shape.bottom_m = 1.f;
  shape.top_m = 1.5f;
  ObjectShape floor;
  floor.footprint = {{0.f, 0.f}, {5.f, 0.f}, {5.f, 5.f}};
  floor.bottom_m = floor.top_m = 0.3f;
  const std::vector<ObjectShape> shapes{shape, floor};
  const ObjectMeasures found = measure_objects(shapes)[0];
  EXPECT_NEAR(found.length_m, 2.f, 1e-5f);
  EXPECT_NEAR(found.depth_m, 1.f, 1e-5f);
  EXPECT_NEAR(found.height_m, 0.5f, 1e-6f);
  EXPECT_NEAR(found.bottom_m, 0.7f, 1e-6f);
  EXPECT_TRUE(measure_objects({}).empty());
}

}  // namespace
}  // namespace ovimap
