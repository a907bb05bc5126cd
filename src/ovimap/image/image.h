// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "ovimap/base/error.h"
#include "ovimap/base/memory/buffer_pool.h"

namespace ovimap {

struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb8&) const = default;
};

/// A dense image that owns its pixels, rows one after another without padding.
template <class Pixel>
class Image {
 public:
  Image() = default;
  Image(int width, int height, Pixel fill = Pixel{})
      : width_(width), height_(height), pixels_(count(width, height), fill) {}
  /// For images of which every pixel is written next: these hold what memory held.
  static Image unset(int width, int height) {
    Image image;
    image.width_ = width, image.height_ = height;
    image.pixels_ = PooledBuffer<Pixel>(count(width, height));
    return image;
  }

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t size() const { return pixels_.size(); }
  bool empty() const { return pixels_.size() == 0; }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  template <class Other>
  bool same_size(const Image<Other>& other) const {
    return width_ == other.width() && height_ == other.height();
  }

  Pixel& at(int x, int y) { return row(y)[checked_x(x)]; }
  const Pixel& at(int x, int y) const { return row(y)[checked_x(x)]; }
  Pixel* row(int y) { return pixels_.data() + offset(y); }
  const Pixel* row(int y) const { return pixels_.data() + offset(y); }
  Pixel* data() { return pixels_.data(); }
  const Pixel* data() const { return pixels_.data(); }
  Pixel& operator[](std::size_t index) { return data()[index]; }
  const Pixel& operator[](std::size_t index) const { return data()[index]; }
  auto begin() { return pixels_.begin(); }
  auto end() { return pixels_.end(); }
  auto begin() const { return pixels_.begin(); }
  auto end() const { return pixels_.end(); }

  void fill(Pixel value) { std::fill(pixels_.begin(), pixels_.end(), value); }
  bool operator==(const Image&) const = default;

 private:
  static std::size_t count(int width, int height) {
    OVIMAP_ASSERT(width >= 0 && height >= 0);
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  int checked_x(int x) const {
    OVIMAP_ASSERT(x >= 0 && x < width_);
    return x;
  }
  std::size_t offset(int y) const {
    OVIMAP_ASSERT(y >= 0 && y < height_);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
  }

  int width_ = 0, height_ = 0;
  PooledBuffer<Pixel> pixels_;
};

using RgbImage = Image<Rgb8>;
using DepthImage = Image<float>;       ///< metres along the optical axis; 0 = invalid
using IdImage = Image<std::uint16_t>;  ///< ids; 0 = none

}  // namespace ovimap
