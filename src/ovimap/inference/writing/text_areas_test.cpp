// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/writing/text_areas.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovimap {
namespace {

/// Probability 0.9 in a rectangle, 0.05 elsewhere.
Image<float> drawn(const TextArea& area) {
  Image<float> image(160, 120, 0.05f);
  const Eigen::Vector2f across(-area.along.y(), area.along.x());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const Eigen::Vector2f at = Eigen::Vector2f(x, y) - area.center_px;
      if (std::abs(at.dot(area.along)) <= 0.5f * area.length_px &&
          std::abs(at.dot(across)) <= 0.5f * area.height_px)
        image.at(x, y) = 0.9f;
    }
  return image;
}

TextArea turned_by(float degrees) {
  const float angle = degrees * 3.14159265f / 180.f;
  return {{80, 60}, {std::cos(angle), std::sin(angle)}, 70, 14};
}

class TurnedLine : public testing::TestWithParam<float> {};

TEST_P(TurnedLine, IsFoundAsItLies) {
  const TextArea truth = turned_by(GetParam());
  const auto areas = find_text_areas(drawn(truth), {.growth = 0.f});
  ASSERT_EQ(areas.size(), 1u);
  EXPECT_LT((areas[0].center_px - truth.center_px).norm(), 1.f);
  EXPECT_NEAR(areas[0].length_px, truth.length_px, 3.f);
  EXPECT_NEAR(areas[0].height_px, truth.height_px, 3.f);
  EXPECT_GT(std::abs(areas[0].along.dot(truth.along)), 0.995f);
  if (std::abs(GetParam()) < 70.f) {
    EXPECT_GT(areas[0].along.x(), 0.f);
  }
}

INSTANTIATE_TEST_SUITE_P(TextAreas, TurnedLine, testing::Values(0.f, 20.f, -35.f, 60.f, 90.f));

TEST(TextAreas, LinesThatStandUprightAreReadUpwards) {
  const auto areas = find_text_areas(drawn(turned_by(90)), {});
  ASSERT_EQ(areas.size(), 1u);
  EXPECT_LT(areas[0].along.y(), -0.99f);
}

TEST(TextAreas, GrowByTheRatioOfAreaToOutline) {
  const TextArea truth = turned_by(0);
  const TextArea tight = find_text_areas(drawn(truth), {.growth = 0.f}).at(0);
  const TextArea grown = find_text_areas(drawn(truth), {.growth = 1.5f}).at(0);
  const float more =
      1.5f * tight.length_px * tight.height_px / (2 * (tight.length_px + tight.height_px));
  EXPECT_NEAR(grown.length_px - tight.length_px, 2 * more, 1e-3f);
  EXPECT_NEAR(grown.height_px - tight.height_px, 2 * more, 1e-3f);
}

TEST(TextAreas, FaintAndThinOnesAreLeftOut) {
  TextArea thin = turned_by(0);
  thin.height_px = 1;
  EXPECT_TRUE(find_text_areas(drawn(thin), {}).empty());
  const Image<float> faint = drawn(turned_by(0));
  EXPECT_TRUE(find_text_areas(faint, {.area_level = 0.95f}).empty());
  EXPECT_TRUE(find_text_areas(Image<float>(), {}).empty());
}

TEST(TextAreas, PartsThatTouchAtACornerAreOne) {
  Image<float> image(40, 40, 0.f);
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) image.at(5 + i, 5 + j) = image.at(15 + i, 15 + j) = 1.f;
  EXPECT_EQ(find_text_areas(image, {}).size(), 1u);
  image.at(14, 14) = 0.f;
  EXPECT_EQ(find_text_areas(image, {}).size(), 2u);
}

}  // namespace
}  // namespace ovimap
