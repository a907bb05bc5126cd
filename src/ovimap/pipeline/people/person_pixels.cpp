// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/people/person_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace ovimap {

namespace {

/// Whole pixels of a box, within an image.
Eigen::AlignedBox2i pixels_of(const Eigen::AlignedBox2f& box_px, int width, int height) {
  const Eigen::Vector2i last(width - 1, height - 1);
  const auto within = [&](const Eigen::Vector2f& point) {
    const Eigen::Vector2i pixel = point.array().round().cast<int>();
    return Eigen::Vector2i(pixel.cwiseMax(0).cwiseMin(last));
  };
  return {within(box_px.min()), within(box_px.max())};
}

/// Depth pixels that the colour image shows in the box.
std::vector<int> depth_pixels_in(const Image<std::int32_t>& places, const Eigen::AlignedBox2i& box,
                                 int color_width) {
  std::vector<int> pixels;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i] >= 0 &&
        box.contains(Eigen::Vector2i(places[i] % color_width, places[i] / color_width)))
      pixels.push_back(static_cast<int>(i));
  return pixels;
}

/// The middle half of a box, both ways.
Eigen::AlignedBox2i middle_of(const Eigen::AlignedBox2i& box) {
  const Eigen::Vector2i quarter = box.sizes() / 4;
  return {box.min() + quarter, box.max() - quarter};
}

/// Who is in the box stands before what is behind: the nearer third of its middle.
float body_depth_m(const DepthImage& depth, std::vector<int> pixels) {
  const auto third = pixels.begin() + static_cast<std::ptrdiff_t>(pixels.size() / 3);
  std::nth_element(pixels.begin(), third, pixels.end(), [&](int a, int b) {
    return depth[static_cast<std::size_t>(a)] < depth[static_cast<std::size_t>(b)];
  });
  return depth[static_cast<std::size_t>(*third)];
}

/// Grows from seeds over small steps of depth, within `allowed`; marks what it reaches with 2.
void grow_body(const DepthImage& depth, std::vector<int> seeds, float body_m,
               const PeopleConfig& config, Image<std::uint8_t>& allowed) {
  for (const int seed : seeds) allowed[static_cast<std::size_t>(seed)] = 2;
  while (!seeds.empty()) {
    const int pixel = seeds.back(), x = pixel % depth.width(), y = pixel / depth.width();
    seeds.pop_back();
    const float here_m = depth.at(x, y);
    for (const auto& [dx, dy] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      if (!depth.contains(x + dx, y + dy) || allowed.at(x + dx, y + dy) != 1) continue;
      const float there_m = depth.at(x + dx, y + dy);
      if (std::abs(there_m - here_m) > config.step_share * here_m ||
          std::abs(there_m - body_m) > config.reach_m)
        continue;
      allowed.at(x + dx, y + dy) = 2;
      seeds.push_back((y + dy) * depth.width() + x + dx);
    }
  }
}

/// Of the depth's size: 0 outside the box, 1 something else in it, 2 the body.
Image<std::uint8_t> body_in(const Frame& frame, const Image<std::int32_t>& places,
                            const Eigen::AlignedBox2i& box, const PeopleConfig& config) {
  const DepthImage& depth = frame.depth;
  const int color_width = frame.color.width();
  Image<std::uint8_t> body(depth.width(), depth.height());
  for (const int pixel : depth_pixels_in(places, box, color_width))
    body[static_cast<std::size_t>(pixel)] = 1;
  std::vector<int> seeds = depth_pixels_in(places, middle_of(box), color_width);
  if (seeds.empty()) return body;
  const float body_m = body_depth_m(depth, seeds);
  std::erase_if(seeds, [&](int pixel) {
    return std::abs(depth[static_cast<std::size_t>(pixel)] - body_m) > config.seed_m;
  });
  grow_body(depth, std::move(seeds), body_m, config, body);
  return body;
}

/// Along one line of pixels: those at most `radius` from one that is set.
template <class At>
void grow_line(int length, int radius, const At& at, std::vector<std::uint8_t>& out) {
  int last = -radius - 1;
  for (int i = 0; i < length; ++i) {
    if (at(i)) last = i;
    out[static_cast<std::size_t>(i)] = i - last <= radius;
  }
  last = length + radius;
  for (int i = length - 1; i >= 0; --i) {
    if (at(i)) last = i;
    out[static_cast<std::size_t>(i)] |= last - i <= radius;
  }
}

}  // namespace

Image<std::int32_t> color_places(const Frame& frame) {
  Image<std::int32_t> places(frame.depth.width(), frame.depth.height(), -1);
  const PinholeCamera &from = frame.depth_camera, &to = frame.color_camera;
  const Eigen::Isometry3f color_from_depth = frame.color_from_depth.cast<float>();
  for (int v = 0; v < places.height(); ++v)
    for (int u = 0; u < places.width(); ++u) {
      const float depth_m = frame.depth.at(u, v);
      if (!(depth_m > 0)) continue;
      const Eigen::Vector3f point =
          color_from_depth * from.unproject(static_cast<float>(u), static_cast<float>(v), depth_m);
      if (!(point.z() > 0)) continue;
      const Eigen::Vector2f seen = to.project(point);
      const float limit = static_cast<float>(std::max(to.width, to.height)) + 1;
      if (!(seen.cwiseAbs().maxCoeff() < limit)) continue;
      const auto x = static_cast<int>(std::lround(seen.x())),
                 y = static_cast<int>(std::lround(seen.y()));
      if (frame.color.contains(x, y)) places.at(u, v) = y * frame.color.width() + x;
    }
  return places;
}

PeopleMask pixels_by_depth(const Frame& frame, const Image<std::int32_t>& places,
                           const Eigen::AlignedBox2f& box_px, const PeopleConfig& config) {
  const Eigen::AlignedBox2i box = pixels_of(box_px, frame.color.width(), frame.color.height());
  const Image<std::uint8_t> body = body_in(frame, places, box, config);
  PeopleMask mask(frame.color.width(), frame.color.height());
  for (int y = box.min().y(); y <= box.max().y(); ++y)
    std::fill(mask.row(y) + box.min().x(), mask.row(y) + box.max().x() + 1, std::uint8_t{1});
  for (const std::uint8_t state :
       {std::uint8_t{1}, std::uint8_t{2}})  // a body hides what is behind
    for (std::size_t i = 0; i < body.size(); ++i)
      if (body[i] == state) mask[static_cast<std::size_t>(places[i])] = state == 2;
  return mask;
}

PeopleMask grown(const PeopleMask& mask, int radius_px) {
  PeopleMask result = mask;
  std::vector<std::uint8_t> line(static_cast<std::size_t>(std::max(mask.width(), mask.height())));
  for (int y = 0; y < mask.height(); ++y) {
    grow_line(
        mask.width(), radius_px, [&](int x) { return mask.at(x, y) != 0; }, line);
    std::copy_n(line.begin(), mask.width(), result.row(y));
  }
  for (int x = 0; x < mask.width(); ++x) {
    grow_line(
        mask.height(), radius_px, [&](int y) { return result.at(x, y) != 0; }, line);
    for (int y = 0; y < mask.height(); ++y) result.at(x, y) = line[static_cast<std::size_t>(y)];
  }
  return result;
}

Eigen::AlignedBox2f extent_of(const PeopleMask& mask) {
  Eigen::AlignedBox2f extent;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      if (mask.at(x, y))
        extent.extend(Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)));
  return extent;
}

}  // namespace ovimap
