// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "ovimap/base/parallel.h"
#include "ovimap/image/image.h"
#include "ovimap/segment/task_rows.h"

namespace ovimap {

/// Inverse depth (1/m, 0 = invalid) with a border of two invalid pixels, so that neighbour tests
/// need no bounds.
class InverseDepth {
 public:
  explicit InverseDepth(const DepthImage& depth)
      : padded_(Image<float>::unset(depth.width() + 2 * kBorder, depth.height() + 2 * kBorder)) {
    for (int y = -kBorder; y < height() + kBorder; ++y) clear_border(y);
    parallel_for(static_cast<std::size_t>(depth.height()), kPixelRowsPerTask, [&](std::size_t y) {
      const float* in = depth.row(static_cast<int>(y));
      float* out = padded_.row(static_cast<int>(y) + kBorder) + kBorder;
      for (int x = 0; x < depth.width(); ++x) out[x] = in[x] > 0.f ? 1.f / in[x] : 0.f;
    });
  }
  int width() const { return padded_.width() - 2 * kBorder; }
  int height() const { return padded_.height() - 2 * kBorder; }
  /// Rows from -2 to height + 1.
  const float* row(int y) const { return padded_.row(y + kBorder) + kBorder; }

 private:
  static constexpr int kBorder = 2;
  void clear_border(int y) {
    float* out = padded_.row(y + kBorder);
    const bool outside = y < 0 || y >= height();
    std::fill_n(out, outside ? padded_.width() : kBorder, 0.f);
    std::fill_n(out + padded_.width() - kBorder, kBorder, 0.f);
  }
  Image<float> padded_;
};

}  // namespace ovimap
