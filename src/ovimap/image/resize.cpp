// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/image/resize.h"

#include <cmath>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerTask = 16;
constexpr int kWeightBits = 22;  // 255 * the largest weight sum still fits 32 bits
constexpr std::int32_t kHalf = 1 << (kWeightBits - 1);

double triangle(double x) {
  return std::max(0.0, 1.0 - std::abs(x));
}

/// Keys' cubic with a = -1/2.
double cubic(double x) {
  constexpr double kA = -0.5;
  x = std::abs(x);
  if (x < 1.0) return ((kA + 2.0) * x - (kA + 3.0)) * x * x + 1;
  if (x < 2.0) return (((x - 5) * x + 8) * x - 4) * kA;
  return 0.0;
}

struct Kernel {
  double (*weight)(double);
  double radius;
};

Kernel kernel_of(ResizeFilter filter) {
  return filter == ResizeFilter::kBicubic ? Kernel{cubic, 2.0} : Kernel{triangle, 1.0};
}

/// For each output position the first input position it draws from, and its weights in fixed point
/// (their sum is 2^kWeightBits but for rounding).
struct FilterTaps {
  std::vector<int> first;
  std::vector<std::int32_t> weights;  ///< `width` for each output position, zero beyond the kernel
  int width = 0;
};

std::int32_t fixed_point(double weight) {
  return static_cast<std::int32_t>((weight < 0 ? -0.5 : 0.5) + weight * (1 << kWeightBits));
}

/// For `count` output positions from `begin` on, of an axis that goes from `from` to `to` pixels.
FilterTaps filter_taps(int from, int to, int begin, int count, const Kernel& kernel) {
  const double scale = static_cast<double>(from) / to;
  const double stretch = std::max(scale, 1.0);
  const double shrink = 1.0 / stretch;
  const double radius = kernel.radius * stretch;
  FilterTaps taps;
  taps.width = std::min(from, static_cast<int>(std::ceil(radius)) * 2 + 1);
  const auto width = static_cast<std::size_t>(taps.width);
  taps.first.resize(static_cast<std::size_t>(count));
  taps.weights.assign(static_cast<std::size_t>(count) * width, 0);
  std::vector<double> raw(width);
  for (int out = 0; out < count; ++out) {
    const double center = (begin + out + 0.5) * scale;
    const int lowest = std::max(0, static_cast<int>(center - radius + 0.5));
    const int drawn = std::min(from, static_cast<int>(center + radius + 0.5)) - lowest;
    double sum = 0;
    for (int k = 0; k < drawn; ++k) {
      raw[static_cast<std::size_t>(k)] = kernel.weight((k + lowest - center + 0.5) * shrink);
      sum += raw[static_cast<std::size_t>(k)];
    }
    const int first = std::min(lowest, from - taps.width);
    taps.first[static_cast<std::size_t>(out)] = first;
    std::int32_t* weights = &taps.weights[static_cast<std::size_t>(out) * width];
    for (int k = 0; k < drawn; ++k)
      weights[lowest - first + k] = fixed_point(raw[static_cast<std::size_t>(k)] / sum);
  }
  return taps;
}

std::uint8_t to_byte(std::int32_t sum) {
  return static_cast<std::uint8_t>(std::clamp(sum >> kWeightBits, 0, 255));
}

/// One input row shrunk or stretched to the output width.
void resize_row(const Rgb8* row, const FilterTaps& taps, Rgb8* out) {
  const std::int32_t* weights = taps.weights.data();
  for (const int first : taps.first) {
    std::int32_t r = kHalf, g = kHalf, b = kHalf;
    for (int k = 0; k < taps.width; ++k) {
      const Rgb8 pixel = row[first + k];
      r += weights[k] * pixel.r;
      g += weights[k] * pixel.g;
      b += weights[k] * pixel.b;
    }
    *out++ = {to_byte(r), to_byte(g), to_byte(b)};
    weights += taps.width;
  }
}

OVIMAP_VECTORIZE void add_weighted(const std::uint8_t* row, std::int32_t weight, std::size_t count,
                                   std::int32_t* sum) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += weight * row[i];
}

/// The weighted sum of `taps.width` consecutive rows; `rows` begins with row `first_row`.
void blend_rows(const RgbImage& rows, int first_row, const FilterTaps& taps, int y,
                std::vector<std::int32_t>& sum, Rgb8* out) {
  const auto at = static_cast<std::size_t>(y);
  const std::int32_t* weights = &taps.weights[at * static_cast<std::size_t>(taps.width)];
  std::fill(sum.begin(), sum.end(), kHalf);
  for (int k = 0; k < taps.width; ++k)
    add_weighted(reinterpret_cast<const std::uint8_t*>(rows.row(taps.first[at] - first_row + k)),
                 weights[k], sum.size(), sum.data());
  auto* bytes = reinterpret_cast<std::uint8_t*>(out);
  for (const std::int32_t value : sum) *bytes++ = to_byte(value);
}

void check_target(int width, int height) {
  if (width <= 0 || height <= 0)
    throw Error(
        concat("cannot resize an image to ", width, "x", height, "; both must be at least 1"));
}

void check_window(const ImageWindow& window, int width, int height) {
  if (window.left_px < 0 || window.top_px < 0 || window.width_px < 1 || window.height_px < 1 ||
      window.left_px > width - window.width_px || window.top_px > height - window.height_px)
    throw Error(concat("a window of ", window.width_px, "x", window.height_px, " pixels at ",
                       window.left_px, ",", window.top_px, " is not inside an image of ", width,
                       "x", height));
}

}  // namespace

RgbImage resize_filtered(const RgbImage& image, int width, int height, ResizeFilter filter) {
  return resize_window(image, width, height, {0, 0, width, height}, filter);
}

RgbImage resize_window(const RgbImage& image, int width, int height, const ImageWindow& window,
                       ResizeFilter filter) {
  check_target(width, height);
  if (image.empty()) throw Error("cannot resize an image without pixels");
  check_window(window, width, height);
  const Kernel kernel = kernel_of(filter);
  const FilterTaps across =
      filter_taps(image.width(), width, window.left_px, window.width_px, kernel);
  const FilterTaps down =
      filter_taps(image.height(), height, window.top_px, window.height_px, kernel);
  const int first_row = down.first.front();
  RgbImage rows(window.width_px, down.first.back() + down.width - first_row);
  parallel_for(static_cast<std::size_t>(rows.height()), kRowsPerTask, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    resize_row(image.row(first_row + y), across, rows.row(y));
  });
  RgbImage result(window.width_px, window.height_px);
  parallel_for_ranges(static_cast<std::size_t>(result.height()), kRowsPerTask,
                      [&](std::size_t begin, std::size_t end) {
                        std::vector<std::int32_t> sum(static_cast<std::size_t>(result.width()) * 3);
                        for (std::size_t y = begin; y < end; ++y)
                          blend_rows(rows, first_row, down, static_cast<int>(y), sum,
                                     result.row(static_cast<int>(y)));
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
