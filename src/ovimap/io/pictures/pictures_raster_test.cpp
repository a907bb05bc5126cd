// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/pictures_raster.h"

#include <random>

#include <gtest/gtest.h>

#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

Mesh random_triangles(std::uint32_t count, unsigned seed, float nearest_m) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1, 1), depth(nearest_m, 4), size(-0.5f, 0.5f);
  Mesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Eigen::Vector3f center(place(random), place(random), depth(random));
    for (int k = 0; k < 3; ++k)
      mesh.vertices.push_back(center + Eigen::Vector3f(size(random), size(random), size(random)));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

RasterView pinhole_view() {
  RasterView view;
  view.camera = {48, 36, 40, 42, 23.3f, 18.1f};
  return view;
}

RasterView flat_view() {
  RasterView view;
  view.camera = {48, 36, 20, 20, 23.3f, 18.1f};
  view.orthographic = true;
  return view;
}

/// Depth along z where a ray meets a triangle (Cramer's rule), or 0.
double hit_depth(const Mesh& mesh, std::size_t triangle, const Eigen::Vector3d& origin,
                 const Eigen::Vector3d& direction) {
  const auto& t = mesh.triangles[triangle];
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
  Eigen::Matrix3d system;
  system.col(0) = mesh.vertices[t[1]].cast<double>() - a;
  system.col(1) = mesh.vertices[t[2]].cast<double>() - a;
  system.col(2) = -direction;
  if (std::abs(system.determinant()) < 1e-12) return 0;
  const Eigen::Vector3d solution = system.inverse() * (origin - a);
  const bool inside = solution.x() >= 0 && solution.y() >= 0 && solution.x() + solution.y() <= 1;
  return inside ? origin.z() + solution.z() * direction.z() : 0;
}

/// Compares every pixel with the nearest of all ray-triangle hits.
void expect_ray_cast(const Mesh& mesh, const RasterView& view) {
  const RasterResult raster = rasterize(mesh, view);
  int hits = 0, differing = 0;
  for (int y = 0; y < view.camera.height; ++y)
    for (int x = 0; x < view.camera.width; ++x) {
      const Eigen::Vector3d at = point_in_camera(view, x, y, 1.f).cast<double>();
      const Eigen::Vector3d origin =
          view.orthographic ? Eigen::Vector3d(at.x(), at.y(), 0) : Eigen::Vector3d(0, 0, 0);
      const Eigen::Vector3d direction = at - origin;
      double nearest = 0;
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double depth = hit_depth(mesh, i, origin, direction);
        if (depth >= view.near_m && (nearest == 0 || depth < nearest)) nearest = depth;
      }
      hits += nearest > 0;
      // A pixel centre on an edge may fall on either side of it.
      differing += std::abs(raster.depth_m.at(x, y) - nearest) > 1e-4 * (1 + nearest);
      EXPECT_EQ(raster.depth_m.at(x, y) > 0, raster.triangle.at(x, y) != RasterResult::kNoTriangle);
    }
  EXPECT_GT(hits, 300);
  EXPECT_LE(differing, 2);
}

TEST(Rasterize, SeesWhatRaysHit) {
  expect_ray_cast(random_triangles(60, 1, 1), pinhole_view());
  expect_ray_cast(random_triangles(60, 2, 1), flat_view());
}

TEST(Rasterize, CutsTrianglesThatReachBehindTheCamera) {
  RasterView view = pinhole_view();
  view.near_m = 0.3f;
  expect_ray_cast(random_triangles(80, 3, -0.5f), view);
}

TEST(Rasterize, MovesWithTheCamera) {
  const Mesh mesh = random_triangles(40, 4, 1);
  RasterView view = pinhole_view();
  const RasterResult expected = rasterize(mesh, view);
  view.world_from_camera.translate(Eigen::Vector3d(0.25, -1, 3))
      .rotate(Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()));
  Mesh moved = mesh;
  for (Eigen::Vector3f& vertex : moved.vertices)
    vertex = view.world_from_camera.cast<float>() * vertex;
  const RasterResult raster = rasterize(moved, view);
  int differing = 0;
  for (std::size_t i = 0; i < raster.triangle.size(); ++i)
    differing += raster.triangle[i] != expected.triangle[i];
  EXPECT_LE(differing, 3);
}

TEST(Rasterize, LeavesOutBackFacesWhenAsked) {
  Mesh mesh;
  mesh.vertices = {{-9, -9, 2}, {9, -9, 2}, {0, 9, 2}};
  mesh.triangles = {{0, 1, 2}};  // clockwise from behind: its normal is +z, away from the camera
  for (RasterView view : {pinhole_view(), flat_view()}) {
    EXPECT_EQ(rasterize(mesh, view).triangle.at(24, 18), 0u);
    view.cull_back_faces = true;
    EXPECT_EQ(rasterize(mesh, view).triangle.at(24, 18), RasterResult::kNoTriangle);
    Mesh turned = mesh;
    turned.triangles = {{0, 2, 1}};
    EXPECT_EQ(rasterize(turned, view).triangle.at(24, 18), 0u);
    EXPECT_NEAR(rasterize(turned, view).depth_m.at(24, 18), 2, 1e-5);
  }
}

TEST(Rasterize, NeighboursLeaveNoGap) {
  Mesh fan;  // a disc of thin triangles around a point between pixels
  fan.vertices.emplace_back(0.013f, 0.007f, 1.f);
  constexpr std::uint32_t kSpokes = 97;
  for (std::uint32_t i = 0; i < kSpokes; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / kSpokes;
    fan.vertices.emplace_back(5 * std::cos(angle), 5 * std::sin(angle), 1.f);
    fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % kSpokes});
  }
  for (const std::uint32_t triangle : rasterize(fan, pinhole_view()).triangle)
    EXPECT_NE(triangle, RasterResult::kNoTriangle);
}

TEST(Rasterize, IsTheSameOnAnyThreadCountAndTheFirstWinsTies) {
  Mesh mesh = random_triangles(200, 5, 1);
  const std::size_t half = mesh.triangles.size();
  mesh.triangles.insert(mesh.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
  const auto with = [&](int threads) {
    ThreadLimit limit(threads);
    return rasterize(mesh, pinhole_view()).triangle;
  };
  const Image<std::uint32_t> one = with(1);
  EXPECT_EQ(one, with(2));
  for (const std::uint32_t triangle : one)
    EXPECT_TRUE(triangle < half || triangle == RasterResult::kNoTriangle);
}

}  // namespace
}  // namespace ovimap
