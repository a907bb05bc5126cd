// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/geometry/geometry_scores.h"

#include <gtest/gtest.h>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

/// A square of `cells` x `cells` quads in the plane z = `height_m`, from the origin.
Mesh grid(int cells, float cell_m, float height_m) {
  Mesh mesh;
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x)
      mesh.vertices.emplace_back(static_cast<float>(x) * cell_m, static_cast<float>(y) * cell_m,
                                 height_m);
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (cells + 1) + x); };
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  return mesh;
}

TEST(GeometryScores, APerfectMapIsExact) {
  const GeometryScores scores = geometry_scores(grid(10, 0.1f, 0), grid(10, 0.1f, 0));
  EXPECT_EQ(scores.accuracy_m, 0);
  EXPECT_EQ(scores.accuracy_median_m, 0);
  EXPECT_EQ(scores.stray, 0);
  EXPECT_EQ(scores.completeness, 1);
  EXPECT_EQ(scores.fine_completeness, 1);
}

// The truth is one coarse quad, so only a distance to its face can be millimetres.
TEST(GeometryScores, AnOffsetPlaneIsOffByItsOffset) {
  const GeometryScores scores = geometry_scores(grid(1, 1.f, 0), grid(100, 0.01f, 0.003f));
  EXPECT_NEAR(scores.accuracy_m, 0.003, 1e-7);
  EXPECT_NEAR(scores.accuracy_median_m, 0.003, 1e-7);
  EXPECT_EQ(scores.completeness, 1);
  EXPECT_EQ(scores.fine_completeness, 1);
}

TEST(GeometryScores, MeanAndMedianAndStrayPartByHand) {
  Mesh points;
  points.vertices = {{0.5f, 0.5f, 0.01f}, {0.2f, 0.3f, -0.02f}, {0.7f, 0.6f, 0.06f}, {0, 0, 0.5f}};
  const GeometryScores scores = geometry_scores(grid(1, 1.f, 0), points);
  EXPECT_NEAR(scores.accuracy_m, 0.03, 1e-7);
  EXPECT_NEAR(scores.accuracy_median_m, 0.02, 1e-7);
  EXPECT_EQ(scores.stray, 0.25);
  EXPECT_EQ(scores.completeness, 0);  // no predicted vertex within 5 cm of the four corners
}

TEST(GeometryScores, CompletenessCountsCoveredTruth) {
  Mesh half = grid(10, 0.1f, 0.02f);
  half.vertices.resize(66);  // six of eleven rows
  std::erase_if(half.triangles,
                [](const auto& t) { return t[0] >= 66 || t[1] >= 66 || t[2] >= 66; });
  const GeometryScores scores = geometry_scores(grid(10, 0.1f, 0), half);
  EXPECT_DOUBLE_EQ(scores.completeness, 6.0 / 11);
  EXPECT_EQ(scores.fine_completeness, 0);  // 2 cm off everywhere
}

TEST(GeometryScores, EmptyMeshesScoreTheWorst) {
  for (const GeometryScores& scores :
       {geometry_scores(grid(1, 1, 0), Mesh{}), geometry_scores(Mesh{}, grid(1, 1, 0)),
        geometry_scores({}, {})}) {
    EXPECT_EQ(scores.accuracy_m, 0.2f);
    EXPECT_EQ(scores.completeness, 0);
    EXPECT_EQ(scores.fine_completeness, 0);
  }
}

TEST(GeometryScores, AreTheSameOnAnyThreadCount) {
  const auto with = [](int threads) {
    ThreadLimit limit(threads);
    return geometry_scores(grid(40, 0.031f, 0), grid(50, 0.023f, 0.013f)).accuracy_m;
  };
  EXPECT_EQ(with(1), with(2));
}

TEST(GeometryScores, ListsItsFields) {
  GeometryScoresConfig config;
  ConfigFields fields;
  list_fields(config, fields);
  fields.set("accuracy_limit_m", "0.4");
  EXPECT_EQ(fields.fields().size(), 3u);
  EXPECT_EQ(geometry_scores({}, {}, config).accuracy_m, 0.4f);
}

}  // namespace
}  // namespace ovimap
