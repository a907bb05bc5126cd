// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <queue>
#include <vector>

#include "ovimap/segment/depth_segmentation.h"

/// Depth segmentation written pixel by pixel, as plainly as possible: what the fast one must equal,
/// and what bench/micro measures it against.
namespace ovimap::plain {

/// Unbroken pixels from (x, y) in one direction, at most the radius.
inline int arm(const DepthSurface& surface, int x, int y, int dx, int dy) {
  for (int length = 0; length < surface.radius_px; ++length, x += dx, y += dy) {
    if (!surface.breaks.contains(x + dx, y + dy)) return length;
    const auto bit = dx != 0 ? DepthSurface::kRight : DepthSurface::kBelow;
    if (surface.breaks.at(std::min(x, x + dx), std::min(y, y + dy)) & bit) return length;
  }
  return surface.radius_px;
}

struct Plane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float depth_m = 0, slope = 0;
};

/// The plane through the window of a pixel, by normal equations in double.
inline Plane fit_plane(const DepthImage& depth, const DepthSurface& surface,
                       const PinholeCamera& camera, int x, int y) {
  double n = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0, q = 0, qu = 0, qv = 0;
  if (depth.at(x, y) <= 0.f) return {};
  const double center = 1. / depth.at(x, y);
  for (int row = y - arm(surface, x, y, 0, -1); row <= y + arm(surface, x, y, 0, 1); ++row) {
    for (int column = x - arm(surface, x, row, -1, 0); column <= x + arm(surface, x, row, 1, 0);
         ++column) {
      const double du = column - x, dv = row - y, dq = 1. / depth.at(column, row) - center;
      n += 1, u += du, v += dv, uu += du * du, uv += du * dv, vv += dv * dv;
      q += dq, qu += dq * du, qv += dq * dv;
    }
  }
  const double cuu = uu / n - u / n * u / n, cvv = vv / n - v / n * v / n,
               cuv = uv / n - u / n * v / n;
  const double cuq = qu / n - u / n * q / n, cvq = qv / n - v / n * q / n;
  const double det = cuu * cvv - cuv * cuv;
  if (det <= 1e-3) return {Eigen::Vector3f::Zero(), depth.at(x, y), 0};
  const double a = (cuq * cvv - cvq * cuv) / det, b = (cvq * cuu - cuq * cuv) / det;
  const double c = center + q / n - a * u / n - b * v / n;
  if (c <= 0) return {Eigen::Vector3f::Zero(), depth.at(x, y), 0};
  const Eigen::Vector3d direction(a * camera.fx, b * camera.fy,
                                  c + a * (double{camera.cx} - x) + b * (double{camera.cy} - y));
  return {(-direction.normalized()).cast<float>(), static_cast<float>(1 / c),
          static_cast<float>(c / direction.norm())};
}

/// 1 - cos(angle) of a concave fold between two pixels, 0 when there is none strong enough.
inline float fold(const DepthSurface& surface, const PinholeCamera& camera,
                  const SegmentDepthConfig& config, const Eigen::Vector2i& a,
                  const Eigen::Vector2i& b) {
  const Eigen::Vector3f n1 = surface.normals.at(a.x(), a.y()),
                        n2 = surface.normals.at(b.x(), b.y());
  if (n1.isZero() || n2.isZero()) return 0.f;
  const float depth = surface.smooth_depth_m.at(a.x(), a.y());
  const float step_m = 0.05f;  // thresholds go by steps of depth
  const float middle =
      (static_cast<float>(std::min(static_cast<int>(depth / step_m), 199)) + 0.5f) * step_m;
  const float angle =
      std::max(config.concave_angle_rad,
               config.concave_sigmas * std::sqrt(2.f) * surface.noise.normal.at(middle) *
                   normal_sigma_rad(middle, surface.radius_px, camera, config.surface.noise));
  const float strength = 1.f - n1.dot(n2);
  if (strength < 1.f - std::cos(std::min(angle, 3.f))) return 0.f;
  const auto point = [&](const Eigen::Vector2i& p) {
    return camera.unproject(static_cast<float>(p.x()), static_cast<float>(p.y()),
                            surface.smooth_depth_m.at(p.x(), p.y()));
  };
  return (point(b) - point(a)).dot(n1 - n2) > 0.f ? strength : 0.f;
}

