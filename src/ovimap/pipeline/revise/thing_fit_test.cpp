// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/revise/thing_fit.h"

#include <cmath>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// The sides of a box with a lower box beside it, as a chair, about their mean.
Points chair(bool seen_from_the_front_alone) {
  Points points;
  for (float z = 0; z < 0.8f; z += 0.02f)
    for (float x = 0; x < 0.4f; x += 0.02f) {
      if (z < 0.4f || x < 0.1f) points.emplace_back(x, 0.f, z);
      if (!seen_from_the_front_alone && (z < 0.4f || x < 0.1f)) points.emplace_back(x, 0.3f, z);
    }
  for (float z = 0; z < 0.8f; z += 0.02f)
    for (float y = 0; y < 0.3f; y += 0.02f) {
      if (!seen_from_the_front_alone) points.emplace_back(0.f, y, z);
      points.emplace_back(z < 0.4f ? 0.4f : 0.1f, y, z);
    }
  return points;
}

ThingLook look_of(Points points, std::array<std::uint8_t, 3> color, float turn) {
  ThingLook look;
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& point : points) mean += point / static_cast<float>(points.size());
  float squares = 0;
  for (const Eigen::Vector3f& point : points) {
    look.points.push_back(Eigen::AngleAxisf(turn, Eigen::Vector3f::UnitZ()) * (point - mean));
    squares += (point - mean).squaredNorm();
  }
  look.colors.assign(points.size(), color);
  look.reach_m = std::sqrt(squares / static_cast<float>(points.size()));
  return look;
}

/// Where nobody has looked.
ThingFit fit_unseen(const ThingLook& gone, const ThingLook& found) {
  const VoxelMap empty;
  const ObservedSpace nothing(empty, PinholeCamera(), {});
  return fit_things(gone, nothing, found, nothing, 0.01f);
}

TEST(ThingFit, AThingSeenFromOneSideIsItselfSeenFromAll) {
  const ThingLook all = look_of(chair(false), {200, 40, 40}, 0.f),
                  front = look_of(chair(true), {190, 50, 40}, 0.9f);
  ASSERT_LT(front.points.size(), 0.7 * static_cast<double>(all.points.size()));
  for (const ThingFit& fit : {fit_unseen(front, all), fit_unseen(all, front)}) {
    EXPECT_GT(fit.agreed, 0.45f);
    EXPECT_LT(fit.contradicted, 0.1f);
  }
}

TEST(ThingFit, OneOfAnotherColourIsAnother) {
  const ThingLook red = look_of(chair(false), {200, 40, 40}, 0.f),
                  blue = look_of(chair(false), {40, 40, 200}, 0.3f);
  const ThingFit fit = fit_unseen(red, blue);
  EXPECT_EQ(fit.agreed, 0.f);
  EXPECT_GT(fit.contradicted, 0.9f);
  EXPECT_EQ(fit.fit(), 0.f);
}

TEST(ThingFit, ThingsWithoutSurfaceFitNothing) {
  EXPECT_EQ(fit_unseen({}, look_of(chair(true), {}, 0.f)).fit(), 0.f);
}

TEST(LargePieces, LeavesOutWhatLiesApartAndIsLittle) {
  Points points = chair(false);
  const std::size_t all = points.size();
  for (int i = 0; i < 9; ++i) points.emplace_back(1.f, 1.f, 0.01f * static_cast<float>(i));
  EXPECT_EQ(large_pieces(points, 0.05f, 0.05f).size(), all);
  EXPECT_EQ(large_pieces(points, 0.05f, 0.001f).size(), all + 9);
  EXPECT_EQ(large_pieces(points, 2.f, 0.05f).size(), all + 9) << "one piece";
  EXPECT_EQ(large_pieces({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 0.05f, 0.5f).size(), 3u) << "all are little";
}

}  // namespace
}  // namespace ovimap
