// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/calibration/calibration_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

using FloatImage = Image<float>;

struct Step {
  int x, y;
};
constexpr Step kSteps[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};

/// Whether the surface at (x, y) ends towards `step` before a farther one. Depth that is missing
/// between both is the sensor's shadow; a surface of one pixel is no surface but a mixed pixel.
bool ends_towards(const DepthImage& depth, int x, int y, Step step, int max_hole,
                  const CalibrationEdgesConfig& config) {
  const float here = depth.at(x, y);
  const float jump = config.jump_m + config.jump_share * here;
  for (const int inside : {1, 2}) {
    const int u = x - inside * step.x, v = y - inside * step.y;
    if (!depth.contains(u, v) || !(std::abs(depth.at(u, v) - here) < jump / 2)) return false;
  }
  for (int i = 1; i <= max_hole + 1; ++i) {
    const int u = x + i * step.x, v = y + i * step.y;
    if (!depth.contains(u, v)) return false;
    if (depth.at(u, v) > 0) return depth.at(u, v) > here + jump;
  }
  return false;
}

std::vector<DepthEdge> depth_edges(const DepthImage& depth, const PinholeCamera& camera,
                                   const CalibrationEdgesConfig& config) {
  std::vector<DepthEdge> edges;
  const int max_hole = static_cast<int>(config.max_hole * static_cast<float>(depth.width()));
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      const float here = depth.at(x, y);
      if (!(here > 0)) continue;
      for (const Step step : kSteps) {
        if (!ends_towards(depth, x, y, step, max_hole, config)) continue;
        const auto right = static_cast<float>(step.x), down = static_cast<float>(step.y);
        const Eigen::Vector3f x_in_depth = camera.unproject(static_cast<float>(x) + right / 2,
                                                            static_cast<float>(y) + down / 2, here);
        edges.push_back({x_in_depth,
                         {right * here / camera.fx, down * here / camera.fy, 0},
                         step.x != 0 ? EdgeSide::kBeside : EdgeSide::kAbove});
      }
    }
  return edges;
}

/// Evenly spread, so that any part of the image keeps its share.
std::vector<DepthEdge> thinned(std::vector<DepthEdge> edges, int max_points) {
  const auto wanted = static_cast<std::size_t>(max_points);
  if (edges.size() <= wanted) return edges;
  for (std::size_t i = 0; i < wanted; ++i) edges[i] = edges[i * edges.size() / wanted];
  edges.resize(wanted);
  return edges;
}

float luma(Rgb8 pixel) {
  return 0.299f * pixel.r + 0.587f * pixel.g + 0.114f * pixel.b;
}

struct Gradient {
  FloatImage x, y, size;
};

/// Sobel's, in brightness per pixel; 0 at the border.
Gradient gradient_of(const RgbImage& color) {
  const int width = color.width(), height = color.height();
  FloatImage bright(width, height);
  for (std::size_t i = 0; i < color.size(); ++i) bright[i] = luma(color[i]);
  Gradient gradient{FloatImage(width, height), FloatImage(width, height),
                    FloatImage(width, height)};
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      const float *above = bright.row(y - 1) + x, *here = bright.row(y) + x,
                  *below = bright.row(y + 1) + x;
      const float gx =
          (above[1] + 2 * here[1] + below[1] - above[-1] - 2 * here[-1] - below[-1]) / 8;
      const float gy =
          (below[-1] + 2 * below[0] + below[1] - above[-1] - 2 * above[0] - above[1]) / 8;
      gradient.x.at(x, y) = gx;
      gradient.y.at(x, y) = gy;
      gradient.size.at(x, y) = std::hypot(gx, gy);
    }
  return gradient;
}

