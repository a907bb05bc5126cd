// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/writing/text_areas.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "ovimap/geometry/convex_hull.h"

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

/// Around the corners of the pixels, so that a row of pixels has a height.
TextArea rectangle_around(const std::vector<Pixel>& pixels) {
  std::vector<Eigen::Vector2f> corners;
  for (const Pixel& pixel : pixels)
    for (const float dx : {-0.5f, 0.5f})
      for (const float dy : {-0.5f, 0.5f})
        corners.emplace_back(static_cast<float>(pixel.x) + dx, static_cast<float>(pixel.y) + dy);
  const PlaneRectangle found = smallest_rectangle(convex_hull(std::move(corners)));
  return {found.center, found.along, found.sides.x(), found.sides.y()};
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
  TextArea area = rectangle_around(pixels);
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
