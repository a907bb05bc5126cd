// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/render/lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "ovimap/base/parallel.h"

namespace ovimap {
namespace {

constexpr int kBlock = 4;  // pixels a side of one sampling pattern
constexpr int kPatterns = kBlock * kBlock;
constexpr int kReach =
    kBlock / 2;  // of the average; half weight at its border covers each pattern once
constexpr float kLeaveSurface_m = 1e-3f;  // where secondary rays start
constexpr float kSamePlane_m = 0.01f;     // per metre of depth: neighbours to average with
constexpr float kSameNormal = 0.9f;
constexpr float kUpperAmbient = 1.f, kLowerAmbient = 0.7f;  // surfaces facing up, facing down

/// Point `index` of the plane-filling sequence of the plastic number (Roberts, 2018), in [0, 1)
/// squared.
Eigen::Vector2f plastic_point(int index) {
  constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;
  const double x = 0.5 + kFirst * index, y = 0.5 + kSecond * index;
  return Eigen::Vector2f(static_cast<float>(x - std::floor(x)),
                         static_cast<float>(y - std::floor(y)));
}

/// The order in which a block's pixels take samples: neighbours are far apart in the sequence.
constexpr int kPatternOrder[kPatterns] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};

bool same_plane(const SurfacePoint& a, const SurfacePoint& b) {
  return b.id != 0 && a.normal.dot(b.normal) > kSameNormal &&
         std::abs(a.face_normal.dot(b.position - a.position)) < kSamePlane_m * a.depth;
}

Eigen::Vector3f averaged(const Image<SurfacePoint>& surfaces, const LightImage& raw, int x, int y) {
  const SurfacePoint& center = surfaces.at(x, y);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weights = 0;
  for (int v = std::max(0, y - kReach); v <= std::min(raw.height() - 1, y + kReach); ++v)
    for (int u = std::max(0, x - kReach); u <= std::min(raw.width() - 1, x + kReach); ++u) {
      if (!same_plane(center, surfaces.at(u, v))) continue;
      const float weight =
          (std::abs(u - x) == kReach ? 0.5f : 1.f) * (std::abs(v - y) == kReach ? 0.5f : 1.f);
      sum += weight * raw.at(u, v);
      weights += weight;
    }
  return weights > 0 ? Eigen::Vector3f(sum / weights) : raw.at(x, y);
}

}  // namespace

Lighting::Lighting(const SynthRoom& room, const RayScene& scene, const RenderConfig& config)
    : room_(room), scene_(scene), config_(config) {
  for (int i = 0; i < kPatterns * config_.light_samples; ++i)
    lamp_samples_.push_back(2 * plastic_point(i) - Eigen::Vector2f::Ones());
  for (int i = 0; i < kPatterns * config_.ambient_samples; ++i) {
    const Eigen::Vector2f point = plastic_point(i);
    const float radius = std::sqrt(point.x()), angle = 2 * std::numbers::pi_v<float> * point.y();
    ambient_samples_.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                  std::sqrt(1 - point.x()));
  }
}

LightImage Lighting::gather(const Image<SurfacePoint>& surfaces) const {
  LightImage raw(surfaces.width(), surfaces.height(), Eigen::Vector3f::Zero());
  LightImage smooth = raw;
  parallel_for(static_cast<std::size_t>(raw.height()), 4, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < raw.width(); ++x)
      if (surfaces.at(x, y).id != 0)
        raw.at(x, y) = light_at(surfaces.at(x, y), kPatternOrder[y % kBlock * kBlock + x % kBlock]);
  });
  parallel_for(static_cast<std::size_t>(raw.height()), 4, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < raw.width(); ++x)
      if (surfaces.at(x, y).id != 0) smooth.at(x, y) = averaged(surfaces, raw, x, y);
  });
  return smooth;
}

Eigen::Vector3f Lighting::light_at(const SurfacePoint& point, int pattern) const {
  Eigen::Vector3f light = ambient_light(point, pattern);
  for (const AreaLight& lamp : room_.lights)
    if (!faint(lamp, point)) light += lamp_light(lamp, point, pattern);
  return light;
}

bool Lighting::faint(const AreaLight& lamp, const SurfacePoint& point) const {
  if (room_.faint_light <= 0) return false;
  const Eigen::Vector3f to_lamp = lamp.center_m - point.position;
  return lamp.intensity.maxCoeff() < room_.faint_light * to_lamp.squaredNorm();
}

Eigen::Vector3f Lighting::lamp_light(const AreaLight& lamp, const SurfacePoint& point,
                                     int pattern) const {
  Eigen::Vector3f light = Eigen::Vector3f::Zero();
  const Eigen::Vector3f start = point.position + kLeaveSurface_m * point.face_normal;
  for (int i = 0; i < config_.light_samples; ++i) {
    // Pattern p takes samples p, p + 16, ...: each pattern alone is spread over the lamp.
    const Eigen::Vector2f& sample =
        lamp_samples_[static_cast<std::size_t>(pattern + i * kPatterns)];
    const Eigen::Vector3f to_lamp =
        lamp.center_m + sample.x() * lamp.half_width_m + sample.y() * lamp.half_height_m - start;
    const float square = to_lamp.squaredNorm(), distance = std::sqrt(square);
    const float falls = point.normal.dot(to_lamp) / distance,
                leaves = -lamp.normal.dot(to_lamp) / distance;
    if (falls <= 0 || leaves <= 0 || point.face_normal.dot(to_lamp) <= 0) continue;
    if (!scene_.occluded(start, to_lamp, 1 - kLeaveSurface_m))
      light += lamp.intensity * (falls * leaves / square);
  }
  return light / static_cast<float>(config_.light_samples);
}

Eigen::Vector3f Lighting::ambient_light(const SurfacePoint& point, int pattern) const {
  const Eigen::Vector3f start = point.position + kLeaveSurface_m * point.face_normal;
  const Eigen::Vector3f side = point.normal.unitOrthogonal(), other = point.normal.cross(side);
  int open = 0;
  for (int i = 0; i < config_.ambient_samples; ++i) {
    const Eigen::Vector3f& sample =
        ambient_samples_[static_cast<std::size_t>(pattern + i * kPatterns)];
    const Eigen::Vector3f direction =
        sample.x() * side + sample.y() * other + sample.z() * point.normal;
    if (!scene_.occluded(start, direction, config_.ambient_reach_m)) ++open;
  }
  const float up = 0.5f * (point.normal.z() + 1);
  const float share = config_.ambient_samples > 0
                          ? static_cast<float>(open) / static_cast<float>(config_.ambient_samples)
                          : 1.f;
  return room_.ambient * (share * (kLowerAmbient + (kUpperAmbient - kLowerAmbient) * up));
}

}  // namespace ovimap
