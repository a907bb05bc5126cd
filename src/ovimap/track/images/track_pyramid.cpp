// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/images/track_pyramid.h"

#include <algorithm>
#include <type_traits>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/geometry/eight_vectors.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerTask = 8;

/// The camera of an image whose pixels are means of squares of `factor` pixels; a rest at the right
/// and at the bottom is left out.
PinholeCamera shrunk(const PinholeCamera& camera, int factor) {
  const auto by = static_cast<float>(factor);
  return {camera.width / factor, camera.height / factor,         camera.fx / by,
          camera.fy / by,        (camera.cx + 0.5f) / by - 0.5f, (camera.cy + 0.5f) / by - 0.5f};
}

/// Squares of `side` pixels that begin in one row of an image.
struct Squares {
  const float* first;
  std::ptrdiff_t row_step;
  int count;
};

/// Mean over each square of those inverse depths that are near the greatest, the nearest surface; 0
/// where none is valid.
template <class Side>
OVIMAP_INLINE void average_nearest(const Squares& squares, Side side, float* means) {
  for (int i = 0; i < squares.count; ++i) {
    const float* square = squares.first + i * side;
    float nearest = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) nearest = std::max(nearest, square[y * squares.row_step + x]);
    const float least = (1 - kOneSurface) * nearest;
    float sum = 0, count = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const float value = square[y * squares.row_step + x], counts = value > least ? 1.f : 0.f;
        sum += counts * value, count += counts;
      }
    means[i] = sum / std::max(count, 1.f);
  }
}

OVIMAP_VECTORIZE void nearest_surfaces(const Squares& squares, int side, float* means) {
  if (side == 2) return average_nearest(squares, std::integral_constant<int, 2>(), means);
  average_nearest(squares, side, means);
}

OVIMAP_VECTORIZE void invert(const float* depths_m, std::size_t count, float* inverse) {
  for (std::size_t i = 0; i < count; ++i) inverse[i] = depths_m[i] > 0 ? 1 / depths_m[i] : 0.f;
}

/// Mean of the luma of `count` pixels whose colours are summed; black stands for unknown, -1.
float mean_luma(int red, int green, int blue, int count) {
  const float sum = 0.299f * static_cast<float>(red) + 0.587f * static_cast<float>(green) +
                    0.114f * static_cast<float>(blue);
  return sum > 0 ? sum / static_cast<float>(count) : -1;
}

OVIMAP_VECTORIZE void add_bytes(const std::uint8_t* bytes, std::size_t count, std::uint32_t* sums) {
  for (std::size_t i = 0; i < count; ++i) sums[i] += bytes[i];
}

/// Mean intensities of squares of the colour image that begin at row `y`.
void average_luma(const RgbImage& color, int y, int side, int count, float* means) {
  std::vector<std::uint32_t> columns(3 * static_cast<std::size_t>(side * count));
  for (int row = y; row < y + side; ++row)
    add_bytes(&color.row(row)->r, columns.size(), columns.data());
  const std::uint32_t* at = columns.data();
  for (int i = 0; i < count; ++i) {
    std::uint32_t red = 0, green = 0, blue = 0;
    for (int x = 0; x < side; ++x, at += 3) red += at[0], green += at[1], blue += at[2];
    means[i] = mean_luma(red, green, blue, side * side);
  }
}

/// Mean intensity of four pixels, the upper left of which is given by its index.
float luma_of_four(const RgbImage& color, int index) {
  const Rgb8 *upper = color.data() + index, *lower = upper + color.width();
  return mean_luma(upper[0].r + upper[1].r + lower[0].r + lower[1].r,
                   upper[0].g + upper[1].g + lower[0].g + lower[1].g,
                   upper[0].b + upper[1].b + lower[0].b + lower[1].b, 4);
}

