// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

#include "ovimap/image/image.h"

namespace ovimap {

/// A vector for each pixel, axis by axis, so that loops along a row read and write what lies side
/// by side.
class NormalImage {
 public:
  NormalImage() = default;
  static NormalImage unset(int width, int height) {
    NormalImage image;
    for (Image<float>& axis : image.axes_) axis = Image<float>::unset(width, height);
    return image;
  }

  int width() const { return axes_[0].width(); }
  int height() const { return axes_[0].height(); }
  Eigen::Vector3f at(int x, int y) const {
    return {axes_[0].at(x, y), axes_[1].at(x, y), axes_[2].at(x, y)};
  }
  float* row(std::size_t axis, int y) { return axes_[axis].row(y); }
  const float* row(std::size_t axis, int y) const { return axes_[axis].row(y); }

 private:
  std::array<Image<float>, 3> axes_;
};

}  // namespace ovimap