/// The step that `share` of the pixels exceed, at least `least`.
float strong_step(const FloatImage& size, float share, float least) {
  std::vector<float> sorted(size.begin(), size.end());
  const auto rank =
      static_cast<std::ptrdiff_t>((1 - share) * static_cast<float>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
  return std::max(sorted[static_cast<std::size_t>(rank)], least);
}

/// Lower envelope of parabolas (Felzenszwalb and Huttenlocher 2012): squared distances along a
/// line of squared distances.
void transform_line(std::vector<float>& line, std::vector<float>& out, std::vector<int>& centers,
                    std::vector<float>& borders) {
  const int count = static_cast<int>(line.size());
  const auto at = [&line](int i) { return line[static_cast<std::size_t>(i)]; };
  int last = 0;
  centers[0] = 0;
  borders[0] = -std::numeric_limits<float>::infinity();
  borders[1] = std::numeric_limits<float>::infinity();
  for (int i = 1; i < count; ++i) {
    float cut = 0;
    for (;; --last) {
      const int k = centers[static_cast<std::size_t>(last)];
      cut = ((at(i) + static_cast<float>(i * i)) - (at(k) + static_cast<float>(k * k))) /
            static_cast<float>(2 * (i - k));
      if (cut > borders[static_cast<std::size_t>(last)]) break;
    }
    ++last;
    centers[static_cast<std::size_t>(last)] = i;
    borders[static_cast<std::size_t>(last)] = cut;
    borders[static_cast<std::size_t>(last) + 1] = std::numeric_limits<float>::infinity();
  }
  for (int i = 0, k = 0; i < count; ++i) {
    while (borders[static_cast<std::size_t>(k) + 1] < static_cast<float>(i)) ++k;
    const int center = centers[static_cast<std::size_t>(k)];
    out[static_cast<std::size_t>(i)] = static_cast<float>((i - center) * (i - center)) + at(center);
  }
}

void transform_lines(FloatImage& squared, bool columns) {
  const int lines = columns ? squared.width() : squared.height();
  const int length = columns ? squared.height() : squared.width();
  std::vector<float> line(static_cast<std::size_t>(length)), out(line.size()),
      borders(line.size() + 1);
  std::vector<int> centers(line.size());
  for (int i = 0; i < lines; ++i) {
    const auto pixel = [&](std::size_t k) -> float& {
      return columns ? squared.at(i, static_cast<int>(k)) : squared.at(static_cast<int>(k), i);
    };
    for (std::size_t k = 0; k < line.size(); ++k) line[k] = pixel(k);
    transform_line(line, out, centers, borders);
    for (std::size_t k = 0; k < line.size(); ++k) pixel(k) = out[k];
  }
}

/// Distance of every pixel to the nearest edge of `side`, in steps, at most `reach_px`.
Image<std::uint8_t> distances(const Gradient& gradient, float strong, EdgeSide side,
                              float reach_px) {
  constexpr float kFar = 1e8f;
  const int width = gradient.size.width(), height = gradient.size.height();
  FloatImage squared(width, height, kFar);
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      const float size = gradient.size.at(x, y);
      if (!(size > strong)) continue;
      const float across = std::abs(gradient.x.at(x, y)), along = std::abs(gradient.y.at(x, y));
      const float own = side == EdgeSide::kBeside ? across : along;
      if (own < 0.5f * std::max(across, along)) continue;
      const int dx = across > 0.414f * along ? (gradient.x.at(x, y) > 0 ? 1 : -1) : 0;
      const int dy = along > 0.414f * across ? (gradient.y.at(x, y) > 0 ? 1 : -1) : 0;
      if (size >= gradient.size.at(x - dx, y - dy) && size > gradient.size.at(x + dx, y + dy))
        squared.at(x, y) = 0;
    }
  transform_lines(squared, true);
  transform_lines(squared, false);
  Image<std::uint8_t> steps(width, height);
  const float limit = std::min(255.f, reach_px * CalibrationEdges::kStepsPerPixel);
  for (std::size_t i = 0; i < steps.size(); ++i)
    steps[i] = static_cast<std::uint8_t>(
        std::min(limit, std::sqrt(squared[i]) * CalibrationEdges::kStepsPerPixel) + 0.5f);
  return steps;
}

}  // namespace

void list_fields(CalibrationEdgesConfig& config, ConfigFields& fields) {
  fields.add("jump_m", config.jump_m, 0.f, 10.f, "step in depth that is an edge, metres");
  fields.add("jump_share", config.jump_share, 0.f, 1.f, "with this share of the depth");
  fields.add("max_hole", config.max_hole, 0.f, 1.f,
             "missing depth behind an edge, share of the width");
  fields.add("max_points", config.max_points, 10, 1000000, "edge points of a frame");
  fields.add("color_share", config.color_share, 0.f, 1.f,
             "share of the pixels that may be colour edges");
  fields.add("min_color_step", config.min_color_step, 0.f, 255.f,
             "weaker colour steps are no edges");
  fields.add("reach", config.reach, 0.001f, 1.f,
             "how far distances to colour edges are known, share of the width");
}

CalibrationEdges find_calibration_edges(const Frame& frame, const CalibrationEdgesConfig& config) {
  CalibrationEdges edges;
  edges.depth = thinned(depth_edges(frame.depth, frame.depth_camera, config), config.max_points);
  const Gradient gradient = gradient_of(frame.color);
  const float strong = strong_step(gradient.size, config.color_share, config.min_color_step);
  const float reach_px = config.reach * static_cast<float>(frame.color.width());
  for (const EdgeSide side : {EdgeSide::kBeside, EdgeSide::kAbove})
    edges.color_distance[static_cast<std::size_t>(side)] =
        distances(gradient, strong, side, reach_px);
  return edges;
}

}  // namespace ovimap
