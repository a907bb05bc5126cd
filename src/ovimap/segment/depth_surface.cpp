// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/segment/depth_surface.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ovimap/base/config.h"
#include "ovimap/base/parallel.h"
#include "ovimap/base/vectorize.h"

namespace ovimap {

namespace {

constexpr std::size_t kRowsPerTask = 16;

/// Inverse depth with a border of two invalid (0) pixels, so that neighbour tests need no bounds.
class InverseDepth {
 public:
  explicit InverseDepth(const DepthImage& depth)
      : padded_(depth.width() + 2 * kBorder, depth.height() + 2 * kBorder) {
    parallel_for(static_cast<std::size_t>(depth.height()), kRowsPerTask, [&](std::size_t y) {
      const float* in = depth.row(static_cast<int>(y));
      float* out = padded_.row(static_cast<int>(y) + kBorder) + kBorder;
      for (int x = 0; x < depth.width(); ++x) out[x] = in[x] > 0.f ? 1.f / in[x] : 0.f;
    });
  }
  const float* row(int y) const { return padded_.row(y + kBorder) + kBorder; }

 private:
  static constexpr int kBorder = 2;
  Image<float> padded_;
};

/// Sets `bit` where the surface breaks between q1[x] and q2[x], neighbours in a line q0 q1 q2 q3 of
/// inverse depths. On a plane the second differences of inverse depth vanish, so the step counts
/// only when it agrees with the slope on neither side.
OVIMAP_VECTORIZE void find_breaks(const float* q0, const float* q1, const float* q2,
                                  const float* q3, int width, const DepthSurfaceConfig& config,
                                  std::uint8_t bit, std::uint8_t* breaks) {
  const float base = config.noise.base_m, slope = config.noise.quadratic_per_m;
  const float offset = config.noise.offset_m, sigmas = config.discontinuity_sigmas;
  const float ratio = config.discontinuity_ratio;
  for (int x = 0; x < width; ++x) {
    const float step = q2[x] - q1[x];
    const float size = std::fabs(step);
    const float left = q0[x] > 0.f ? std::fabs(step - (q1[x] - q0[x])) : size;
    const float right = q3[x] > 0.f ? std::fabs(step - (q3[x] - q2[x])) : size;
    const float far_q = std::min(q1[x], q2[x]);
    const float range = 1.f / (far_q + 1e-9f) - offset;
    const float noise_q = sigmas * (base + slope * range * range) * far_q * far_q;
    const bool off_slope = (sigmas > 0.f) & (std::min(left, right) > noise_q);
    const bool broken = (far_q <= 0.f) | (size > ratio * far_q) | off_slope;
    breaks[x] = static_cast<std::uint8_t>(breaks[x] | (broken ? bit : 0));
  }
}

/// Unbroken pixels to either side of each pixel of a row, at most `radius`.
void find_arms(const std::uint8_t* breaks, int width, int radius, std::uint8_t* left,
               std::uint8_t* right) {
  left[0] = 0;
  for (int x = 1; x < width; ++x) {
    const bool broken = breaks[x - 1] & DepthSurface::kRight;
    left[x] = broken ? 0 : static_cast<std::uint8_t>(std::min(left[x - 1] + 1, radius));
  }
  right[width - 1] = 0;
  for (int x = width - 2; x >= 0; --x) {
    const bool broken = breaks[x] & DepthSurface::kRight;
    right[x] = broken ? 0 : static_cast<std::uint8_t>(std::min(right[x + 1] + 1, radius));
  }
}

/// Sums of inverse depth q and of q * u over each pixel's row window, u relative to the pixel.
struct RowSums {
  Image<float> q, qu;
};

void sum_row(const float* q, const std::uint8_t* left, const std::uint8_t* right, int width,
             std::vector<double>& prefix_q, std::vector<double>& prefix_qx, float* sum_q,
             float* sum_qu) {
  prefix_q.resize(static_cast<std::size_t>(width) + 1);
  prefix_qx.resize(static_cast<std::size_t>(width) + 1);
  prefix_q[0] = prefix_qx[0] = 0;
  for (int x = 0; x < width; ++x) {
    const auto i = static_cast<std::size_t>(x);
    prefix_q[i + 1] = prefix_q[i] + q[x];
    prefix_qx[i + 1] = prefix_qx[i] + static_cast<double>(q[x]) * x;
  }
  for (int x = 0; x < width; ++x) {
    const auto begin = static_cast<std::size_t>(x - left[x]),
               end = static_cast<std::size_t>(x + right[x] + 1);
    const double window_q = prefix_q[end] - prefix_q[begin];
    sum_q[x] = static_cast<float>(window_q);
    sum_qu[x] = static_cast<float>(prefix_qx[end] - prefix_qx[begin] - x * window_q);
  }
}

/// Moments of a row of windows: u, v relative to the window's pixel.
struct Moments {
  explicit Moments(int width) {
    for (auto* sums : {&active, &n, &u, &uu, &v, &vv, &uv, &q, &qu, &qv})
      sums->resize(static_cast<std::size_t>(width));
  }
  void clear() {
    for (auto* sums : {&n, &u, &uu, &v, &vv, &uv, &q, &qu, &qv})
      std::fill(sums->begin(), sums->end(), 0.f);
  }
  std::vector<float> active, n, u, uu, v, vv, uv, q, qu, qv;
};

/// Adds the row sums of the image row `v` rows below each pixel, where the column is still
/// unbroken.
OVIMAP_VECTORIZE void add_row(const std::uint8_t* left, const std::uint8_t* right,
                              const float* sum_q, const float* sum_qu, float v, int width,
                              Moments& moments) {
  const float* active = moments.active.data();
  float *n = moments.n.data(), *u = moments.u.data(), *uu = moments.uu.data(),
        *vs = moments.v.data();
  float *vv = moments.vv.data(), *uv = moments.uv.data(), *q = moments.q.data();
  float *qu = moments.qu.data(), *qv = moments.qv.data();
#pragma GCC ivdep  // the arrays never overlap
  for (int x = 0; x < width; ++x) {
    const float on = active[x];
    const float l = static_cast<float>(static_cast<int>(left[x])),
                r = static_cast<float>(static_cast<int>(right[x]));
    const float row_n = on * (l + r + 1.f);
    const float row_u = on * 0.5f * (r * (r + 1.f) - l * (l + 1.f));
    n[x] += row_n;
    u[x] += row_u;
    uu[x] += on * (r * (r + 1.f) * (2.f * r + 1.f) + l * (l + 1.f) * (2.f * l + 1.f)) * (1.f / 6.f);
    vs[x] += v * row_n;
    vv[x] += v * v * row_n;
    uv[x] += v * row_u;
    q[x] += on * sum_q[x];
    qu[x] += on * sum_qu[x];
    qv[x] += on * v * sum_q[x];
  }
}

/// Least squares q = a u + b v + c from the moments; writes the normal and the smoothed depth.
OVIMAP_VECTORIZE void solve_planes(const Moments& m, const float* center_q,
                                   const PinholeCamera& camera, int y, int width,
                                   float* __restrict normals, float* __restrict smooth_depth) {
  constexpr float kFlat = 1e-3f;  // windows thinner than this (pixels^4) hold no plane
  const float fx = camera.fx, fy = camera.fy, cx = camera.cx,
              dv = camera.cy - static_cast<float>(y);
  const float* __restrict ns = m.n.data(), * __restrict us = m.u.data(), * __restrict uus = m.uu.data();
  const float* __restrict vs = m.v.data(), * __restrict vvs = m.vv.data(), * __restrict uvs = m.uv.data();
  const float* __restrict qs = m.q.data(), * __restrict qus = m.qu.data(), * __restrict qvs = m.qv.data();
  for (int x = 0; x < width; ++x) {
    const float inv = 1.f / std::max(ns[x], 1.f), q0 = center_q[x];
    const float mu = us[x] * inv, mv = vs[x] * inv, mq = qs[x] * inv - q0;
    const float cuu = uus[x] * inv - mu * mu, cvv = vvs[x] * inv - mv * mv,
                cuv = uvs[x] * inv - mu * mv;
    const float cuq = (qus[x] - q0 * us[x]) * inv - mu * mq,
                cvq = (qvs[x] - q0 * vs[x]) * inv - mv * mq;
    const float det = cuu * cvv - cuv * cuv;
    const float inv_det = det > kFlat ? 1.f / det : 0.f;
    const float a = (cuq * cvv - cvq * cuv) * inv_det, b = (cvq * cuu - cuq * cuv) * inv_det;
    const float c = q0 + mq - a * mu - b * mv;
    // n . P = const for all points P on the plane, where n = (a fx, b fy, q at the principal
    // point).
    const float nx = a * fx, ny = b * fy, nz = c + a * (cx - static_cast<float>(x)) + b * dv;
    const float norm = std::sqrt(nx * nx + ny * ny + nz * nz);
    const bool valid = (q0 > 0.f) & (det > kFlat) & (norm > 0.f) & (c > 0.f);
    const float scale = valid ? -1.f / norm : 0.f;
    normals[3 * x] = nx * scale, normals[3 * x + 1] = ny * scale, normals[3 * x + 2] = nz * scale;
    smooth_depth[x] = q0 > 0.f ? 1.f / (valid ? c : q0) : 0.f;
  }
}

void cut_columns(const std::uint8_t* breaks, int width, std::vector<float>& active) {
  for (int x = 0; x < width; ++x)
    if (breaks[x] & DepthSurface::kBelow) active[static_cast<std::size_t>(x)] = 0.f;
}

void fit_row(const InverseDepth& inverse, const RowSums& sums, const PinholeCamera& camera, int y,
             Moments& moments, DepthSurface& surface) {
  const int width = surface.breaks.width(), height = surface.breaks.height();
  const auto add = [&](int row) {
    add_row(surface.left_px.row(row), surface.right_px.row(row), sums.q.row(row), sums.qu.row(row),
            static_cast<float>(row - y), width, moments);
  };
  moments.clear();
  std::fill(moments.active.begin(), moments.active.end(), 1.f);
  add(y);
  for (int row = y - 1; row >= std::max(0, y - surface.radius_px); --row) {
    cut_columns(surface.breaks.row(row), width, moments.active);
    add(row);
  }
  std::fill(moments.active.begin(), moments.active.end(), 1.f);
  for (int row = y + 1; row <= std::min(height - 1, y + surface.radius_px); ++row) {
    cut_columns(surface.breaks.row(row - 1), width, moments.active);
    add(row);
  }
  solve_planes(moments, inverse.row(y), camera, y, width, surface.normals.row(y)->data(),
               surface.smooth_depth_m.row(y));
}

DepthSurface allocate(int width, int height, int radius_px) {
  return {radius_px,
          Image<std::uint8_t>(width, height),
          Image<std::uint8_t>(width, height),
          Image<std::uint8_t>(width, height),
          Image<float>(width, height),
          Image<Eigen::Vector3f>(width, height, Eigen::Vector3f::Zero())};
}

}  // namespace

void list_fields(DepthNoiseConfig& config, ConfigFields& fields) {
  fields.add("base_m", config.base_m, 0.f, 1.f,
             "depth noise at offset_m, standard deviation, metres");
  fields.add("quadratic_per_m", config.quadratic_per_m, 0.f, 1.f,
             "growth of the noise with squared range, 1/m");
  fields.add("offset_m", config.offset_m, 0.f, 10.f, "range at which the noise is least, metres");
}

void list_fields(DepthSurfaceConfig& config, ConfigFields& fields) {
  fields.group("noise", [&](ConfigFields& f) { list_fields(config.noise, f); });
  fields.add("discontinuity_sigmas", config.discontinuity_sigmas, 0.f, 100.f,
             "depth step off the slope that makes an edge, in noise sigmas; 0: no such edges");
  fields.add("discontinuity_ratio", config.discontinuity_ratio, 0.f, 1.f,
             "depth step between neighbours that is always an edge, as a share of depth");
  fields.add("normal_radius_rad", config.normal_radius_rad, 0.001f, 0.1f,
             "half window of the plane fit, radians of view");
}

DepthSurface fit_depth_surface(const DepthImage& depth, const PinholeCamera& camera,
                               const DepthSurfaceConfig& config) {
  const int width = depth.width(), height = depth.height();
  const int radius =
      std::clamp(static_cast<int>(std::lround(config.normal_radius_rad * camera.fx)), 2, 100);
  DepthSurface surface = allocate(width, height, radius);
  const InverseDepth inverse(depth);
  RowSums sums{Image<float>(width, height), Image<float>(width, height)};
  const auto rows = static_cast<std::size_t>(height);
  parallel_for_ranges(rows, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<double> prefix_q, prefix_qx;
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const float* q = inverse.row(y);
      std::uint8_t* breaks = surface.breaks.row(y);
      find_breaks(q - 1, q, q + 1, q + 2, width, config, DepthSurface::kRight, breaks);
      find_breaks(inverse.row(y - 1), q, inverse.row(y + 1), inverse.row(y + 2), width, config,
                  DepthSurface::kBelow, breaks);
      find_arms(breaks, width, radius, surface.left_px.row(y), surface.right_px.row(y));
      sum_row(q, surface.left_px.row(y), surface.right_px.row(y), width, prefix_q, prefix_qx,
              sums.q.row(y), sums.qu.row(y));
    }
  });
  parallel_for_ranges(rows, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    Moments moments(width);
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      fit_row(inverse, sums, camera, y, moments, surface);
  });
  return surface;
}

float normal_sigma_rad(float depth_m, int radius_px, const PinholeCamera& camera,
                       const DepthNoiseConfig& noise) {
  const float side = 2.f * static_cast<float>(radius_px) + 1.f;
  const float spread_px = std::sqrt((side * side - 1.f) / 12.f);  // of positions along one axis
  const float pixel_m = depth_m / camera.fx;
  return noise.sigma_m(depth_m) / (side * spread_px * pixel_m);
}

}  // namespace ovimap