/// The intensities that another camera saw at points of the depth camera: of row `y`, with
/// `inverse` depths. Both rows hold whole lanes.
OVIMAP_VECTORIZE void seen_by_color(const Frame& frame, const PinholeCamera& camera, int y,
                                    const float* inverse, float* intensity) {
  const Eigen::Isometry3f color_from_depth = frame.color_from_depth.cast<float>();
  const PinholeCamera& color = frame.color_camera;
  const float ray_y = (static_cast<float>(y) - camera.cy) / camera.fy;
  for (int begin = 0; begin < camera.width; begin += kLanes) {
    const Floats ray_x = (counted_from(static_cast<float>(begin)) - camera.cx) / camera.fx;
    const Floats near = load(inverse + begin);
    const Floats depth = 1.f / (near > 0.f ? near : broadcast(1));
    const EightVectors point =
        transformed(color_from_depth, EightVectors{depth * ray_x, depth * ray_y, depth});
    const Floats by_z = 1.f / (point.z > 0.f ? point.z : broadcast(1));
    const Floats u = color.fx * (point.x * by_z) + color.cx,
                 v = color.fy * (point.y * by_z) + color.cy;
    const Ints inside = (near > 0.f) & (point.z > 0.f) & (u >= 0.f) & (v >= 0.f) &
                        (u < static_cast<float>(frame.color.width() - 1)) &
                        (v < static_cast<float>(frame.color.height() - 1));
    const Ints pixel = __builtin_convertvector(inside ? v : Floats{}, Ints) * frame.color.width() +
                       __builtin_convertvector(inside ? u : Floats{}, Ints);
    for (int i = 0; i < kLanes; ++i)
      intensity[begin + i] = inside[i] ? luma_of_four(frame.color, pixel[i]) : -1;
  }
}

TrackLevel level_of(const PinholeCamera& camera) {
  return {camera, Image<float>(camera.width, camera.height, -1.f),
          Image<float>(camera.width, camera.height)};
}

TrackLevel finest_level(const Frame& frame) {
  const int factor = std::max(1, (frame.depth.width() + kFinestWidth_px / 2) / kFinestWidth_px);
  TrackLevel level = level_of(shrunk(frame.depth_camera, factor));
  const auto width = static_cast<std::size_t>(level.camera.width),
             depth_width = static_cast<std::size_t>(frame.depth.width());
  const bool registered = frame.registered();
  parallel_for_ranges(
      static_cast<std::size_t>(level.camera.height), kRowsPerTask,
      [&](std::size_t begin, std::size_t end) {
        std::vector<float> inverse(static_cast<std::size_t>(factor) * depth_width);
        std::vector<float> near(width + kLanes), intensity(width + kLanes);
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
          invert(frame.depth.row(y * factor), inverse.size(), inverse.data());
          nearest_surfaces({inverse.data(), frame.depth.width(), level.camera.width}, factor,
                           near.data());
          if (registered)
            average_luma(frame.color, y * factor, factor, level.camera.width, intensity.data());
          else
            seen_by_color(frame, level.camera, y, near.data(), intensity.data());
          std::copy_n(near.begin(), width, level.inverse_depth.row(y));
          std::copy_n(intensity.begin(), width, level.intensity.row(y));
        }
      });
  return level;
}

TrackLevel halved(const TrackLevel& fine) {
  TrackLevel level = level_of(shrunk(fine.camera, 2));
  parallel_for(static_cast<std::size_t>(level.camera.height), kRowsPerTask, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    nearest_surfaces({fine.inverse_depth.row(2 * y), fine.camera.width, level.camera.width}, 2,
                     level.inverse_depth.row(y));
    for (int x = 0; x < level.camera.width; ++x) {
      const float* upper = fine.intensity.row(2 * y) + 2 * x;
      const float* lower = fine.intensity.row(2 * y + 1) + 2 * x;
      if (std::min({upper[0], upper[1], lower[0], lower[1]}) >= 0)
        level.intensity.row(y)[x] = (upper[0] + upper[1] + lower[0] + lower[1]) / 4;
    }
  });
  return level;
}

}  // namespace

void add_coarser_levels(TrackPyramid& pyramid) {
  while (pyramid.size() < kFewestLevels || pyramid.back().camera.width >= 2 * kCoarsestWidth_px)
    pyramid.push_back(halved(pyramid.back()));
}

TrackPyramid make_pyramid(const Frame& frame) {
  TrackPyramid pyramid{finest_level(frame)};
  add_coarser_levels(pyramid);
  return pyramid;
}

}  // namespace ovimap
