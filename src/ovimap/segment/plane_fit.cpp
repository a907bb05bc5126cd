// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"
#include "ovimap/segment/task_rows.h"

namespace ovimap {

namespace {

/// Sums over the window of every pixel of a row: of 1, u, u^2, q, q u, and of 1, u, q times the
/// image row y, and of y^2; u relative to the pixel, q in units.
enum Sum { kN, kU, kUU, kQ, kQU, kNY, kUY, kQY, kNYY, kSums };

/// Rows of kSums arrays.
class SumRows {
 public:
  SumRows(int width, int rows)
      : width_(static_cast<std::size_t>(width)),
        values_(width_ * kSums * static_cast<std::size_t>(rows)) {}
  std::uint32_t* row(int index) {
    return values_.data() + static_cast<std::size_t>(index) * kSums * width_;
  }

 private:
  std::size_t width_;
  std::vector<std::uint32_t> values_;
};

OVIMAP_VECTORIZE void to_units(const float* q, int width, float units_per_inverse,
                               std::uint32_t* units) {
  for (int x = 0; x < width; ++x)
    units[x] =
        static_cast<std::uint32_t>(static_cast<std::int32_t>(q[x] * units_per_inverse + 0.5f));
}

/// Sums of q and q u over the row window of each pixel, by differences of running sums along the
/// row.
class RowSums {
 public:
  explicit RowSums(int width)
      : q(static_cast<std::size_t>(width)),
        sum_q(q.size()),
        sum_qu(q.size()),
        running_q_(q.size() + 1),
        running_qx_(q.size() + 1) {}

  void add(const float* inverse, const std::uint8_t* left, const std::uint8_t* right,
           float units_per_inverse) {
    to_units(inverse, static_cast<int>(q.size()), units_per_inverse, q.data());
    for (std::uint32_t x = 0; x < q.size(); ++x) {
      running_q_[x + 1] = running_q_[x] + q[x];
      running_qx_[x + 1] = running_qx_[x] + q[x] * x;
    }
    for (std::uint32_t x = 0; x < q.size(); ++x) {
      const std::uint32_t begin = x - left[x], end = x + right[x] + 1u;
      sum_q[x] = running_q_[end] - running_q_[begin];
      sum_qu[x] = running_qx_[end] - running_qx_[begin] - x * sum_q[x];
    }
  }

  std::vector<std::uint32_t> q;  ///< in units
  std::vector<std::uint32_t> sum_q, sum_qu;

