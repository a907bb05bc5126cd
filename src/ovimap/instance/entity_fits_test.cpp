// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/instance/entity_fits.h"

#include <gtest/gtest.h>

namespace ovimap {
namespace {

constexpr std::uint8_t kHalf = 128, kThird = 85;  // of 255

/// Super-points of 60, 30 and 10 points; the last two are in no frame with entities of their own.
SurfaceExtents extents() {
  SurfaceExtents all;
  for (const auto& [label, points] : {std::pair<Label, int>{1, 60}, {2, 30}, {3, 10}})
    for (int i = 0; i < points; ++i) all[label].add({0.01f * static_cast<float>(i), 0, 0});
  return all;
}

TEST(EntityFits, ComparesEachFramesBestEntityWithWhatIsInSight) {
  const SurfaceExtents surface = extents();
  const EntitySightings sightings{
      {1, {{0, 1}, {1, 1, kHalf}, {2, 4}}}, {2, {{0, 1}, {1, 2, kThird}}}, {3, {{0, 2}}}};
  const EntityFits fits(surface, sightings);
  const std::vector<EntityFit> both = fits.of(std::vector<Label>{1, 2});
  ASSERT_EQ(both.size(), 3u);
  EXPECT_FLOAT_EQ(both[0].overlap, 1.f) << "one entity shows both";
  EXPECT_FLOAT_EQ(both[1].overlap, 60.f / 90) << "the larger one's, in the better mask";
  EXPECT_EQ(both[1].entity.rating, kHalf);
  EXPECT_FLOAT_EQ(both[2].overlap, 1.f) << "the other one is out of sight";
  EXPECT_FLOAT_EQ(fits.of(std::vector<Label>{1})[0].overlap, 60.f / 90);
  EXPECT_FLOAT_EQ(fits.confidence(std::vector<Label>{1, 2}), (2 + 60.f / 90 * kHalf / 255) / 5);
}

TEST(EntityFits, OfWhatNoEntityShowedThereAreNone) {
  const SurfaceExtents surface = extents();
  const EntitySightings sightings{{1, {{0, 1}}}};
  const EntityFits fits(surface, sightings);
  EXPECT_TRUE(fits.of(std::vector<Label>{2, 9}).empty());
  EXPECT_EQ(fits.confidence(std::vector<Label>{2, 9}), 0.f);
}

}  // namespace
}  // namespace ovimap
