// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ovimap/frames/frame/frame.h"

namespace ovimap {

/// Where each depth pixel lies in the colour image: index into it, or kNoColor where the depth is
/// invalid, the point leaves the colour image, or another surface hides it from the colour camera.
class Registration {
 public:
  static constexpr std::int32_t kNoColor = -1;

  /// `occlusion_margin_m`: how much nearer another surface must be, in the colour camera, to hide a
  /// point.
  explicit Registration(const Frame& frame, float occlusion_margin_m = 0.05f)
      : Registration(frame, frame.depth, occlusion_margin_m) {}
  /// The same for another depth image of the frame's depth camera, such as the map's.
  Registration(const Frame& frame, const DepthImage& depth, float occlusion_margin_m);

  /// Colour at each depth pixel (nearest pixel), black where there is none. Like `ids_at_depth`,
  /// takes an image of the colour camera's size.
  RgbImage color_at_depth(const RgbImage& color) const;
  /// Ids of the colour image at each depth pixel (nearest pixel, never interpolated), 0 where none.
  IdImage ids_at_depth(const IdImage& ids) const;

  const Image<std::int32_t>& color_index() const { return color_index_; }

 private:
  int color_width_, color_height_;
  Image<std::int32_t> color_index_;
};

}  // namespace ovimap