 private:
  std::vector<std::uint32_t> running_q_, running_qx_;
};

/// next = last + the row sums of image row y.
OVIMAP_VECTORIZE void extend_running_sums(const std::uint8_t* left, const std::uint8_t* right,
                                          const std::uint32_t* sum_q, const std::uint32_t* sum_qu,
                                          std::uint32_t y, int width, const std::uint32_t* last,
                                          std::uint32_t* next) {
  const auto plane = static_cast<std::size_t>(width);
  const std::uint32_t yy = y * y;
  OVIMAP_NO_OVERLAP  // the rows never overlap
      for (std::size_t x = 0; x < plane; ++x) {
    const std::int32_t l = left[x], r = right[x];
    const std::int32_t n = l + r + 1;
    const std::int32_t u = (r * (r + 1) - l * (l + 1)) >> 1;
    // Sums of squares are sixths of these; division by 3 as multiplication with its inverse.
    const std::int32_t cubes = r * (r + 1) * (2 * r + 1) + l * (l + 1) * (2 * l + 1);
    const std::uint32_t row_uu = static_cast<std::uint32_t>(cubes >> 1) * 0xaaaaaaabu;
    const auto row_n = static_cast<std::uint32_t>(n), row_u = static_cast<std::uint32_t>(u);
    next[kN * plane + x] = last[kN * plane + x] + row_n;
    next[kU * plane + x] = last[kU * plane + x] + row_u;
    next[kUU * plane + x] = last[kUU * plane + x] + row_uu;
    next[kQ * plane + x] = last[kQ * plane + x] + sum_q[x];
    next[kQU * plane + x] = last[kQU * plane + x] + sum_qu[x];
    next[kNY * plane + x] = last[kNY * plane + x] + y * row_n;
    next[kUY * plane + x] = last[kUY * plane + x] + y * row_u;
    next[kQY * plane + x] = last[kQY * plane + x] + y * sum_q[x];
    next[kNYY * plane + x] = last[kNYY * plane + x] + yy * row_n;
  }
}

/// sums = bottom - top for the pixels [begin, end) of all arrays.
OVIMAP_VECTORIZE void subtract(const std::uint32_t* bottom, const std::uint32_t* top, int width,
                               int begin, int end, std::uint32_t* sums) {
  for (int sum = 0; sum < kSums; ++sum) {
    const std::size_t first = static_cast<std::size_t>(sum) * static_cast<std::size_t>(width);
    OVIMAP_NO_OVERLAP
    for (std::size_t x = first + static_cast<std::size_t>(begin);
         x < first + static_cast<std::size_t>(end); ++x)
      sums[x] = bottom[x] - top[x];
  }
}

/// One row of what a fit gives.
struct FittedRow {
  float *normal_x, *normal_y, *normal_z;
  float* smooth_depth_m;
  float* plane_slope;
};

/// Least squares from the window sums of row y.
OVIMAP_VECTORIZE void solve_planes(const std::uint32_t* sums, const std::uint32_t* center_units,
                                   const float* center_q, float unit, const PinholeCamera& camera,
                                   std::uint32_t y, int width, FittedRow fitted) {
  constexpr float kFlat = 1e-3f;  // windows thinner than this (pixels^4) hold no plane
  const float fx = camera.fx, fy = camera.fy, cx = camera.cx,
              dv = camera.cy - static_cast<float>(y);
  const auto plane = static_cast<std::size_t>(width);
  float* __restrict normal_x = fitted.normal_x;
  float* __restrict normal_y = fitted.normal_y;
  float* __restrict normal_z = fitted.normal_z;
  float* __restrict smooth_depth = fitted.smooth_depth_m;
  float* __restrict slopes = fitted.plane_slope;
  const auto real = [](std::uint32_t bits) {
    return static_cast<float>(static_cast<std::int32_t>(bits));
  };
  OVIMAP_NO_OVERLAP
  for (std::size_t x = 0; x < plane; ++x) {
    const std::uint32_t n = sums[kN * plane + x], u = sums[kU * plane + x],
                        sum_ny = sums[kNY * plane + x];
    // Rows counted from the pixel's own, inverse depths from its own.
    const std::uint32_t v = sum_ny - y * n;
    const std::uint32_t vv = sums[kNYY * plane + x] - 2 * y * sum_ny + y * y * n;
    const std::uint32_t uv = sums[kUY * plane + x] - y * u;
    const std::uint32_t q0 = center_units[x], sum_q = sums[kQ * plane + x];
    const std::uint32_t q = sum_q - q0 * n, qu = sums[kQU * plane + x] - q0 * u;
    const std::uint32_t qv = sums[kQY * plane + x] - y * sum_q - q0 * v;
    const float inv = 1.f / real(n);
    const float mu = real(u) * inv, mv = real(v) * inv, mq = real(q) * inv;
    const float cuu = real(sums[kUU * plane + x]) * inv - mu * mu;
    const float cvv = real(vv) * inv - mv * mv, cuv = real(uv) * inv - mu * mv;
    const float cuq = real(qu) * inv - mu * mq, cvq = real(qv) * inv - mv * mq;
    const float det = cuu * cvv - cuv * cuv;
    const float scale_det = det > kFlat ? unit / det : 0.f;
    const float a = (cuq * cvv - cvq * cuv) * scale_det, b = (cvq * cuu - cuq * cuv) * scale_det;
    const float c = center_q[x] + mq * unit - a * mu - b * mv;
    // n . P = const for all points P on the plane, where n = (a fx, b fy, q at the principal
    // point).
    const float du = cx - static_cast<float>(static_cast<std::int32_t>(x));
    const float nx = a * fx, ny = b * fy, nz = c + a * du + b * dv;
    const float norm = std::sqrt(nx * nx + ny * ny + nz * nz);
    const bool valid = (center_q[x] > 0.f) & (det > kFlat) & (norm > 0.f) & (c > 0.f);
    const float scale = valid ? -1.f / norm : 0.f;
    normal_x[x] = nx * scale, normal_y[x] = ny * scale, normal_z[x] = nz * scale;
    smooth_depth[x] = center_q[x] > 0.f ? 1.f / (valid ? c : center_q[x]) : 0.f;
    slopes[x] = -scale * c;  // n . ray = c for the ray of this pixel
  }
}

/// Fits the rows [begin, end).
class RowFitter {
 public:
  RowFitter(const InverseDepth& inverse, const PinholeCamera& camera, DepthSurface& surface)
      : inverse_(inverse),
        camera_(camera),
        surface_(surface),
        width_(inverse.width()),
        unit_(inverse_depth_unit(surface.radius_px)),
        ring_rows_(2 * surface.radius_px + 2),
        ring_(width_, ring_rows_),
        sums_(width_, 1),
        row_sums_(width_),
        center_units_(static_cast<std::size_t>(width_)) {}

