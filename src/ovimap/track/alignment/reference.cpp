// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/track/alignment/reference.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/median.h"
#include "ovimap/map/rays/ray_cast.h"

namespace ovimap {

namespace {

constexpr int kReach_px = 2;                  // half window of a piece's plane
constexpr float kNormalFromMedian = 1.4826f;  // standard deviation by the median of its absolutes
constexpr float kTooFarOff = 3;               // standard deviations, or a view's own of them

/// Inverse depth of a plane: value at a pixel and change per pixel.
struct InversePlane {
  float value = 0, right = 0, down = 0;
  bool flat = false;  ///< the window around it is one surface
};

/// The mean of differences over three parallel lines; false where one of the pixels is missing or
/// off the surface.
bool slope(const Image<float>& inverse, int x, int y, int dx, int dy, float& result) {
  const float here = inverse.row(y)[x];
  float sum = 0;
  for (int side = -1; side <= 1; ++side) {
    const int cx = x + side * dy, cy = y + side * dx;
    const float after = inverse.row(cy + kReach_px * dy)[cx + kReach_px * dx];
    const float before = inverse.row(cy - kReach_px * dy)[cx - kReach_px * dx];
    const float middle = inverse.row(cy)[cx];
    if (after == 0 || before == 0 || middle == 0) return false;
    if (std::fabs(after + before - 2 * middle) > kOneSurface * here) return false;
    if (std::fabs(after - before) > 4 * kOneSurface * here) return false;
    sum += after - before;
  }
  result = sum / (3 * 2 * kReach_px);
  return true;
}

InversePlane plane_at(const Image<float>& inverse, int x, int y) {
  InversePlane plane{inverse.row(y)[x]};
  const bool inside = x >= kReach_px && y >= kReach_px && x + kReach_px < inverse.width() &&
                      y + kReach_px < inverse.height();
  plane.flat = plane.value > 0 && inside && slope(inverse, x, y, 1, 0, plane.right) &&
               slope(inverse, x, y, 0, 1, plane.down);
  return plane;
}

/// A plane is linear in inverse depth: 1/z = a x + b y + c for a ray (x, y, 1), which says that
/// (a, b, c) . point = 1.
Eigen::Vector3f normal_of(const InversePlane& plane, const PinholeCamera& camera, int x, int y) {
  const float a = plane.right * camera.fx, b = plane.down * camera.fy;
  const Eigen::Vector3f ray = camera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
  return Eigen::Vector3f(a, b, plane.value - a * ray.x() - b * ray.y()).normalized();
}

Eigen::Vector2f gradient_at(const Image<float>& intensity, int x, int y) {
  if (x < 1 || y < 1 || x + 1 >= intensity.width() || y + 1 >= intensity.height())
    return Eigen::Vector2f::Zero();
  const float left = intensity.row(y)[x - 1], right = intensity.row(y)[x + 1],
              up = intensity.row(y - 1)[x], down = intensity.row(y + 1)[x];
  if (std::min({left, right, up, down}) < 0) return Eigen::Vector2f::Zero();
  return {(right - left) / 2, (down - up) / 2};
}

ReferencePoint point_at(const TrackLevel& level, int x, int y, float inverse_depth,
                        const Eigen::Vector3f& normal) {
  return {level.camera.unproject(static_cast<float>(x), static_cast<float>(y), 1 / inverse_depth),
          normal, level.intensity.row(y)[x], gradient_at(level.intensity, x, y)};
}

/// Of the pixels of the finest level that make up a pixel of the surface's level, the one where
/// intensity changes most, at the depth that the piece's plane has there.
ReferencePoint finest_point(const TrackLevel& fine, const InversePlane& plane, int x, int y,
                            const Eigen::Vector3f& normal) {
  int best = 0;
  float steepest = -1;
  for (int i = 0; i < 4; ++i) {
    const float steep =
        gradient_at(fine.intensity, 2 * x + (i & 1), 2 * y + (i >> 1)).squaredNorm();
    if (steep > steepest) steepest = steep, best = i;
  }
  const int dx = best & 1, dy = best >> 1;
  const float inverse = plane.value + plane.right * (static_cast<float>(dx) - 0.5f) / 2 +
                        plane.down * (static_cast<float>(dy) - 0.5f) / 2;
  return point_at(fine, 2 * x + dx, 2 * y + dy, inverse, normal);
}

/// Points of a level. If `fine` is not null, the pieces are dealt out like the squares of a chess
/// board: white ones to this level, black ones to the finest.
void add_points(const TrackLevel& level, const Image<float>& inverse, const TrackLevel* fine,
                ReferencePoints& points, ReferencePoints* fine_points) {
  for (int y = 0; y < inverse.height(); ++y)
    for (int x = 0; x < inverse.width(); ++x) {
      const InversePlane plane = plane_at(inverse, x, y);
      if (!plane.flat) continue;
      const Eigen::Vector3f normal = normal_of(plane, level.camera, x, y);
      if (fine && (x + y) % 2 == 1)
        fine_points->push_back(finest_point(*fine, plane, x, y, normal));
      else
        points.push_back(point_at(level, x, y, plane.value, normal));
    }
}

Image<float> halved_inverse(const Image<float>& fine) {
  Image<float> coarse(fine.width() / 2, fine.height() / 2);
  for (int y = 0; y < coarse.height(); ++y)
    for (int x = 0; x < coarse.width(); ++x) {
      float sum = 0, nearest = 0;
      for (int i = 0; i < 4; ++i)
        nearest = std::max(nearest, fine.row(2 * y + (i >> 1))[2 * x + (i & 1)]);
      int count = 0;
      for (int i = 0; i < 4; ++i) {
        const float value = fine.row(2 * y + (i >> 1))[2 * x + (i & 1)];
        if (value > (1 - kOneSurface) * nearest) sum += value, ++count;
      }
      if (nearest > 0) coarse.row(y)[x] = sum / static_cast<float>(count);
    }
  return coarse;
}

/// By how many standard deviations depth is behind the model's.
float sigmas_behind(float model, float own, const DepthNoiseConfig& noise, float model_sigma_m) {
  return (1 / own - 1 / model) / std::hypot(noise.sigma_m(1 / own), model_sigma_m);
}

/// The model where there is one, else the frame's own depth.
Image<float> merged(const Image<float>& model, const Image<float>& own) {
  Image<float> both = own;
  for (std::size_t i = 0; i < model.size(); ++i)
    if (model[i] > 0) both[i] = model[i];
  return both;
}

float median_depth(const ReferencePoints& points) {
  if (points.empty()) return 1;
  std::vector<float> depths;
  for (std::size_t i = 0; i < points.size(); ++i) depths.push_back(points[i].point.z());
  return median_of(depths);
}

}  // namespace

void ReferencePoints::push_back(const ReferencePoint& point) {
  const std::size_t lane = size_++ % kLanes;
  if (lane == 0) eights_.emplace_back();
  EightPoints& eight = eights_.back();
  eight.x[lane] = point.point.x(), eight.y[lane] = point.point.y(), eight.z[lane] = point.point.z();
  eight.normal_x[lane] = point.normal.x(), eight.normal_y[lane] = point.normal.y(),
  eight.normal_z[lane] = point.normal.z();
  eight.intensity[lane] = point.intensity;
  eight.gradient_x[lane] = point.gradient.x(), eight.gradient_y[lane] = point.gradient.y();
}

ReferencePoint ReferencePoints::operator[](std::size_t index) const {
  const EightPoints& eight = eights_[index / kLanes];
  const std::size_t lane = index % kLanes;
  return {{eight.x[lane], eight.y[lane], eight.z[lane]},
          {eight.normal_x[lane], eight.normal_y[lane], eight.normal_z[lane]},
          eight.intensity[lane],
          {eight.gradient_x[lane], eight.gradient_y[lane]}};
}

Image<float> cast_inverse_depth(const VoxelMap& map, const PinholeCamera& camera,
                                const Pose& world_from_camera, float max_range_m) {
  DepthImage depth = cast_rays(map, camera, world_from_camera, max_range_m).depth;
  for (float& value : depth) value = value > 0 ? 1 / value : 0;
  return depth;
}

double keep_what_map_has(const Image<float>& model, TrackLevel& level) {
  std::size_t seen = 0, both = 0;
  for (std::size_t i = 0; i < level.inverse_depth.size(); ++i) {
    seen += level.inverse_depth[i] > 0.f;
    if (model[i] <= 0.f) level.inverse_depth[i] = 0.f;
    both += level.inverse_depth[i] > 0.f;
  }
  return seen == 0 ? 0. : static_cast<double>(both) / static_cast<double>(seen);
}

void settle_contradictions(const DepthNoiseConfig& noise, float model_sigma_m, Image<float>& model,
                           TrackLevel& level) {
  Image<float>& own = level.inverse_depth;
  Image<float> behind(model.width(), model.height(), 0.f);
  std::vector<float> differences;
  for (std::size_t i = 0; i < model.size(); ++i) {
    if (model[i] <= 0 || own[i] <= 0) continue;
    behind[i] = sigmas_behind(model[i], own[i], noise, model_sigma_m);
    differences.push_back(std::fabs(behind[i]));
  }
  if (differences.empty()) return;
  const float most = kTooFarOff * std::max(1.f, kNormalFromMedian * median_of(differences));
  for (std::size_t i = 0; i < model.size(); ++i) {
    if (std::fabs(behind[i]) <= most) continue;
    const bool something_before = model[i] < (1 - kOneSurface) * own[i];
    model[i] = 0;
    if (something_before) own[i] = 0;
  }
}

Reference make_reference(const TrackPyramid& pyramid, const Image<float>& model,
                         const Pose& world_from_camera) {
  OVIMAP_ASSERT(pyramid.size() > kSurfaceLevel);
  Reference reference;
  reference.world_from_camera = world_from_camera;
  for (const TrackLevel& level : pyramid) reference.levels.push_back({level.camera, {}});
  Image<float> inverse = merged(model, pyramid[kSurfaceLevel].inverse_depth);
  const bool has_finest = pyramid[0].intensity.width() >= 2 * inverse.width();
  add_points(pyramid[kSurfaceLevel], inverse, has_finest ? &pyramid[0] : nullptr,
             reference.levels[kSurfaceLevel].points, &reference.levels[0].points);
  for (std::size_t i = kSurfaceLevel + 1; i < pyramid.size(); ++i) {
    inverse = halved_inverse(inverse);
    add_points(pyramid[i], inverse, nullptr, reference.levels[i].points, nullptr);
  }
  reference.median_depth_m = median_depth(reference.levels[kSurfaceLevel].points);
  return reference;
}

}  // namespace ovimap
