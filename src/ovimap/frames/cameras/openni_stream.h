// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include "ovimap/base/error.h"
#include "ovimap/frames/cameras/openni_library.h"
#include "ovimap/geometry/camera.h"
#include "ovimap/image/codec.h"

namespace ovimap {

/// Images of one sensor of an OpenNI device. Its last one waits until it is dropped.
class OpenNiStream {
 public:
  /// Depth of 1 or 0.1 mm, or colour as RGB888; of `wanted` size where the sensor has that, else as
  /// large as it can. Throws Error when there are no such images.
  OpenNiStream(const OpenNiLibrary& library, OniDeviceHandle device, const std::string& device_name,
               OniSensorType sensor, ImageSize wanted);
  ~OpenNiStream();
  OpenNiStream(const OpenNiStream&) = delete;
  OpenNiStream& operator=(const OpenNiStream&) = delete;

  void start();
  OniStreamHandle handle() const { return handle_; }
  ImageSize size() const { return {mode_.resolutionX, mode_.resolutionY}; }
  /// By the factory's field of view.
  PinholeCamera camera() const;
  double units_per_m() const {
    return mode_.pixelFormat == ONI_PIXEL_FORMAT_DEPTH_100_UM ? 10000 : 1000;
  }

  /// Reads an image that is ready; it waits in the place of the one before.
  void take();
  const OniFrame* waiting() const { return image_; }
  void drop();
  /// Of the image that waits, left and right as they are. Requires one.
  template <class Pixel>
  Image<Pixel> pixels() const {
    OVIMAP_ASSERT(image_);
    Image<Pixel> image(image_->width, image_->height);
    for (int v = 0; v < image.height(); ++v) {
      const auto* row = reinterpret_cast<const Pixel*>(static_cast<const char*>(image_->data) +
                                                       std::ptrdiff_t{v} * image_->stride);
      mirrored_ ? std::reverse_copy(row, row + image.width(), image.row(v))
                : std::copy(row, row + image.width(), image.row(v));
    }
    return image;
  }

 private:
  float property(int id) const;
  bool plausible(const OniFrame& image) const;

  const OpenNiLibrary& library_;
  const std::string name_;  ///< "Xtion: depth"
  OniStreamHandle handle_ = nullptr;
  OniVideoMode mode_{};
  bool mirrored_ = false;
  OniFrame* image_ = nullptr;
};

}  // namespace ovimap
