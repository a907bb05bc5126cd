// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/writing/text_areas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>

namespace ovimap {

namespace {

struct Pixel {
  int x = 0, y = 0;
};

/// The pixels that hang together with `seed` above the level, corners included; they are taken off
/// `open`.
std::vector<Pixel> take_area(Image<std::uint8_t>& open, Pixel seed) {
  std::vector<Pixel> pixels{seed};
  open.at(seed.x, seed.y) = 0;
  for (std::size_t next = 0; next < pixels.size(); ++next) {
    const Pixel at = pixels[next];
    for (int y = at.y - 1; y <= at.y + 1; ++y)
      for (int x = at.x - 1; x <= at.x + 1; ++x) {
        if (!open.contains(x, y) || open.at(x, y) == 0) continue;
        open.at(x, y) = 0;
        pixels.push_back({x, y});
      }
  }
  return pixels;
}

float cross(const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Andrew's monotone chain over the corners of the pixels, so that a row of pixels has a height.
std::vector<Eigen::Vector2f> hull_of(const std::vector<Pixel>& pixels) {
  std::vector<Eigen::Vector2f> corners;
  for (const Pixel& pixel : pixels)
    for (const float dx : {-0.5f, 0.5f})
      for (const float dy : {-0.5f, 0.5f})
        corners.emplace_back(static_cast<float>(pixel.x) + dx, static_cast<float>(pixel.y) + dy);
  const auto before = [](const auto& a, const auto& b) {
    return std::tuple(a.x(), a.y()) < std::tuple(b.x(), b.y());
  };
  std::sort(corners.begin(), corners.end(), before);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<Eigen::Vector2f> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t first = hull.size();
    for (const Eigen::Vector2f& corner : corners) {
      while (hull.size() > first + 1 &&
             cross(hull.back() - hull[hull.size() - 2], corner - hull.back()) <= 0.f)
        hull.pop_back();
      hull.push_back(corner);
    }
    hull.pop_back();
    std::reverse(corners.begin(), corners.end());
  }
  return hull;
}

/// The smallest rectangle has a side on the hull (Freeman and Shapira 1975).
TextArea smallest_rectangle(const std::vector<Eigen::Vector2f>& hull) {
  TextArea best;
  float least = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2f side = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    const Eigen::Vector2f across(-side.y(), side.x());
    Eigen::Array2f low = Eigen::Array2f::Constant(std::numeric_limits<float>::max()), high = -low;
    for (const Eigen::Vector2f& corner : hull) {
      const Eigen::Array2f at(corner.dot(side), corner.dot(across));
      low = low.min(at);
      high = high.max(at);
    }
    const Eigen::Array2f size = high - low, middle = 0.5f * (low + high);
    if (size.prod() >= least) continue;
    least = size.prod();
    best = {middle.x() * side + middle.y() * across, side, size.x(), size.y()};
  }
  return best;
}

/// Turned so that it runs along its longer side, to the right or upwards.
TextArea as_line(TextArea area) {
  if (area.length_px < area.height_px) {
    area.along = {-area.along.y(), area.along.x()};
    std::swap(area.length_px, area.height_px);
  }
  constexpr float kUpright = 0.3f;  // of the direction: steeper than 73 degrees
  const bool upright = std::abs(area.along.x()) < kUpright;
  if (upright ? area.along.y() > 0.f : area.along.x() < 0.f) area.along = -area.along;
  return area;
}

std::optional<TextArea> area_of(const std::vector<Pixel>& pixels, const Image<float>& probability,
                                const TextAreaRule& rule) {
  double sum = 0;
  for (const Pixel& pixel : pixels) sum += double{probability.at(pixel.x, pixel.y)};
  if (sum < double{rule.area_level} * static_cast<double>(pixels.size())) return {};
  TextArea area = smallest_rectangle(hull_of(pixels));
  if (std::min(area.length_px, area.height_px) < static_cast<float>(rule.least_px)) return {};
  const float grown =
      rule.growth * area.length_px * area.height_px / (2.f * (area.length_px + area.height_px));
  area.length_px += 2.f * grown;
  area.height_px += 2.f * grown;
  return as_line(area);
}

}  // namespace

std::vector<TextArea> find_text_areas(const Image<float>& probability, const TextAreaRule& rule) {
  Image<std::uint8_t> open(probability.width(), probability.height());
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = probability[i] > rule.pixel_level;
  std::vector<TextArea> areas;
  for (int y = 0; y < open.height(); ++y)
    for (int x = 0; x < open.width(); ++x)
      if (open.at(x, y) != 0)
        if (const auto area = area_of(take_area(open, {x, y}), probability, rule))
          areas.push_back(*area);
  return areas;
}

}  // namespace ovimap