inline Image<std::uint8_t> concave_edges(const DepthSurface& surface, const PinholeCamera& camera,
                                         const SegmentDepthConfig& config) {
  const int width = surface.breaks.width(), height = surface.breaks.height();
  Image<float> folds[2] = {Image<float>(width, height), Image<float>(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int axis = 0; axis < 2; ++axis) {
        const int dx = axis == 0, dy = axis == 1;
        const int before = arm(surface, x, y, -dx, -dy), after = arm(surface, x, y, dx, dy);
        if (before + after >= surface.radius_px)
          folds[axis].at(x, y) = fold(surface, camera, config, {x - before * dx, y - before * dy},
                                      {x + after * dx, y + after * dy});
      }
  const int reach = std::max(1, surface.radius_px / 3);
  Image<std::uint8_t> edges(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int axis = 0; axis < 2; ++axis) {
        const float strength = folds[axis].at(x, y);
        bool ridge = strength > 0.f;
        for (int k = -reach; k <= reach; ++k) {
          const int nx = x + (axis == 0 ? k : 0), ny = y + (axis == 1 ? k : 0);
          if (folds[axis].contains(nx, ny) && folds[axis].at(nx, ny) > strength) ridge = false;
        }
        if (ridge) edges.at(x, y) = 1;
      }
  return edges;
}

/// 4-connected components of the pixels whose surface goes on to all sides and that touch no
/// concave edge.
inline Image<std::uint32_t> interiors(const DepthSurface& surface,
                                      const Image<std::uint8_t>& edges) {
  const int width = edges.width(), height = edges.height();
  const auto interior = [&](int x, int y) {
    if (x < 1 || y < 1 || x >= width - 1 || y >= height - 1) return false;
    for (int ny = y - 1; ny <= y + 1; ++ny)
      for (int nx = x - 1; nx <= x + 1; ++nx)
        if (edges.at(nx, ny)) return false;
    return arm(surface, x, y, -1, 0) > 0 && arm(surface, x, y, 1, 0) > 0 &&
           arm(surface, x, y, 0, -1) > 0 && arm(surface, x, y, 0, 1) > 0;
  };
  Image<std::uint32_t> labels(width, height);
  std::uint32_t last = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (labels.at(x, y) || !interior(x, y)) continue;
      std::queue<Eigen::Vector2i> open;
      open.emplace(x, y);
      labels.at(x, y) = ++last;
      for (; !open.empty(); open.pop())
        for (const Eigen::Vector2i& step : {Eigen::Vector2i(1, 0), Eigen::Vector2i(-1, 0),
                                            Eigen::Vector2i(0, 1), Eigen::Vector2i(0, -1)}) {
          const Eigen::Vector2i next = open.front() + step;
          if (!interior(next.x(), next.y()) || labels.at(next.x(), next.y())) continue;
          labels.at(next.x(), next.y()) = last;
          open.push(next);
        }
    }
  return labels;
}

/// Pixels without a region join that of the nearest seed among their neighbours, ring by ring.
inline void grow(const DepthSurface& surface, const PinholeCamera& camera,
                 const SegmentDepthConfig& config, Image<std::uint32_t>& labels) {
  const int width = labels.width(), height = labels.height();
  const auto point = [&](int x, int y) {
    return camera.unproject(static_cast<float>(x), static_cast<float>(y),
                            surface.smooth_depth_m.at(x, y));
  };
  Image<Eigen::Vector2i> seeds(width, height, Eigen::Vector2i::Constant(-1));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (labels.at(x, y)) seeds.at(x, y) = {x, y};
  for (int ring = 0; ring < config.regrow_px; ++ring) {
    Image<Eigen::Vector2i> next = seeds;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (seeds.at(x, y).x() >= 0 || surface.smooth_depth_m.at(x, y) <= 0.f) continue;
        float nearest = config.regrow_m * config.regrow_m;
        for (int ny = y - 1; ny <= y + 1; ++ny)
          for (int nx = x - 1; nx <= x + 1; ++nx) {
            if (!seeds.contains(nx, ny) || seeds.at(nx, ny).x() < 0) continue;
            const Eigen::Vector2i& seed = seeds.at(nx, ny);
            const float distance = (point(seed.x(), seed.y()) - point(x, y)).squaredNorm();
            if (distance < nearest) nearest = distance, next.at(x, y) = seed;
          }
      }
    seeds = next;
  }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (seeds.at(x, y).x() >= 0)
        labels.at(x, y) = labels.at(seeds.at(x, y).x(), seeds.at(x, y).y());
}

/// Region ids of a depth image whose surface is known.
inline IdImage segment(const DepthSurface& surface, const PinholeCamera& camera,
                       const SegmentDepthConfig& config) {
  Image<std::uint32_t> labels = interiors(surface, concave_edges(surface, camera, config));
  grow(surface, camera, config, labels);
  std::vector<int> area(labels.size() + 1, 0);
  for (const std::uint32_t label : labels) ++area[label];
  std::vector<std::uint16_t> ids(area.size(), 0);
  std::uint16_t last = 0;
  for (std::size_t label = 1; label < area.size(); ++label)
    if (area[label] >= config.min_region_px) ids[label] = ++last;
  IdImage result(labels.width(), labels.height());
  for (std::size_t i = 0; i < labels.size(); ++i) result[i] = ids[labels[i]];
  return result;
}

}  // namespace ovimap::plain
