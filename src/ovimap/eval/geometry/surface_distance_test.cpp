// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/eval/geometry/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

using Eigen::Vector3d;

TEST(SquaredDistance, OfEveryRegionOfATriangle) {
  const Vector3d a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);
  const auto to_triangle = [&](double x, double y, double z) {
    return squared_distance(Vector3d(x, y, z), a, b, c);
  };
  EXPECT_DOUBLE_EQ(to_triangle(1, 1, 2), 4);                // above the face
  EXPECT_DOUBLE_EQ(to_triangle(1, 1, -2), 4);               // below it
  EXPECT_DOUBLE_EQ(to_triangle(2, -1, 1), 2);               // beside an edge
  EXPECT_DOUBLE_EQ(to_triangle(2 + 0.6, 1.5 + 0.8, 0), 1);  // off the middle of the long edge
  EXPECT_DOUBLE_EQ(to_triangle(-1, -1, 1), 3);              // beyond a corner
  EXPECT_DOUBLE_EQ(to_triangle(6, 0, 0), 4);
  EXPECT_DOUBLE_EQ(to_triangle(1, 1, 0), 0);
}

TEST(SquaredDistance, OfDegenerateTriangles) {
  const Vector3d a(0, 0, 0), b(2, 0, 0);
  EXPECT_DOUBLE_EQ(squared_distance(Vector3d(1, 3, 0), a, a, b), 9);
  EXPECT_DOUBLE_EQ(squared_distance(Vector3d(5, 4, 0), a, b, Vector3d(1, 0, 0)), 25);
  EXPECT_DOUBLE_EQ(squared_distance(Vector3d(0, 3, 4), a, a, a), 25);
}

Mesh random_triangles(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1, 1), size(-0.2f, 0.2f);
  Mesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Eigen::Vector3f center(place(random), place(random), place(random));
    for (int k = 0; k < 3; ++k)
      mesh.vertices.push_back(center + Eigen::Vector3f(size(random), size(random), size(random)));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TEST(SurfaceDistance, AgreesWithBruteForce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-1.3f, 1.3f);
  for (const std::size_t count : {1, 4, 5, 9, 33, 700}) {
    const Mesh mesh = random_triangles(count, static_cast<unsigned>(count));
    const SurfaceDistance surface(mesh);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3f point(place(random), place(random), place(random));
      double best = std::numeric_limits<double>::max();
      for (const auto& [a, b, c] : mesh.triangles)
        best =
            std::min(best, squared_distance(point.cast<double>(), mesh.vertices[a].cast<double>(),
                                            mesh.vertices[b].cast<double>(),
                                            mesh.vertices[c].cast<double>()));
      const auto found = surface.find(point, 0.3f);
      ASSERT_EQ(found.has_value(), std::sqrt(best) <= 0.3) << count;
      EXPECT_NEAR(found.value_or(0), found ? std::sqrt(best) : 0, 1e-6);
    }
  }
}

TEST(SurfaceDistance, MeasuresPointsWhenThereAreNoTriangles) {
  Mesh points;
  points.vertices = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_FLOAT_EQ(SurfaceDistance(points).find({1, 0.5f, 0}, 1).value(), 0.5f);
}

TEST(SurfaceDistance, FindsNothingBeyondTheLimitOrInAnEmptyMesh) {
  Mesh points;
  points.vertices = {{0, 0, 0}};
  const SurfaceDistance surface(points);
  EXPECT_EQ(surface.find({0, 0, 0.5f}, 0.5f), 0.5f);
  EXPECT_EQ(surface.find({0, 0, 0.5001f}, 0.5f), std::nullopt);
  EXPECT_EQ(surface.find({0, 0, std::numeric_limits<float>::infinity()}, 0.5f), std::nullopt);
  EXPECT_EQ(SurfaceDistance(Mesh{}).find({0, 0, 0}, 1), std::nullopt);
}

}  // namespace
}  // namespace ovimap
