// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/frame/rectification.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/error.h"
#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr std::size_t kRectifiedRowsPerTask = 32;
constexpr std::int64_t kMostPixels = std::int64_t{1} << 24;  ///< each takes 8 bytes of table
constexpr double kLeastShown = 0.25;                         ///< of the pinhole's picture

std::optional<Rectification> rectification(const PinholeCamera& camera, const Lens& lens,
                                           const char* name) {
  if (lens.model == Lens::Model::kStraight) return std::nullopt;
  return Rectification(camera, lens, name);
}

/// a and b mixed, b weighing `share` of 256: a number of 16 bits.
unsigned mix(unsigned a, unsigned b, unsigned share) {
  return a * (256 - share) + b * share;
}

std::uint8_t mix(unsigned top, unsigned bottom, unsigned share, unsigned half) {
  return static_cast<std::uint8_t>((top * (256 - share) + bottom * share + half) >> 16);
}

}  // namespace

Rectification::Rectification(const PinholeCamera& camera, const Lens& lens, const char* name)
    : width_(camera.width), height_(camera.height) {
  const auto pixels = static_cast<std::int64_t>(width_) * height_;
  if (width_ < 2 || height_ < 2 || pixels > kMostPixels)
    throw Error(concat("the ", name, " camera has images of ", width_, "x", height_,
                       ", which cannot be rectified; accepted are sides from 2 and up to ",
                       kMostPixels, " pixels"));
  origins_.resize(static_cast<std::size_t>(pixels));
  parallel_for(static_cast<std::size_t>(height_), kRectifiedRowsPerTask, [&](std::size_t row) {
    for (int u = 0; u < width_; ++u) {
      const Eigen::Vector2d bent = lens.bend({(u - double{camera.cx}) / camera.fx,
                                              (static_cast<double>(row) - camera.cy) / camera.fy});
      const double x = bent.x() * camera.fx + camera.cx, y = bent.y() * camera.fy + camera.cy;
      Origin& origin =
          origins_[row * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)];
      // Written so that what is not a number is not shown.
      origin.shown = x >= -0.5 && y >= -0.5 && x <= width_ - 0.5 && y <= height_ - 0.5;
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      const double x_in = std::clamp(x, 0., width_ - 1.), y_in = std::clamp(y, 0., height_ - 1.);
      const int left = std::min(static_cast<int>(x_in), width_ - 2),
                top = std::min(static_cast<int>(y_in), height_ - 2);
      const auto share = [](double part) {
        return static_cast<std::uint8_t>(std::min(255., std::floor(part * 256)));
      };
      origin.index = top * width_ + left;
      origin.right = share(x_in - left);
      origin.down = share(y_in - top);
    }
  });
  const auto shown = std::count_if(origins_.begin(), origins_.end(),
                                   [](const Origin& origin) { return origin.shown; });
  if (static_cast<double>(shown) < kLeastShown * static_cast<double>(origins_.size()))
    throw Error(concat("the distortion of the ", name, " camera shows only ",
                       100 * shown / static_cast<std::ptrdiff_t>(origins_.size()),
                       "% of a picture without it; check the model and the order of its "
                       "coefficients"));
}

RgbImage Rectification::color(const RgbImage& bent) const {
  OVIMAP_ASSERT(bent.width() == width_ && bent.height() == height_);
  RgbImage straight(width_, height_);
  constexpr unsigned kHalf = 1u << 15;
  const auto mixed = [](const Rgb8* at, const Rgb8* below, const Origin& o, auto channel) {
    return mix(mix(channel(at[0]), channel(at[1]), o.right),
               mix(channel(below[0]), channel(below[1]), o.right), o.down, kHalf);
  };
  const std::size_t grain = kRectifiedRowsPerTask * static_cast<std::size_t>(width_);
  parallel_for(origins_.size(), grain, [&](std::size_t i) {
    const Origin& origin = origins_[i];
    const Rgb8* at = bent.data() + origin.index;
    const Rgb8* below = at + width_;
    straight[i] = {mixed(at, below, origin, [](const Rgb8& p) -> unsigned { return p.r; }),
                   mixed(at, below, origin, [](const Rgb8& p) -> unsigned { return p.g; }),
                   mixed(at, below, origin, [](const Rgb8& p) -> unsigned { return p.b; })};
  });
  return straight;
}

template <class Pixel>
Image<Pixel> Rectification::nearest(const Image<Pixel>& bent) const {
  OVIMAP_ASSERT(bent.width() == width_ && bent.height() == height_);
  Image<Pixel> straight(width_, height_);
  const std::size_t grain = kRectifiedRowsPerTask * static_cast<std::size_t>(width_);
  parallel_for(origins_.size(), grain, [&](std::size_t i) {
    const Origin& origin = origins_[i];
    if (!origin.shown) return;
    straight[i] = bent[static_cast<std::size_t>(origin.index + (origin.right >= 128 ? 1 : 0) +
                                                (origin.down >= 128 ? width_ : 0))];
  });
  return straight;
}

template Image<float> Rectification::nearest(const Image<float>& bent) const;
template Image<std::uint16_t> Rectification::nearest(const Image<std::uint16_t>& bent) const;

RigRectification::RigRectification(const CameraRig& rig)
    : color_(rectification(rig.color_camera, rig.color_lens, "colour")),
      depth_(rectification(rig.depth_camera, rig.depth_lens, "depth")) {}

void RigRectification::apply(Frame& frame) const {
  if (color_) frame.color = color_->color(frame.color);
  if (depth_) frame.depth = depth_->depth(frame.depth);
}

IdImage RigRectification::color_ids(IdImage ids) const {
  return color_ ? color_->ids(ids) : std::move(ids);
}

}  // namespace ovimap
