// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/pictures/pictures_raster.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerBand = 32;
constexpr std::size_t kVerticesPerTask = 4096;
constexpr double kEdgeSlack = 1e-9;  // so that rounding leaves no gap between neighbours
constexpr float kNothing = -std::numeric_limits<float>::infinity();

/// A corner on the screen; nearness is linear there and grows towards the viewer.
struct Corner {
  double x = 0, y = 0, nearness = 0;
};

struct ScreenTriangle {
  std::array<Corner, 3> corners;
  std::uint32_t source = 0;
};

Corner project(const RasterView& view, const Eigen::Vector3f& p) {
  const PinholeCamera& camera = view.camera;
  const double scale = view.orthographic ? 1.0 : 1.0 / p.z();
  return {camera.fx * p.x() * scale + camera.cx, camera.fy * p.y() * scale + camera.cy,
          view.orthographic ? -p.z() : scale};
}

bool faces_away(const RasterView& view, const std::array<Eigen::Vector3f, 3>& t) {
  const Eigen::Vector3f normal = (t[1] - t[0]).cross(t[2] - t[0]);
  return view.orthographic ? normal.z() >= 0 : normal.dot(t[0]) >= 0;
}

/// The part of a triangle beyond the near plane: up to four corners, returned as their number.
int clip_to_near(const std::array<Eigen::Vector3f, 3>& t, float near_m,
                 std::array<Eigen::Vector3f, 4>& clipped) {
  int count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f &from = t[i], &to = t[(i + 1) % 3];
    const bool from_in = from.z() >= near_m, to_in = to.z() >= near_m;
    if (from_in) clipped[static_cast<std::size_t>(count++)] = from;
    if (from_in != to_in)
      clipped[static_cast<std::size_t>(count++)] =
          from + (near_m - from.z()) / (to.z() - from.z()) * (to - from);
  }
  return count;
}

std::vector<Eigen::Vector3f> vertices_in_camera(const Mesh& mesh, const RasterView& view) {
  const Eigen::Isometry3f camera_from_world = view.world_from_camera.inverse().cast<float>();
  std::vector<Eigen::Vector3f> vertices(mesh.vertices.size());
  parallel_for(vertices.size(), kVerticesPerTask,
               [&](std::size_t i) { vertices[i] = camera_from_world * mesh.vertices[i]; });
  return vertices;
}

std::vector<ScreenTriangle> screen_triangles(const Mesh& mesh, const RasterView& view) {
  const std::vector<Eigen::Vector3f> vertices = vertices_in_camera(mesh, view);
  std::vector<ScreenTriangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const std::array<Eigen::Vector3f, 3> triangle = {vertices[a], vertices[b], vertices[c]};
    if (view.cull_back_faces && faces_away(view, triangle)) continue;
    std::array<Eigen::Vector3f, 4> clipped;
    const int count = clip_to_near(triangle, view.near_m, clipped);
    for (int k = 2; k < count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      triangles.push_back(
          {{project(view, clipped[0]), project(view, clipped[at - 1]), project(view, clipped[at])},
           static_cast<std::uint32_t>(i)});
    }
  }
  return triangles;
}

/// Draws one triangle into the rows [first_row, end_row).
void draw_triangle(const ScreenTriangle& triangle, int first_row, int end_row,
                   Image<float>& nearness, Image<std::uint32_t>& source) {
  const auto& [a, b, c] = triangle.corners;
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (area == 0) return;
  const auto bound = [](double value, int low, int high) {
    return static_cast<int>(std::clamp(value, static_cast<double>(low), static_cast<double>(high)));
  };
  const int top = bound(std::ceil(std::min({a.y, b.y, c.y})), first_row, end_row);
  const int bottom = bound(std::floor(std::max({a.y, b.y, c.y})) + 1, first_row, end_row);
  const int left = bound(std::ceil(std::min({a.x, b.x, c.x})), 0, source.width());
  const int right = bound(std::floor(std::max({a.x, b.x, c.x})) + 1, 0, source.width());
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const double wa = ((b.x - x) * (c.y - y) - (b.y - y) * (c.x - x)) / area;
      const double wb = ((c.x - x) * (a.y - y) - (c.y - y) * (a.x - x)) / area;
      const double wc = 1 - wa - wb;
      if (std::min({wa, wb, wc}) < -kEdgeSlack) continue;
      const auto near = static_cast<float>(wa * a.nearness + wb * b.nearness + wc * c.nearness);
      if (near <= nearness.at(x, y)) continue;
      nearness.at(x, y) = near;
      source.at(x, y) = triangle.source;
    }
}

}  // namespace

Eigen::Vector3f point_in_camera(const RasterView& view, int u, int v, float depth_m) {
  const auto x = static_cast<float>(u), y = static_cast<float>(v);
  if (!view.orthographic) return view.camera.unproject(x, y, depth_m);
  return {(x - view.camera.cx) / view.camera.fx, (y - view.camera.cy) / view.camera.fy, depth_m};
}

RasterResult rasterize(const Mesh& mesh, const RasterView& view) {
  return PartRasterizer(view).draw(mesh);
}

PartRasterizer::PartRasterizer(const RasterView& view)
    : view_(view), nearness_(view.camera.width, view.camera.height, kNothing) {}

RasterResult PartRasterizer::draw(const Mesh& part) {
  const int width = view_.camera.width, height = view_.camera.height;
  RasterResult result{Image<std::uint32_t>(width, height, RasterResult::kNoTriangle),
                      Image<float>(width, height)};
  const std::vector<ScreenTriangle> triangles = screen_triangles(part, view_);
  // A band of rows belongs to one task, so no two tasks write the same pixel.
  parallel_for_ranges(static_cast<std::size_t>(height), kRowsPerBand,
                      [&](std::size_t begin, std::size_t end) {
                        for (const ScreenTriangle& triangle : triangles)
                          draw_triangle(triangle, static_cast<int>(begin), static_cast<int>(end),
                                        nearness_, result.triangle);
                        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                          for (int x = 0; x < width; ++x) {
                            if (result.triangle.at(x, y) == RasterResult::kNoTriangle) continue;
                            const float near = nearness_.at(x, y);
                            result.depth_m.at(x, y) = view_.orthographic ? -near : 1 / near;
                          }
                      });
  return result;
}

}  // namespace ovimap
