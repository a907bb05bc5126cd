// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "ovimap/frames/frame/frame_source.h"
#include "ovimap/inference/masks/mask_source.h"

namespace ovimap {

/// A table top (id 1) with two balls on it (ids 2, 3), seen from a camera that moves around it:
/// exact depth, colours and ids, for tests of the whole pipeline.
class DeskScene : public FrameSource {
 public:
  static constexpr int kFrames = 12;

  std::string kind() const override { return "desk"; }
  std::int64_t size() const override { return kFrames; }

  FrameRead read(std::int64_t position) const override {
    if (position == bad_frame) return {std::nullopt, "pose is not finite"};
    Frame frame;
    frame.index = position;
    frame.name = "frame" + std::to_string(position);
    frame.color_camera = frame.depth_camera = kCamera;
    frame.world_from_camera = pose(position);
    frame.color = RgbImage(kCamera.width, kCamera.height);
    frame.depth = DepthImage(kCamera.width, kCamera.height);
    const IdImage ids = trace(frame.world_from_camera, frame.depth);
    const Rgb8 colors[] = {{}, {120, 90, 60}, {200, 30, 30}, {30, 30, 200}};
    for (std::size_t i = 0; i < ids.size(); ++i) frame.color[i] = colors[ids[i]];
    return {frame, ""};
  }

  std::optional<IdImage> truth_ids(std::int64_t position) const override {
    DepthImage depth(kCamera.width, kCamera.height);
    return trace(pose(position), depth);
  }

  std::int64_t bad_frame = -1;

 private:
  static constexpr PinholeCamera kCamera{160, 120, 150.f, 150.f, 79.5f, 59.5f};
  struct Ball {
    Eigen::Vector3f center;
    float radius;
  };

  /// World: z up, table top at z = 0 within 0.6 m of the origin. The camera circles at 0.7 m
  /// height.
  static Pose pose(std::int64_t position) {
    const double angle = 2 * M_PI * static_cast<double>(position) / kFrames;
    const Eigen::Vector3d eye(0.9 * std::cos(angle), 0.9 * std::sin(angle), 0.7);
    const Eigen::Vector3d forward = (-eye).normalized(),
                          right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
    Pose result = Pose::Identity();
    result.linear() << right, forward.cross(right), forward;
    result.translation() = eye;
    return result;
  }

  static IdImage trace(const Pose& world_from_camera, DepthImage& depth) {
    const Ball balls[] = {{{0.15f, 0.f, 0.1f}, 0.1f}, {{-0.2f, 0.1f, 0.12f}, 0.12f}};
    IdImage ids(kCamera.width, kCamera.height);
    const Eigen::Vector3f eye = world_from_camera.translation().cast<float>();
    for (int y = 0; y < kCamera.height; ++y) {
      for (int x = 0; x < kCamera.width; ++x) {
        const Eigen::Vector3f ray =
            world_from_camera.linear().cast<float>() *
            kCamera.unproject(static_cast<float>(x), static_cast<float>(y), 1.f);
        float nearest = std::numeric_limits<float>::max();
        const auto hit = [&](float t, std::uint16_t id) {
          if (t > 0.f && t < nearest) nearest = t, ids.at(x, y) = id, depth.at(x, y) = t;
        };
        const float table = -eye.z() / ray.z();
        if ((eye + table * ray).head<2>().norm() < 0.6f) hit(table, 1);
        for (std::uint16_t i = 0; i < 2; ++i) {
          const Eigen::Vector3f from = eye - balls[i].center;
          const float a = ray.squaredNorm(), b = ray.dot(from),
                      c = from.squaredNorm() - balls[i].radius * balls[i].radius;
          if (b * b - a * c > 0.f)
            hit((-b - std::sqrt(b * b - a * c)) / a, static_cast<std::uint16_t>(i + 2));
        }
      }
    }
    return ids;
  }
};

/// The desk's true ids as 2D entities.
class DeskMasks : public MaskSource {
 public:
  std::string kind() const override { return "desk"; }
  std::optional<Entities> entities(const Frame& frame, std::span<const MaskPrompt>) override {
    if (frame.index == failing_frame) throw Error("mask source is broken");
    if (frame.index % masked_every != 0) return std::nullopt;
    return Entities{*scene_.truth_ids(frame.index), {1.f, 1.f, 1.f}};
  }
  std::int64_t failing_frame = -1;
  std::int64_t masked_every = 1;  ///< the frames between are not masked

 private:
  DeskScene scene_;
};

/// The desk's truth as by a network.
class SlowDeskMasks : public DeskMasks {
 public:
  bool is_slow() const override { return true; }
};

}  // namespace ovimap
