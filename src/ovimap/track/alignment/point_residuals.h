// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ovimap/geometry/eight_vectors.h"
#include "ovimap/track/alignment/alignment.h"

namespace ovimap {

OVIMAP_INLINE EightVectors points_of(const EightPoints& points) {
  return {load(points.x), load(points.y), load(points.z)};
}

OVIMAP_INLINE EightVectors normals_of(const EightPoints& points) {
  return {load(points.normal_x), load(points.normal_y), load(points.normal_z)};
}

/// From where and how a frame is held against a reference.
struct ResidualView {
  ResidualView(const TrackLevel& level, const Pose& pose, const FrameAlignmentConfig& alignment,
               float reach_factor)
      : frame(level),
        reference_from_frame(pose.cast<float>()),
        frame_from_reference(pose.inverse().cast<float>()),
        config(alignment),
        reach(reach_factor) {}

  const TrackLevel& frame;
  Eigen::Isometry3f reference_from_frame, frame_from_reference;
  const FrameAlignmentConfig& config;
  float reach;
};

/// What a frame says of eight points; PointResidual has the meaning of each. Where a mask is not
/// set, the values that hang on it are finite and mean nothing.
struct EightResiduals {
  Ints seen, measured, near, textured;
  Floats distance_m, sigma_m, intensity;
  EightVectors hit;
};

/// Intensity between pixels, bilinear. Takes lanes out of `known` where a neighbour is unknown or
/// outside.
OVIMAP_INLINE Floats intensities_at(const Image<float>& image, Floats u, Floats v, Ints& known) {
  known &= (u >= 0.f) & (v >= 0.f) & (u < static_cast<float>(image.width() - 1)) &
           (v < static_cast<float>(image.height() - 1));
  u = known ? u : Floats{}, v = known ? v : Floats{};
  const Ints x = __builtin_convertvector(u, Ints), y = __builtin_convertvector(v, Ints);
  const Ints here = y * image.width() + x, right_of = here - known;  // a mask is -1
  const Ints below = known ? here + image.width() : here;
  const float* values = image.data();
  const Floats upper_left = gather(values, here), upper_right = gather(values, right_of),
               lower_left = gather(values, below), lower_right = gather(values, below - known);
  known &= (upper_left >= 0.f) & (upper_right >= 0.f) & (lower_left >= 0.f) & (lower_right >= 0.f);
  const Floats right = u - __builtin_convertvector(x, Floats),
               down = v - __builtin_convertvector(y, Floats);
  const Floats top = upper_left + right * (upper_right - upper_left);
  const Floats bottom = lower_left + right * (lower_right - lower_left);
  return top + down * (bottom - top);
}

inline constexpr float kNearest_m = 0.05f;  // nearer the optical centre nothing is looked for
inline constexpr float kFar_m = 0.05f, kFarShare = 0.05f;  // farther off is another surface
inline constexpr float kMinCosine = 0.15f;

/// Residuals of eight points; `used`: the lanes that have one.
OVIMAP_INLINE EightResiduals residuals_of(const EightPoints& points, Ints used,
                                          const ResidualView& view) {
  const PinholeCamera& camera = view.frame.camera;
  const EightVectors point = points_of(points), normal = normals_of(points);
  const EightVectors in_frame = transformed(view.frame_from_reference, point);
  const Ints ahead = used & (in_frame.z > kNearest_m);
  const Floats z = ahead ? in_frame.z : broadcast(1);
  const Floats u = camera.fx * in_frame.x / z + camera.cx,
               v = camera.fy * in_frame.y / z + camera.cy;
  EightResiduals at;
  at.seen = ahead & (u > -0.5f) & (v > -0.5f) & (u < static_cast<float>(camera.width) - 0.5f) &
            (v < static_cast<float>(camera.height) - 0.5f);
  at.textured = at.seen & (load(points.intensity) >= 0.f);
  at.intensity = intensities_at(view.frame.intensity, u, v, at.textured);
  const Ints x = __builtin_convertvector(at.seen ? u + 0.5f : Floats{}, Ints),
             y = __builtin_convertvector(at.seen ? v + 0.5f : Floats{}, Ints);
  const Floats inverse = gather(view.frame.inverse_depth.data(), y * camera.width + x);
  at.measured = at.seen & (inverse > 0.f);  // not where it is no number
  const Floats depth = 1.f / (at.measured ? inverse : broadcast(1));
  const EightVectors ray = {(__builtin_convertvector(x, Floats) - camera.cx) / camera.fx,
                            (__builtin_convertvector(y, Floats) - camera.cy) / camera.fy,
                            broadcast(1)};
  at.hit =
      transformed(view.reference_from_frame, EightVectors{depth * ray.x, depth * ray.y, depth});
  const EightVectors off = {at.hit.x - point.x, at.hit.y - point.y, at.hit.z - point.z};
  at.distance_m = dot(normal, off);
  const Floats cosine =
      larger(broadcast(kMinCosine), magnitude(dot(normal, turned(view.reference_from_frame, ray))));
  const DepthNoiseConfig& noise = view.config.noise;
  const Floats range = depth - noise.offset_m;
  const Floats sigma = (noise.base_m + noise.quadratic_per_m * range * range) * cosine;
  at.sigma_m = square_root(sigma * sigma + view.config.model_sigma_m * view.config.model_sigma_m);
  at.near =
      at.measured & (magnitude(depth - in_frame.z) < view.reach * (kFar_m + kFarShare * depth));
  return at;
}

}  // namespace ovimap
