// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/recordings/corridor.h"

#include <algorithm>
#include <cmath>

#include "ovimap/base/parallel.h"
#include "ovimap/synth/shapes/random.h"

namespace ovimap {

namespace {

// World: the corridor runs along +x, z is up.
constexpr float kHalfWidth_m = 1.f, kHeight_m = 2.5f, kEye_m = 1.4f, kSight_m = 8.f;
constexpr std::uint16_t kFloor = 1, kCeiling = 2, kLeftWall = 3, kRightWall = 4, kFirstBox = 5;

/// A colour that differs between neighbours and stays the same from every view.
Rgb8 paint(std::uint16_t id, const Eigen::Vector3f& point) {
  const bool tile = (static_cast<int>(std::floor(point.x() * 2.f)) +
                     static_cast<int>(std::floor(point.y() * 2.f)) +
                     static_cast<int>(std::floor(point.z() * 2.f))) %
                        2 !=
                    0;
  const std::uint32_t hash = id * 2654435761u;
  const auto channel = [&](int shift) {
    return static_cast<std::uint8_t>(60 + (hash >> shift & 127) + (tile ? 30 : 0));
  };
  return {channel(0), channel(8), channel(16)};
}

}  // namespace

CorridorSource::CorridorSource(const CorridorConfig& config)
    : config_(config),
      camera_{config.width,
              config.height,
              0.9f * static_cast<float>(config.width),
              0.9f * static_cast<float>(config.width),
              0.5f * static_cast<float>(config.width - 1),
              0.5f * static_cast<float>(config.height - 1)} {
  Random random(config.seed);
  const float end = config.step_m * static_cast<float>(config.frames) + kSight_m;
  const auto side = [&] { return random.index(2) == 0 ? -1.f : 1.f; };
  const auto uniform = [&](float low, float high) { return random.uniform(low, high); };
  for (float x = 1.5f; x < end; x += uniform(0.6f, 1.6f)) {
    const float of = side(), depth = uniform(0.15f, 0.45f), length = uniform(0.3f, 0.9f);
    add_box(of, depth, {x, x + length}, {0.f, uniform(0.3f, 1.8f)});
  }
  for (float x = 1.5f; config.hung && x < end; x += uniform(0.3f, 0.5f)) {
    const float of = side(), depth = uniform(0.06f, 0.12f), low = uniform(1.f, 2.f);
    add_box(of, depth, {x, x + uniform(0.2f, 0.3f)}, {low, low + uniform(0.2f, 0.35f)});
  }
}

void CorridorSource::add_box(float side, float depth, const Eigen::Vector2f& along,
                             const Eigen::Vector2f& up) {
  const float wall = side * kHalfWidth_m, inner = side * (kHalfWidth_m - depth);
  boxes_.emplace_back(Eigen::Vector3f(along[0], std::min(inner, wall), up[0]),
                      Eigen::Vector3f(along[1], std::max(inner, wall), up[1]));
}

Pose CorridorSource::pose(std::int64_t position) const {
  const double along = static_cast<double>(position);
  const double yaw = 0.35 * std::sin(0.02 * along), sway = 0.25 * std::sin(0.013 * along);
  const Eigen::Vector3d forward(std::cos(yaw) * 0.98, std::sin(yaw) * 0.98, -0.2);
  const Eigen::Vector3d z = forward.normalized(),
                        right = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Pose world_from_camera = Pose::Identity();
  world_from_camera.linear() << right, z.cross(right), z;
  world_from_camera.translation() = Eigen::Vector3d(double{config_.step_m} * along, sway, kEye_m);
  return world_from_camera;
}

std::vector<std::size_t> CorridorSource::boxes_near(float x) const {
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    if (boxes_[i].max().x() > x - 1.f && boxes_[i].min().x() < x + kSight_m) near.push_back(i);
  return near;
}

CorridorSource::Hit CorridorSource::trace(const Eigen::Vector3f& eye, const Eigen::Vector3f& ray,
                                          const std::vector<std::size_t>& near) const {
  Hit hit;
  float nearest = kSight_m;
  const auto meet = [&](float depth, std::uint16_t id, int face) {
    if (depth > 0.f && depth < nearest) nearest = depth, hit = {depth, id, face};
  };
  if (ray.z() < 0.f) meet(-eye.z() / ray.z(), kFloor, 2);
  if (ray.z() > 0.f) meet((kHeight_m - eye.z()) / ray.z(), kCeiling, 2);
  if (ray.y() > 0.f) meet((kHalfWidth_m - eye.y()) / ray.y(), kLeftWall, 1);
  if (ray.y() < 0.f) meet((-kHalfWidth_m - eye.y()) / ray.y(), kRightWall, 1);
  for (const std::size_t i : near) {
    float enter = 0.f, leave = nearest;
    int face = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float inverse = 1.f / ray[axis];
      float first = (boxes_[i].min()[axis] - eye[axis]) * inverse;
      float second = (boxes_[i].max()[axis] - eye[axis]) * inverse;
      if (first > second) std::swap(first, second);
      if (first > enter) enter = first, face = axis;
      leave = std::min(leave, second);
    }
    if (enter < leave) meet(enter, static_cast<std::uint16_t>(kFirstBox + i % 60000), face);
  }
  return hit;
}

template <class Visit>
void CorridorSource::for_each_pixel(std::int64_t position, const Visit& visit) const {
  const Pose world_from_camera = pose(position);
  const Eigen::Vector3f eye = world_from_camera.translation().cast<float>();
  const Eigen::Matrix3f rotation = world_from_camera.linear().cast<float>();
  const std::vector<std::size_t> near = boxes_near(eye.x());
  parallel_for(static_cast<std::size_t>(camera_.height), 32, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < camera_.width; ++x) {
      const Eigen::Vector3f ray =
          rotation * camera_.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
      const Hit hit = trace(eye, ray, near);
      visit(x, y, hit, Eigen::Vector3f(eye + ray * hit.depth_m));
    }
  });
}

FrameRead CorridorSource::read(std::int64_t position) const {
  Frame frame;
  frame.index = position;
  frame.name = "frame" + std::to_string(position);
  frame.timestamp_s = static_cast<double>(position) / 30.;
  frame.color_camera = frame.depth_camera = camera_;
  frame.world_from_camera = pose(position);
  frame.color = RgbImage(camera_.width, camera_.height);
  frame.depth = DepthImage(camera_.width, camera_.height);
  for_each_pixel(position, [&](int x, int y, const Hit& hit, const Eigen::Vector3f& point) {
    frame.depth.at(x, y) = hit.depth_m;
    if (hit.id != 0) frame.color.at(x, y) = paint(hit.id, point);
  });
  return {std::move(frame), ""};
}

std::optional<IdImage> CorridorSource::truth_ids(std::int64_t position) const {
  IdImage ids(camera_.width, camera_.height);
  for_each_pixel(position, [&](int x, int y, const Hit& hit, const Eigen::Vector3f&) {
    ids.at(x, y) = hit.id;
  });
  return ids;
}

}  // namespace ovimap
