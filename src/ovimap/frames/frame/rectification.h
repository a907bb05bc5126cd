// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ovimap/frames/frame/camera_rig.h"
#include "ovimap/frames/frame/frame.h"

namespace ovimap {

/// Makes of the pictures of a lens those of a pinhole with the same intrinsics, by a table of where
/// each pixel comes from.
class Rectification {
 public:
  /// `name` is what messages call the camera. Throws Error when less than a quarter of the
  /// pinhole's picture comes from that of the lens (such coefficients are not this camera's), or
  /// images are larger than 2^24 pixels.
  Rectification(const PinholeCamera& camera, const Lens& lens, const char* name);

  /// Bilinear; beyond what the lens shows, the nearest that it shows. Images are of the camera's
  /// size here and below.
  RgbImage color(const RgbImage& bent) const;
  /// Nearest pixels, never a mixture; 0 beyond what the lens shows.
  DepthImage depth(const DepthImage& bent) const { return nearest(bent); }
  IdImage ids(const IdImage& bent) const { return nearest(bent); }

 private:
  /// The pixel at the upper left of where a pixel comes from, and how far it lies from it in 1/256.
  struct Origin {
    std::int32_t index = 0;
    std::uint8_t right = 0, down = 0;
    bool shown = false;
  };

  template <class Pixel>
  Image<Pixel> nearest(const Image<Pixel>& bent) const;

  int width_, height_;
  std::vector<Origin> origins_;
};

/// The rectifications of a rig's cameras. A camera whose lens is straight costs nothing.
class RigRectification {
 public:
  /// Throws Error as Rectification does.
  explicit RigRectification(const CameraRig& rig);

  /// Colour and depth of a frame as its cameras took them become those of pinholes.
  void apply(Frame& frame) const;
  /// The same for ids of colour's pixels.
  IdImage color_ids(IdImage ids) const;

 private:
  std::optional<Rectification> color_, depth_;
};

}  // namespace ovimap