  void fit(int begin, int end) {
    const int radius = surface_.radius_px, first = std::max(0, begin - radius);
    std::fill_n(running(first), kSums * static_cast<std::size_t>(width_), 0u);
    for (int next = first, y = begin; y < end; ++y) {
      for (; next <= std::min(y + radius, inverse_.height() - 1); ++next) extend(next);
      fit_row(y);
    }
  }

 private:
  /// Sums of all rows before `row`, since the first.
  std::uint32_t* running(int row) { return ring_.row(row % ring_rows_); }

  void extend(int row) {
    const std::uint8_t *left = surface_.left_px.row(row), *right = surface_.right_px.row(row);
    row_sums_.add(inverse_.row(row), left, right, 1.f / unit_);
    extend_running_sums(left, right, row_sums_.sum_q.data(), row_sums_.sum_qu.data(),
                        static_cast<std::uint32_t>(row), width_, running(row), running(row + 1));
  }

  void fit_row(int y) {
    const std::uint8_t *up = surface_.up_px.row(y), *down = surface_.down_px.row(y);
    for (int begin = 0; begin < width_;) {  // runs of windows of one height
      int end = begin + 1;
      while (end < width_ && up[end] == up[begin] && down[end] == down[begin]) ++end;
      subtract(running(y + down[begin] + 1), running(y - up[begin]), width_, begin, end,
               sums_.row(0));
      begin = end;
    }
    to_units(inverse_.row(y), width_, 1.f / unit_, center_units_.data());
    solve_planes(
        sums_.row(0), center_units_.data(), inverse_.row(y), unit_, camera_,
        static_cast<std::uint32_t>(y), width_,
        {surface_.normals.row(0, y), surface_.normals.row(1, y), surface_.normals.row(2, y),
         surface_.smooth_depth_m.row(y), surface_.plane_slope.row(y)});
  }

  const InverseDepth& inverse_;
  const PinholeCamera& camera_;
  DepthSurface& surface_;
  int width_;
  float unit_;
  int ring_rows_;
  SumRows ring_, sums_;
  RowSums row_sums_;
  std::vector<std::uint32_t> center_units_;
};

}  // namespace

float inverse_depth_unit(int radius_px) {
  // The largest sum is that of (q - q0) u. On an unbroken window at 0.1 m, q differs by less than
  // half of 10 / m from its centre.
  constexpr float kLargestDifference = 5.f;
  const float side = static_cast<float>(2 * radius_px + 1);
  const float sum_of_u = side * static_cast<float>(radius_px * (radius_px + 1));
  return std::exp2(std::ceil(std::log2(kLargestDifference * sum_of_u)) - 31.f);
}

void fit_planes(const InverseDepth& inverse, const PinholeCamera& camera, DepthSurface& surface) {
  parallel_for_ranges(
      static_cast<std::size_t>(inverse.height()), kWindowRowsPerTask,
      [&](std::size_t begin, std::size_t end) {
        RowFitter(inverse, camera, surface).fit(static_cast<int>(begin), static_cast<int>(end));
      });
}

}  // namespace ovimap
