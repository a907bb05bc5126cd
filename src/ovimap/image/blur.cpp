// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/image/blur.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ovimap/image/brightness.h"

namespace ovimap {

namespace {

// Cameras add noise of two levels or so of 255.
constexpr int kTurn = 8;        // levels: a smaller way back does not end a rise
constexpr int kLeastRise = 24;  // levels
// Of the edges, weighed by their height, so many are narrower than what is told: those at the very
// end owe that to noise and to clipped light.
constexpr float kNarrowShare = 0.25f;

struct Edge {
  float width_px;
  float height;  ///< levels
};

using Line = std::vector<int>;  ///< brightness of its pixels, 0 to 255

/// Where the way from `begin` to `end` reaches `level` after pixel `before`, in pixels.
float crossing(const Line& line, int before, float level) {
  const auto i = static_cast<std::size_t>(before);
  const auto a = static_cast<float>(line[i]), b = static_cast<float>(line[i + 1]);
  return static_cast<float>(before) + (level - a) / (b - a);
}

/// Twice the way that the middle half of a rise or fall takes, which what lies beside an edge, like
/// shading, does not lengthen.
Edge edge_between(const Line& line, int begin, int end) {
  const auto from = static_cast<float>(line[static_cast<std::size_t>(begin)]);
  const float way = static_cast<float>(line[static_cast<std::size_t>(end)]) - from;
  const auto share = [&](int i) {
    return (static_cast<float>(line[static_cast<std::size_t>(i)]) - from) / way;
  };
  int high = begin;
  while (share(high) < 0.75f) ++high;
  int low = high - 1;
  while (share(low) > 0.25f) --low;
  return {2.f * (crossing(line, high - 1, from + 0.75f * way) -
                 crossing(line, low, from + 0.25f * way)),
          std::abs(way)};
}

/// All rises and falls of a line.
void find_edges(const Line& line, std::vector<Edge>& edges) {
  const auto level = [&](int i) { return line[static_cast<std::size_t>(i)]; };
  int begin = 0, extreme = 0, sign = 1;
  const auto close = [&] {
    if (std::abs(level(extreme) - level(begin)) >= kLeastRise)
      edges.push_back(edge_between(line, begin, extreme));
  };
  for (int i = 1; i < static_cast<int>(line.size()); ++i) {
    const int further = sign * (level(i) - level(extreme));
    if (further > 0) {
      extreme = i;
    } else if (further < -kTurn) {
      close();
      begin = extreme, extreme = i, sign = -sign;
    }
  }
  if (!line.empty()) close();
}

EdgeWidth narrow_width(std::vector<Edge>& edges) {
  if (edges.empty()) return {};
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.width_px != b.width_px ? a.width_px < b.width_px : a.height < b.height;
  });
  double all = 0, narrower = 0;
  for (const Edge& edge : edges) all += double{edge.height};
  const auto told = std::find_if(edges.begin(), edges.end(), [&](const Edge& edge) {
    return (narrower += double{edge.height}) >= double{kNarrowShare} * all;
  });
  return {std::max(1.f, told->width_px), static_cast<int>(edges.size())};
}

}  // namespace

Blur measure_blur(const RgbImage& image, int line_step) {
  std::vector<Edge> across, down;
  Line line;
  for (int y = line_step / 2; y < image.height(); y += line_step) {
    line.resize(static_cast<std::size_t>(image.width()));
    std::transform(image.row(y), image.row(y) + image.width(), line.begin(), brightness);
    find_edges(line, across);
  }
  for (int x = line_step / 2; x < image.width(); x += line_step) {
    line.resize(static_cast<std::size_t>(image.height()));
    for (int y = 0; y < image.height(); ++y)
      line[static_cast<std::size_t>(y)] = brightness(image.row(y)[x]);
    find_edges(line, down);
  }
  return {narrow_width(across), narrow_width(down)};
}

}  // namespace ovimap
