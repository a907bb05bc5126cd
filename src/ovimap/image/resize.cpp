// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/image/resize.h"

#include <cmath>

#include "ovimap/base/parallel.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerTask = 16;

/// For each output position the first input position it draws from, and its weights (their sum is
/// 1).
struct FilterTaps {
  std::vector<int> first;
  std::vector<float> weights;  ///< `width` for each output position, zero beyond the triangle
  int width = 0;
};

FilterTaps triangle_taps(int from, int to) {
  const double scale = static_cast<double>(from) / to;
  const double radius = std::max(scale, 1.0);
  FilterTaps taps;
  taps.width = std::min(from, static_cast<int>(std::ceil(radius)) * 2 + 1);
  taps.first.resize(static_cast<std::size_t>(to));
  taps.weights.assign(static_cast<std::size_t>(to) * static_cast<std::size_t>(taps.width), 0.f);
  std::vector<double> raw(static_cast<std::size_t>(taps.width));
  for (int out = 0; out < to; ++out) {
    const double center = (out + 0.5) * scale - 0.5;
    const int lowest = static_cast<int>(std::floor(center - radius)) + 1;
    const int first = std::clamp(lowest, 0, from - taps.width);
    double sum = 0;
    for (int k = 0; k < taps.width; ++k) {
      const double weight = std::max(0.0, 1.0 - std::abs(first + k - center) / radius);
      raw[static_cast<std::size_t>(k)] = weight;
      sum += weight;
    }
    taps.first[static_cast<std::size_t>(out)] = first;
    float* weights =
        &taps.weights[static_cast<std::size_t>(out) * static_cast<std::size_t>(taps.width)];
    for (int k = 0; k < taps.width; ++k)
      weights[k] = static_cast<float>(raw[static_cast<std::size_t>(k)] / sum);
  }
  return taps;
}

/// One input row shrunk or stretched to the output width, as floats.
void resize_row(const Rgb8* row, const FilterTaps& taps, float* out) {
  const float* weights = taps.weights.data();
  for (const int first : taps.first) {
    float r = 0, g = 0, b = 0;
    for (int k = 0; k < taps.width; ++k) {
      const Rgb8 pixel = row[first + k];
      r += weights[k] * static_cast<float>(pixel.r);
      g += weights[k] * static_cast<float>(pixel.g);
      b += weights[k] * static_cast<float>(pixel.b);
    }
    *out++ = r;
    *out++ = g;
    *out++ = b;
    weights += taps.width;
  }
}

/// The weighted sum of `taps.width` consecutive rows of `values`, rounded.
void blend_rows(const std::vector<float>& rows, std::size_t values, const FilterTaps& taps,
                std::size_t y, std::vector<float>& sum, std::uint8_t* out) {
  const float* weights = &taps.weights[y * static_cast<std::size_t>(taps.width)];
  std::fill(sum.begin(), sum.end(), 0.5f);  // rounds to nearest when truncated
  for (int k = 0; k < taps.width; ++k) {
    const float* row = &rows[static_cast<std::size_t>(taps.first[y] + k) * values];
    const float weight = weights[k];
    for (std::size_t i = 0; i < values; ++i) sum[i] += weight * row[i];
  }
  for (std::size_t i = 0; i < values; ++i)
    out[i] = static_cast<std::uint8_t>(static_cast<int>(std::min(sum[i], 255.f)));
}

void check_target(int width, int height) {
  if (width <= 0 || height <= 0)
    throw Error(
        concat("cannot resize an image to ", width, "x", height, "; both must be at least 1"));
}

}  // namespace

RgbImage resize_bilinear(const RgbImage& image, int width, int height) {
  check_target(width, height);
  if (image.empty()) throw Error("cannot resize an image without pixels");
  const FilterTaps across = triangle_taps(image.width(), width);
  const FilterTaps down = triangle_taps(image.height(), height);
  const std::size_t values = static_cast<std::size_t>(width) * 3;
  std::vector<float> rows(values * static_cast<std::size_t>(image.height()));
  parallel_for(static_cast<std::size_t>(image.height()), kRowsPerTask, [&](std::size_t y) {
    resize_row(image.row(static_cast<int>(y)), across, &rows[y * values]);
  });
  RgbImage result(width, height);
  parallel_for_ranges(
      static_cast<std::size_t>(height), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
        std::vector<float> sum(values);
        for (std::size_t y = begin; y < end; ++y)
          blend_rows(rows, values, down, y, sum,
                     reinterpret_cast<std::uint8_t*>(result.row(static_cast<int>(y))));
      });
  return result;
}

IdImage resize_nearest(const IdImage& image, int width, int height) {
  check_target(width, height);
  if (image.empty()) throw Error("cannot resize an image without pixels");
  // The input pixel that contains the centre of the output pixel, in whole numbers.
  const auto source = [](int out, int from, int to) {
    return static_cast<int>((2 * static_cast<std::int64_t>(out) + 1) * from /
                            (2 * static_cast<std::int64_t>(to)));
  };
  std::vector<int> columns(static_cast<std::size_t>(width));
  for (int x = 0; x < width; ++x)
    columns[static_cast<std::size_t>(x)] = source(x, image.width(), width);
  IdImage result(width, height);
  for (int y = 0; y < height; ++y) {
    const std::uint16_t* from = image.row(source(y, image.height(), height));
    std::uint16_t* to = result.row(y);
    for (const int column : columns) *to++ = from[column];
  }
  return result;
}

}  // namespace ovimap
