// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/semantics/views/telling_pixels.h"

#include <algorithm>

#include "ovimap/base/config.h"

namespace ovimap {

namespace {

constexpr int kFewEdges = 40;                  // fewer may all be shading, or what noise made
constexpr int kLines = 30;                     // rows, and columns, that are enough of a picture
constexpr int kDarkest = 4, kBrightest = 251;  // JPEG moves what is clipped by a little

bool is_clipped(Rgb8 pixel) {
  const auto [low, high] = std::minmax({pixel.r, pixel.g, pixel.b});
  return high <= kDarkest || low >= kBrightest;
}

Blur blur_of(const RgbImage& image) {
  return measure_blur(image, std::max(1, std::min(image.width(), image.height()) / kLines));
}

}  // namespace

float clipped_share(const ObjectCrop& crop) {
  int clipped = 0, all = 0;
  for (std::size_t i = 0; i < crop.mask.size(); ++i) {
    if (crop.mask[i] == 0) continue;
    ++all;
    clipped += is_clipped(crop.image[i]);
  }
  return all == 0 ? 0.f : static_cast<float>(clipped) / static_cast<float>(all);
}

/// How many pixels in this direction tell what one would if the picture were sharp.
float TellingPixels::samples_for_one(const EdgeWidth& crop, EdgeWidth Blur::*direction,
                                     float depth_per_color) {
  EdgeWidth width = crop;
  if (width.edges < kFewEdges) {
    if (!whole_) whole_ = blur_of(frame_.color);
    width = (*whole_).*direction;
  }
  return std::max(1.f, width.px * depth_per_color / config_.sharp_edge_px);
}

int TellingPixels::count(int visible_px, const ObjectCrop& crop) {
  if (config_.sharp_edge_px == 0.f) return visible_px;
  const Blur blur = blur_of(crop.image);
  const PinholeCamera &depth = frame_.depth_camera, &color = frame_.color_camera;
  const float samples =
      samples_for_one(blur.across, &Blur::across, std::min(1.f, depth.fx / color.fx)) *
      samples_for_one(blur.down, &Blur::down, std::min(1.f, depth.fy / color.fy));
  const float telling = static_cast<float>(visible_px) * (1.f - clipped_share(crop)) / samples;
  return std::max(1, static_cast<int>(telling));
}

bool TellingPixels::weigh(ObjectView& view, const ObjectCrop& crop, bool first) {
  const int telling = count(view.visible_px, crop);
  const bool poor =
      static_cast<float>(telling) < config_.least_share * static_cast<float>(view.visible_px);
  if (poor && !first) return false;
  view.visible_px = telling;
  if (poor) view.directions.bins = {};
  return true;
}

void list_fields(TellingConfig& config, ConfigFields& fields) {
  fields.add("sharp_edge_px", config.sharp_edge_px, 0.f, 100.f,
             "as wide as edges are in a sharp picture, in pixels of the depth image: views that "
             "are more smeared, or clipped, weigh less; 0: every pixel counts");
  fields.add("least_share", config.least_share, 0.f, 1.f,
             "of a view's pixels that must tell something; views that tell less are taken of "
             "objects alone that have none");
}

}  // namespace ovimap
