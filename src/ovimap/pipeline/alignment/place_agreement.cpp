// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/alignment/place_agreement.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/config.h"
#include "ovimap/map/rays/ray_cast.h"
#include "ovimap/pipeline/alignment/surface_fit.h"

namespace ovimap {

namespace {

constexpr float kLevel = 0.8f;  // cosine to the vertical of what counts as level
constexpr float kBreak =
    0.1f;  // depths of neighbours that differ by a larger share are two surfaces
constexpr float kFewTelling = 0.05f;  // share of pixels that must not be level

Eigen::Vector3f point_at(const DepthImage& depth, const PinholeCamera& camera, int x, int y) {
  return camera.unproject(static_cast<float>(x), static_cast<float>(y), depth.row(y)[x]);
}

/// By differences of neighbours; 0 where one is missing or on another surface.
Eigen::Vector3f normal_at(const DepthImage& depth, const PinholeCamera& camera, int x, int y) {
  if (x < 1 || y < 1 || x + 1 >= depth.width() || y + 1 >= depth.height())
    return Eigen::Vector3f::Zero();
  const float here = depth.row(y)[x];
  for (const float other :
       {depth.row(y)[x - 1], depth.row(y)[x + 1], depth.row(y - 1)[x], depth.row(y + 1)[x]})
    if (!(std::fabs(other - here) < kBreak * here)) return Eigen::Vector3f::Zero();
  const Eigen::Vector3f right =
                            point_at(depth, camera, x + 1, y) - point_at(depth, camera, x - 1, y),
                        down =
                            point_at(depth, camera, x, y + 1) - point_at(depth, camera, x, y - 1);
  return down.cross(right).normalized();  // towards the camera
}

Image<Eigen::Vector3f> normals_of(const DepthImage& depth, const PinholeCamera& camera) {
  Image<Eigen::Vector3f> normals(depth.width(), depth.height(), Eigen::Vector3f::Zero());
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x)
      if (depth.row(y)[x] > 0) normals.row(y)[x] = normal_at(depth, camera, x, y);
  return normals;
}

/// The nearest depth around a pixel; 0 where one is missing: nothing is known to be empty there.
float nearest_around(const DepthImage& depth, int x, int y) {
  float nearest = depth.row(y)[x];
  for (int v = std::max(0, y - 1); v <= std::min(depth.height() - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(depth.width() - 1, x + 1); ++u)
      nearest = std::min(nearest, depth.row(v)[u]);
  return nearest;
}

PlaceView view_from(const MapDocument& map, const PinholeCamera& camera, const Pose& pose,
                    const PlaceConfig& config) {
  PlaceView view{camera, pose, cast_rays(map.map, camera, pose, config.max_range_m).depth, {}, {}};
  view.normals = normals_of(view.depth, camera);
  view.telling = Image<std::uint8_t>(camera.width, camera.height);
  const Eigen::Vector3f up = pose.linear().cast<float>().transpose() * map.up;
  for (std::size_t i = 0; i < view.telling.size(); ++i)
    view.telling[i] =
        view.normals[i] != Eigen::Vector3f::Zero() && std::fabs(view.normals[i].dot(up)) < kLevel;
  return view;
}

/// Where hardly anything is upright, everything counts.
void let_all_tell(std::vector<PlaceView>& views) {
  double telling = 0, known = 0;
  for (const PlaceView& view : views)
    for (std::size_t i = 0; i < view.telling.size(); ++i)
      telling += view.telling[i], known += view.normals[i] != Eigen::Vector3f::Zero();
  if (telling >= double{kFewTelling} * known) return;
  for (PlaceView& view : views)
    for (std::size_t i = 0; i < view.telling.size(); ++i)
      view.telling[i] = view.normals[i] != Eigen::Vector3f::Zero();
}

}  // namespace

void list_fields(PlaceConfig& config, ConfigFields& fields) {
  fields.add("width_px", config.width_px, 8, 4096, "width of the images that stand for frames");
  fields.add("max_views", config.max_views, 1, 100000, "frames looked at, evenly spread");
  fields.add("max_range_m", config.max_range_m, 0.1f, 1000.f, "nothing further counts, metres");
  fields.add("tolerance_m", config.tolerance_m, 0.001f, 1.f, "surfaces this near agree, metres");
}

PlaceAgreement& PlaceAgreement::operator+=(const PlaceAgreement& other) {
  pixels += other.pixels, meeting += other.meeting, seen_through += other.seen_through;
  return *this;
}

std::vector<PlaceView> place_views(const MapDocument& map, const PlaceConfig& config) {
  if (!map.depth_camera.valid() || map.frames.empty()) return {};
  const int width = std::min(config.width_px, map.depth_camera.width);
  const PinholeCamera camera = map.depth_camera.scaled_to(
      width, std::max(1, map.depth_camera.height * width / map.depth_camera.width));
  const std::size_t frames = map.frames.size(),
                    count = std::min(frames, static_cast<std::size_t>(config.max_views));
  std::vector<PlaceView> views;
  for (std::size_t i = 0; i < count; ++i)
    views.push_back(view_from(
        map, camera, map.frames[(2 * i + 1) * frames / (2 * count)].world_from_camera, config));
  let_all_tell(views);
  return views;
}

PlaceAgreement agreement(const PlaceView& view, const VoxelMap& map, const Pose& map_from_camera,
                         const PlaceConfig& config) {
  const DepthImage model = cast_rays(map, view.camera, map_from_camera, config.max_range_m).depth;
  PlaceAgreement result;
  for (int y = 0; y < model.height(); ++y)
    for (int x = 0; x < model.width(); ++x) {
      if (view.telling.row(y)[x] == 0) continue;
      ++result.pixels;
      const float there = model.row(y)[x], here = view.depth.row(y)[x];
      if (there == 0) continue;
      const Eigen::Vector3f ray =
          view.camera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
      const Eigen::Vector3f& plane = view.normals.row(y)[x];
      const Eigen::Vector3f normal = normal_at(model, view.camera, x, y);
      if (std::fabs((there - here) * plane.dot(ray)) < config.tolerance_m &&
          (normal == Eigen::Vector3f::Zero() || normal.dot(plane) > kSameSurfaceCosine))
        ++result.meeting;
      else if (nearest_around(view.depth, x, y) - there > config.tolerance_m * ray.norm())
        ++result.seen_through;
    }
  return result;
}

}  // namespace ovimap
